# landmass-figures: figures of the documentation, drawn by the firmware's own functions.
T := $(O)/bin/landmass-figures
PROGRAMS += $(T)
$(T): $(patsubst %.c,$(O)/%.o,$(wildcard host-sim/figures/*.c)) $(LIB_hs) $(LIB_firmware) $(LIB_fixed)
$(T): LDLIBS := $(call pkgs,libs,libpng)
