$(O)/tests/unit/nav/%.o: EXTRA_CFLAGS := -Ihost-sim/nav

NAV_TESTS := $(addprefix $(O)/bin/tests/unit/nav/test_,canas track reading log)
TESTS += $(NAV_TESTS)
$(NAV_TESTS): $(O)/bin/%: $(O)/%.o $(O)/tests/unit/nav/decode.o $(NAV_OBJS) $(TEST_SUPPORT) $(LIB_hs)
$(NAV_TESTS): LDLIBS := -lcmocka $(call pkgs,libs,proj expat zlib)
$(O)/bin/tests/unit/nav/test_log: | $(O)/bin/landmass-nav

# The recorded flights on a whole unit.
NAV_STATES := $(O)/bin/tests/unit/nav/test_display_states
TESTS += $(NAV_STATES)
$(NAV_STATES): $(O)/tests/unit/nav/test_display_states.o $(O)/tests/unit/firmware/unit_rig.o $(NAV_OBJS) $(TEST_SUPPORT) \
    $(O)/tests/support/tiny_image.o $(O)/tests/support/memory_flash.o $(O)/drivers/can/can_log.o \
    $(LIB_hs) $(LIB_firmware) $(LIB_fixed)
$(NAV_STATES): LDLIBS := -lcmocka $(call pkgs,libs,proj expat zlib)
