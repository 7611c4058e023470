# landmass-sim: the firmware on the bench board, with drivers for the bus and a window for the glass.
LIB_bench := $(O)/libbench.a
$(LIB_bench): $(call objs,$(wildcard bsp/bench-linux/*.c))
T := $(O)/bin/landmass-sim
PROGRAMS += $(T)
$(O)/host-sim/sim/%.o: EXTRA_CFLAGS := $(call pkgs,cflags,sdl2)
$(T): $(call objs,$(wildcard host-sim/sim/*.c)) $(LIB_bench) $(LIB_drivers) $(LIB_hs) $(LIB_firmware) $(LIB_fixed)
$(T): LDLIBS := $(call pkgs,libs,sdl2 libpng)
