# Specific targets, against their double-precision reference.
TARGET_TESTS := $(addprefix $(O)/bin/tests/unit/firmware/,test_rcs test_target test_target_line test_target_picture \
    test_mover test_target_patch test_signature test_signature_picture test_signature_smear)
TESTS += $(TARGET_TESTS)
$(TARGET_TESTS): $(O)/bin/tests/unit/firmware/%: $(O)/tests/unit/firmware/%.o $(TEST_SUPPORT) $(O)/tests/support/tiny_image.o \
    $(O)/tests/support/memory_flash.o $(LIB_reference) $(LIB_hs) $(LIB_firmware) $(LIB_fixed)
$(TARGET_TESTS): LDLIBS := -lcmocka $(call pkgs,libs,proj libpng)

# The tests of lines and patches once more under the address and undefined-behaviour sanitizers: they use records made by chance.
TARGET_SANE     := $(addprefix $(O)/bin/tests/unit/firmware/test_,target_line_sanitized target_patch_sanitized signature_sanitized)
TARGET_SANE_SRC := firmware/targets/rcs.c firmware/targets/target.c firmware/targets/target_near.c firmware/targets/target_view.c firmware/targets/mover.c firmware/targets/target_line.c firmware/targets/target_patch.c firmware/clutter/smear.c firmware/targets/signature.c firmware/targets/chips.c firmware/targets/chip_lay.c firmware/targets/chip_line.c firmware/clutter/noise_table.c firmware/clutter/response_table.c firmware/map/db.c firmware/base/geo.c firmware/map/scan_line.c firmware/map/tile_cache.c firmware/map/tile_read.c $(SRC_fixed) host-sim/lib/rng.c \
    $(addprefix host-sim/reference/,aspect.c aperture.c receiver.c speckle.c chip.c) $(addprefix tests/support/,tiny_image.c memory_flash.c)
TESTS += $(TARGET_SANE)
$(TARGET_SANE): $(O)/bin/tests/unit/firmware/%_sanitized: tests/unit/firmware/%.c $(TARGET_SANE_SRC) \
    $(wildcard tests/unit/firmware/target_*.h tests/unit/firmware/signature_image.h firmware/*/include/lm/*.h)
	@mkdir -p $(@D)
	$(call say,CC,$@ (sanitizers))
	@$(CC) $(CFLAGS_host) -O1 -fsanitize=address,undefined -fno-sanitize-recover=all -Itests/support $(filter %.c,$^) \
	    -lcmocka $(call pkgs,libs,proj) -lm -o $@
