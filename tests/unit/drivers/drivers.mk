# The drivers that run on a PC, each with its objects only.
DRIVER_TESTS := $(addprefix $(O)/bin/tests/unit/drivers/,test_can_log test_can_socket)
TESTS += $(DRIVER_TESTS)
$(DRIVER_TESTS): $(O)/bin/tests/unit/drivers/test_%: $(O)/tests/unit/drivers/test_%.o $(O)/drivers/can/%.o \
    $(TEST_SUPPORT) $(LIB_firmware) $(LIB_fixed) $(LIB_hs)
$(DRIVER_TESTS): LDLIBS := -lcmocka -lz $(call pkgs,libs,libpng)
