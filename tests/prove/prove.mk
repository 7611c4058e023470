# The proofs that take seconds, as a test; `make prove` runs all.
PROOFS := $(O)/bin/tests/prove/proofs
TESTS += $(PROOFS)
$(PROOFS): tests/prove/prove.mk | $(GEN)/fixed/src/tables.c
	@mkdir -p $(@D)
	@printf '#!/bin/sh\nexec python3 -B tests/prove/prove.py "$$BUILD" --quick --tap\n' >$@
	@chmod +x $@
