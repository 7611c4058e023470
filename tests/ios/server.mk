# The server of the pages, met by a client of its own.
ifeq ($(BOARD),bench-linux)
TESTS += $(O)/bin/tests/ios/test_server
$(O)/bin/tests/ios/test_server: $(O)/bin/landmass-ios $(O)/bin/tests/zcu102/golden_flash tests/ios/server.mk
	@mkdir -p $(@D)
	@printf '#!/bin/sh\nexec /usr/bin/python3 -B tests/ios/test_server.py\n' >$@
	@chmod +x $@
endif
