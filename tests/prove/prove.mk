# The proofs that take seconds, as a test; `make prove` runs all.
PROOFS := $(O)/bin/tests/prove/proofs
TESTS += $(PROOFS)
$(PROOFS): tests/prove/prove.mk | $(GEN)/fixed/src/tables.c
	@mkdir -p $(@D)
	@printf '#!/bin/sh\nexec python3 -B tests/prove/prove.py "$$BUILD" --quick --tap\n' >$@
	@chmod +x $@

# Every argument of arithmetic that has 32 bits of it; each 4,099th as a test.
EVERY := $(O)/bin/tests/prove/every
PROGRAMS += $(EVERY)
$(O)/tests/prove/every.o: CFLAGS_host += -I. -Ifixed/include -fsanitize=undefined -fno-sanitize-recover=all
$(EVERY): $(O)/tests/prove/every.o $(LIB_fixed)
$(EVERY): LDLIBS := -lm -fsanitize=undefined
TESTS += $(O)/bin/tests/prove/test_every
$(O)/bin/tests/prove/test_every: tests/prove/prove.mk $(EVERY)
	@mkdir -p $(@D)
	@printf '#!/bin/sh\nexec "$$BUILD"/bin/tests/prove/every 4099\n' >$@
	@chmod +x $@
.PHONY: every
every: $(EVERY) ## Try sine, tangent, reciprocal, logarithm, power and root for every argument: ten minutes
	@$(EVERY)
