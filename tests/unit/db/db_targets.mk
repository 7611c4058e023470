# The sections TARGETS and SIGNATURES of the flash image.
DB_TARGETS_TESTS := $(addprefix $(O)/bin/tests/unit/db/,test_targets test_signatures)
TESTS += $(DB_TARGETS_TESTS)
$(addprefix $(O)/tests/unit/db/,test_targets.o test_signatures.o): EXTRA_CFLAGS := -Ihost-sim/db $(call pkgs,cflags,gdal)
$(DB_TARGETS_TESTS): $(O)/bin/tests/unit/db/%: $(O)/tests/unit/db/%.o $(O)/tests/unit/db/scene.o $(O)/tests/support/memory_flash.o \
    $(TEST_SUPPORT) $(LIB_db) $(LIB_hs) $(LIB_firmware) $(LIB_fixed) | $(O)/bin/landmass-db
$(DB_TARGETS_TESTS): LDLIBS := -lcmocka $(call pkgs,libs,gdal openblas libpng)
