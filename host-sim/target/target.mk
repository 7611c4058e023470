# landmass-target: the radar picture of a model by ray tracing. LIB_target is all of it without main.c, for the tests.
LIB_target := $(O)/host-sim/target/libtarget.a
# Embree 3 has no pkg-config file in Debian.
LIBS_target := -lembree3 -lpthread $(call pkgs,libs,libpng)
# Command lines are read as landmass-db's are, signatures are what it takes, and the curves are drawn on landmass-figures' sheets.
SHARED_target := $(addprefix $(O)/host-sim/,db/options.o db/signature_file.o figures/chart.o)
T := $(O)/bin/landmass-target
PROGRAMS += $(T)
$(O)/host-sim/target/%.o: EXTRA_CFLAGS := -Ihost-sim/db -Ihost-sim/figures
$(LIB_target): $(call objs,$(filter-out %/main.c,$(wildcard host-sim/target/*.c))) $(SHARED_target)
$(T): $(O)/host-sim/target/main.o $(LIB_target) $(LIB_hs) $(LIB_firmware) $(LIB_fixed)
$(T): LDLIBS := $(LIBS_target)
# The tracer's own share of the time: loops over rays.
$(addprefix $(O)/host-sim/target/,first_bounce.o glance.o projection.o scene.o trace_tile.o): EXTRA_CFLAGS += -O3 -fno-math-errno -fno-trapping-math
