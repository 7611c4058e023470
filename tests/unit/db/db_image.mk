# Writer, checker, terrain and build of the flash image.
DB_IMAGE_TESTS := $(addprefix $(O)/bin/tests/unit/db/,test_image test_terrain test_build)
TESTS += $(DB_IMAGE_TESTS)
$(addprefix $(O)/tests/unit/db/,test_image.o test_terrain.o test_build.o scene.o): EXTRA_CFLAGS := -Ihost-sim/db $(call pkgs,cflags,gdal)
$(DB_IMAGE_TESTS): $(O)/bin/tests/unit/db/%: $(O)/tests/unit/db/%.o $(O)/tests/unit/db/scene.o $(O)/tests/support/tiny_image.o \
    $(O)/tests/support/memory_flash.o $(TEST_SUPPORT) $(LIB_db) $(LIB_hs) $(LIB_firmware) $(LIB_fixed) | $(O)/bin/landmass-db
$(DB_IMAGE_TESTS): LDLIBS := -lcmocka $(call pkgs,libs,gdal openblas libpng)
