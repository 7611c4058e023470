# Small errors planted one at a time: which of them does no test notice? See mutate.py and docs/TRUST.md.
MUTATE        := $(O)/mutate
MUTATE_TESTS   = $(filter $(UNIT)/fixed/% $(UNIT)/firmware/% $(UNIT)/host-sim/bus/% $(UNIT)/host-sim/build/test_detail,$(TESTS)) \
    $(GOLDEN)/golden
MUTATE_OPTIONS = --mutants $(or $(MUTANTS),100) --jobs $(or $(JOBS),1) $(SEED:%=--seed %) $(if $(ONLY),--only $(ONLY)) \
    $(MINUTES:%=--minutes %) $(LEAST:%=--least %) $(PLANTED:%=--planted %)

.PHONY: mutants mutants-sample mutants-run
mutants: ## Plant MUTANTS=100 small errors drawn by SEED=..., tell which no test notices; ONLY=firmware/page JOBS=2 MINUTES=60
	@$(MAKE) --no-print-directory mutants-run

# So few, drawn anew each time, tell 60 from 95 % and no more. Time may end it before it has judged them all.
mutants-sample: ## A few of them, and those that were once not noticed: some minutes
	@$(MAKE) --no-print-directory mutants-run MUTANTS=60 JOBS=2 MINUTES=4 LEAST=60

mutants-run: $(O)/mutate/commands
	@python3 -B tests/mutate/mutate.py $(O) --commands $< $(MUTATE_OPTIONS)

$(O)/mutate/commands: always
	@$(MAKE) --no-print-directory -s -j2 $(MUTATE_TESTS)
	@mkdir -p $(@D)
	@$(MAKE) --no-print-directory -n -B V=1 $(MUTATE_TESTS) >$@

# The script itself, on sources of a few lines.
TESTS += $(O)/bin/tests/mutate/test_mutate
$(O)/bin/tests/mutate/test_mutate: $(wildcard tests/mutate/*.py tests/mutate/*.txt)
	@mkdir -p $(@D)
	@printf '#!/bin/sh\nexec python3 -B tests/mutate/test_mutate.py\n' >$@
	@chmod +x $@
