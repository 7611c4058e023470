LIB_reference := $(O)/libreference.a
$(LIB_reference): $(call objs,$(filter-out %/main.c %/dump.c,$(wildcard host-sim/reference/*.c)))

P := $(O)/bin/landmass-reference
PROGRAMS += $(P)
$(P): $(call objs,host-sim/reference/main.c host-sim/reference/dump.c) $(LIB_reference) $(LIB_hs) $(LIB_fixed)
$(P): LDLIBS := $(call pkgs,libs,libpng)
