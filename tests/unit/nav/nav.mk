$(O)/tests/unit/nav/%.o: EXTRA_CFLAGS := -Ihost-sim/nav

NAV_TESTS := $(addprefix $(O)/bin/tests/unit/nav/test_,canas track reading log)
TESTS += $(NAV_TESTS)
$(NAV_TESTS): $(O)/bin/%: $(O)/%.o $(O)/tests/unit/nav/decode.o $(NAV_OBJS) $(TEST_SUPPORT) $(LIB_hs)
$(NAV_TESTS): LDLIBS := -lcmocka $(call pkgs,libs,proj expat zlib)
$(O)/bin/tests/unit/nav/test_log: | $(O)/bin/landmass-nav
