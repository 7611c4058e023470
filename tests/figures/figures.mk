# The list of goals and the table of README.md.
TESTS += $(O)/bin/tests/figures/test_figures
$(O)/bin/tests/figures/test_figures: $(wildcard tests/figures/*) tests/zcu102/tap.py
	@mkdir -p $(@D)
	@printf '#!/bin/sh\nexec python3 -B tests/figures/figures_test.py\n' >$@
	@chmod +x $@
