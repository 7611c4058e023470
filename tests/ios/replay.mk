# Repeater and debrief in a browser; and every page as those have it who see it badly or have a keyboard alone.
ifeq ($(BOARD),bench-linux)
PAGE_TESTS := $(addprefix $(O)/bin/tests/ios/,test_replay_pages test_accessible)
TESTS += $(PAGE_TESTS)
$(O)/bin/tests/ios/test_accessible: $(addprefix $(O)/bin/landmass-,ios nav) $(O)/bin/tests/zcu102/golden_flash
$(PAGE_TESTS): $(O)/bin/tests/replay/flights $(O)/ios/.made tests/ios/replay.mk
	@mkdir -p $(@D)
	@printf '#!/bin/sh\nexec sh tests/web/run.sh /usr/bin/python3 -B tests/ios/%s.py\n' $(@F) >$@
	@chmod +x $@
endif
