# landmass-target: the radar picture of a model by ray tracing. LIB_target is all of it without main.c, for the tests.
LIB_target := $(O)/host-sim/target/libtarget.a
LIBS_target := -lembree3 -lpthread
$(LIB_target): $(call objs,$(filter-out %/main.c,$(wildcard host-sim/target/*.c)))
