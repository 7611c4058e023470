# Synthetic aperture: the dwell in flight.
T := $(O)/bin/tests/unit/firmware/test_sar_dwell
TESTS += $(T)
$(T): $(O)/tests/unit/firmware/test_sar_dwell.o $(O)/tests/unit/firmware/unit_rig.o $(TEST_SUPPORT) \
    $(O)/tests/support/tiny_image.o $(O)/tests/support/memory_flash.o $(LIB_hs) $(LIB_firmware) $(LIB_fixed)
$(T): LDLIBS := -lcmocka $(call pkgs,libs,proj libpng)
