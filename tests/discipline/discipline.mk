# The rules of the house as tests. The flags of each layer come from the Makefile itself, so that loosening them there
# is seen here.
RULES := $(O)/bin/tests/discipline/rules
TESTS += $(RULES)
$(RULES): tests/discipline/rules.py tests/discipline/rules_test.py $(O)/tests/discipline/flags
	@mkdir -p $(@D)
	@printf '#!/bin/sh\nexec python3 -B tests/discipline/rules_test.py\n' >$@
	@chmod +x $@

$(O)/tests/discipline/flags: Makefile make/layers.mk firmware/rooms.mk firmware/kernels/kernels.mk host-sim/host-sim.mk make/host.mk \
    bsp/$(BOARD)/board.mk tests/discipline/discipline.mk | $(LIB_firmware) $(LIB_fixed)
	@mkdir -p $(@D)
	@printf '%s\n' 'CC $(CC)' 'GENERATED $(GEN)' 'ROOMS $(ROOMS)' \
	    $(foreach r,$(ROOMS) drivers,'SEES_$r $(SEES_$r)') 'fixed $(CFLAGS_fixed)' \
	    $(foreach r,$(ROOMS),'firmware/$r $(call CFLAGS_room,$r)') 'drivers $(CFLAGS_drivers)' 'bsp $(CFLAGS_bsp)' \
	    'LIBRARIES $(HOST_LIBS:%=host-sim/%)' 'PROGRAMS $(HOST_PROGRAMS:%=host-sim/programs/%)' \
	    $(foreach p,$(HOST_LIBS) $(HOST_PROGRAMS:%=programs/%), \
	    'SEES_host-sim/$p $(HOST_SEES_$p)' 'host-sim/$p $(call CFLAGS_host_part,$p)') >$@

# For lint.sh: compile all that this machine runs, tests included, and run nothing. What other boards run is for their
# compilers. Of the tests that run under the sanitizers alone, the objects: their libraries are compiled plain already.
LINT_sanitized = $(UNIT_SANITIZED:%=$(UNIT)/%) $(UNIT_ALSO_SANITIZED:%=$(UNIT)/%_sanitized) $(O)/bin/tests/fuzz/%
LINT_others    = $(addprefix $(O)/bin/tests/,golden/test_golden_arm64 kernels/% cortex-m7/% panel-vm/% zcu102/%)
LINT = $(filter-out $(LINT_sanitized) $(LINT_others),$(TESTS)) $(ZCU102_TOOLS) $(PANEL_VM)/glass \
    $(patsubst %.c,$(O)/sanitized/%.o,$(wildcard tests/fuzz/*.c) $(UNIT_SANITIZED:%=tests/unit/%.c))
.PHONY: lint-build
lint-build:
	@$(MAKE) --no-print-directory -j2 $(PROGRAMS) $(LINT)
