# Synthetic aperture: the dwell in flight, and the effects that can be switched.
SAR_TESTS := $(addprefix $(O)/bin/tests/unit/firmware/test_sar_,dwell effects)
TESTS += $(SAR_TESTS)
$(SAR_TESTS): $(O)/bin/%: $(O)/%.o $(O)/tests/unit/firmware/unit_rig.o $(TEST_SUPPORT) \
    $(O)/tests/support/tiny_image.o $(O)/tests/support/memory_flash.o $(LIB_hs) $(LIB_firmware) $(LIB_fixed)
$(SAR_TESTS): LDLIBS := -lcmocka $(call pkgs,libs,proj libpng)
