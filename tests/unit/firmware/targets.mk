# Specific targets, against their double-precision reference.
TARGET_TESTS := $(addprefix $(O)/bin/tests/unit/firmware/,test_rcs test_target)
TESTS += $(TARGET_TESTS)
$(addprefix $(O)/tests/unit/firmware/,test_rcs.o test_target.o): EXTRA_CFLAGS := -Ihost-sim/reference
$(TARGET_TESTS): $(O)/bin/tests/unit/firmware/%: $(O)/tests/unit/firmware/%.o $(TEST_SUPPORT) $(O)/tests/support/tiny_image.o \
    $(O)/tests/support/memory_flash.o $(LIB_reference) $(LIB_hs) $(LIB_firmware) $(LIB_fixed)
$(TARGET_TESTS): LDLIBS := -lcmocka $(call pkgs,libs,proj libpng)
