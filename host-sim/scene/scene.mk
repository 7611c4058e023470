# landmass-scene. Its objects without main.o serve the tests too.
SCENE_OBJS := $(call objs,$(filter-out %/main.c,$(wildcard host-sim/scene/*.c)))
PROGRAMS += $(O)/bin/landmass-scene
$(O)/host-sim/scene/%.o: EXTRA_CFLAGS := $(call pkgs,cflags,gdal)
$(O)/bin/landmass-scene: $(O)/host-sim/scene/main.o $(SCENE_OBJS) $(LIB_hs)
$(O)/bin/landmass-scene: LDLIBS := $(call pkgs,libs,gdal libpng)
