# Repeater and debrief in a browser.
ifeq ($(BOARD),bench-linux)
TESTS += $(O)/bin/tests/ios/test_replay_pages
$(O)/bin/tests/ios/test_replay_pages: $(O)/bin/tests/replay/flights $(O)/ios/.made tests/ios/replay.mk
	@mkdir -p $(@D)
	@printf '#!/bin/sh\nexec sh tests/web/run.sh /usr/bin/python3 -B tests/ios/test_replay_pages.py\n' >$@
	@chmod +x $@
endif
