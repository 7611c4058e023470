# A panel that flies, the server, and the pages of both: what a page shows is what that panel's glass got.
ifeq ($(BOARD),bench-linux)
$(O)/tests/ios/virtual_panel.o: EXTRA_CFLAGS := -Ibsp/panel-linux $(patsubst %,-Ihost-sim/%/include,bus lib trust)
$(O)/bin/tests/ios/virtual_panel: $(O)/tests/ios/virtual_panel.o $(PANEL_READER) $(LIB_panel) $(LIB_record) $(LIB_drivers) \
    $(LIB_firmware) $(LIB_fixed)
$(O)/bin/tests/ios/virtual_panel: LDLIBS = $(PANEL_LIBS)

PANEL_TESTS := $(addprefix $(O)/bin/tests/ios/,test_panel_pages test_displays)
TESTS += $(PANEL_TESTS)
$(PANEL_TESTS): $(addprefix $(O)/bin/landmass-,ios nav sim) $(O)/bin/tests/ios/virtual_panel \
    $(O)/bin/tests/zcu102/golden_flash $(O)/ios/.made tests/ios/panel.mk
	@mkdir -p $(@D)
	@printf '#!/bin/sh\nexec sh tests/web/run.sh /usr/bin/python3 -B tests/ios/%s.py\n' $(@F) >$@
	@chmod +x $@
endif
