# The server of the pages, met by a client of its own; and the same behind proxies.
ifeq ($(BOARD),bench-linux)
SERVER_TESTS := $(addprefix $(O)/bin/tests/ios/,test_server test_proxy)
TESTS += $(SERVER_TESTS)
$(O)/bin/tests/ios/test_proxy: $(O)/ios/.made
$(SERVER_TESTS): $(O)/bin/landmass-ios $(O)/bin/tests/zcu102/golden_flash tests/ios/server.mk
	@mkdir -p $(@D)
	@printf '#!/bin/sh\nexec /usr/bin/python3 -B tests/ios/%s.py\n' $(@F) >$@
	@chmod +x $@
endif
