# The section TARGETS of the flash image.
T := $(O)/bin/tests/unit/db/test_targets
TESTS += $(T)
$(O)/tests/unit/db/test_targets.o: EXTRA_CFLAGS := -Ihost-sim/db $(call pkgs,cflags,gdal)
$(T): $(O)/tests/unit/db/test_targets.o $(O)/tests/unit/db/scene.o $(O)/tests/support/memory_flash.o $(TEST_SUPPORT) \
    $(LIB_db) $(LIB_hs) $(LIB_firmware) $(LIB_fixed) | $(O)/bin/landmass-db
$(T): LDLIBS := -lcmocka $(call pkgs,libs,gdal openblas libpng)
