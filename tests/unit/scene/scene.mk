$(O)/tests/unit/scene/%.o: EXTRA_CFLAGS := -Ihost-sim/scene $(call pkgs,cflags,gdal)

T := $(O)/bin/tests/unit/scene/test_land
TESTS += $(T)
$(T): $(O)/tests/unit/scene/test_land.o $(SCENE_OBJS) $(LIB_hs)
$(T): LDLIBS := -lcmocka $(call pkgs,libs,gdal libpng)

T := $(O)/bin/tests/unit/scene/test_scene
TESTS += $(T)
$(T): $(O)/tests/unit/scene/test_scene.o $(TEST_SUPPORT) $(LIB_hs) | $(O)/bin/landmass-scene
$(T): LDLIBS := -lcmocka $(call pkgs,libs,gdal)
