# How real the pictures are: levels of the real firmware measured beside real radar and theory (docs/realism.md).
REALISM_TAP := $(O)/bin/tests/realism/realism_tap
REALISM     := $(O)/bin/tests/realism/test_realism
PROGRAMS += $(REALISM_TAP)
TESTS += $(REALISM)
$(O)/tests/realism/tap.o: EXTRA_CFLAGS := -Ihost-sim/lib/include
$(REALISM_TAP): $(O)/tests/realism/tap.o $(O)/drivers/flash/flash_file.o $(LIB_hs) $(LIB_firmware) $(LIB_fixed)
$(REALISM): $(REALISM_TAP) $(addprefix $(O)/bin/landmass-,db nav scene sim target) $(wildcard tests/realism/*.py)
	@mkdir -p $(@D)
	@printf '#!/bin/sh\nexec $${PYTHON:-/usr/bin/python3} -B tests/realism/realism.py --tap "$$@"\n' >$@
	@chmod +x $@

.PHONY: realism
realism: deps ## Print yardstick, real value and ours of each measure; leave the sheet in build/gallery
	@$(MAKE) --no-print-directory -j2 $(REALISM)
	@BUILD=$(O) $${PYTHON:-/usr/bin/python3} -B tests/realism/realism.py --sheet
