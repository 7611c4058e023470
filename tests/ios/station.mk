# The pages of landmass-ios as one folder, and the tests of the instructor's page.
ifeq ($(BOARD),bench-linux)
IOS_SITE := $(O)/ios
.PHONY: ios-site
ios-site: $(IOS_SITE)/.made
$(IOS_SITE)/.made: $(wildcard host-sim/ios/page/* bsp/web/page/*) | web-modules
	@rm -rf $(@D) && mkdir -p $(@D)/web
	@cp host-sim/ios/page/* $(@D)
	@cp $(filter-out %/index.html,$(wildcard bsp/web/page/*)) $(@D)/web
	@! test -f build/web/landmass.wasm || cp build/web/landmass.wasm $(@D)/web
	@touch $@

STATION_TESTS := $(addprefix $(O)/bin/tests/ios/,test_station test_station_page)
TESTS += $(STATION_TESTS)
$(O)/bin/tests/ios/test_station: STATION_RUN := node --test-reporter=tap tests/ios/test_station.mjs
$(O)/bin/tests/ios/test_station_page: STATION_RUN := /usr/bin/python3 -B tests/ios/test_station_page.py
$(STATION_TESTS): $(addprefix $(O)/bin/landmass-,bus ios nav sim) $(O)/bin/tests/zcu102/golden_flash \
    $(IOS_SITE)/.made tests/ios/station.mk
	@mkdir -p $(@D)
	@printf '#!/bin/sh\nexec sh tests/web/run.sh %s\n' '$(STATION_RUN)' >$@
	@chmod +x $@
endif
