# The stages of a line, each against theory in double precision.
STAGE_TESTS := $(addprefix $(O)/bin/tests/unit/firmware/,test_scan_line test_aspect test_horizon test_speckle test_tone test_scan_conv test_view)
TESTS += $(STAGE_TESTS)
$(STAGE_TESTS): $(O)/bin/tests/%: $(O)/tests/%.o $(O)/tests/support/tiny_image.o $(O)/tests/support/memory_flash.o \
    $(LIB_firmware) $(LIB_fixed) $(O)/host-sim/lib/rng.o
$(STAGE_TESTS): LDLIBS := -lcmocka
