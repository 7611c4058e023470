# The board of a browser: its golden pictures as a module, built by the board's own make, and the tests that the PC runs.
ifeq ($(BOARD),web)
CFLAGS_host += -Itests/golden -Ibsp/web -Itests/web/libc
PROGRAMS += $(O)/golden.wasm
$(O)/golden.wasm: $(call objs,tests/web/golden.c tests/golden/golden_flight.c $(addprefix tests/support/memory_,board.c flash.c))
endif

ifeq ($(BOARD),bench-linux)
WEB_TESTS := $(addprefix $(O)/bin/tests/web/,test_module test_recording test_browser test_firefox)
TESTS += $(WEB_TESTS)
$(O)/bin/tests/web/test_module:  WEB_RUN := node --test-reporter=tap tests/web/test_module.mjs
$(O)/bin/tests/web/test_recording: WEB_RUN := node --test-reporter=tap tests/web/test_recording.mjs
$(O)/bin/tests/web/test_recording $(O)/bin/tests/web/test_browser: $(O)/bin/tests/replay/flights
$(O)/bin/tests/web/test_browser: WEB_RUN := /usr/bin/python3 -B tests/web/test_browser.py
$(O)/bin/tests/web/test_firefox: $(O)/bin/landmass-ios $(O)/bin/tests/replay/flights $(O)/ios/.made
$(O)/bin/tests/web/test_firefox: WEB_RUN := /usr/bin/python3 -B tests/web/test_firefox.py
$(WEB_TESTS): $(addprefix $(O)/bin/tests/zcu102/,golden_flash picture_checksum) $(addprefix $(O)/bin/landmass-,nav sim) | web-modules
	@mkdir -p $(@D)
	@printf '#!/bin/sh\nexec sh tests/web/run.sh %s\n' '$(WEB_RUN)' >$@
	@chmod +x $@

.PHONY: web-modules
web-modules:
	@! command -v wasm-ld-19 >/dev/null || $(call make_board,web) all
endif
