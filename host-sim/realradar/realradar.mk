# landmass-realradar: the simulation beside real radar. LIB_realradar is all of it without main.c, for the tests.
LIB_realradar := $(O)/host-sim/realradar/librealradar.a
REALRADAR_PKGS := gdal fftw3 zlib
T := $(O)/bin/landmass-realradar
PROGRAMS += $(T)
# The plot's letters are the display's own.
$(O)/host-sim/realradar/%.o: EXTRA_CFLAGS := -Ihost-sim/db $(call pkgs,cflags,$(REALRADAR_PKGS))
$(LIB_realradar): $(call objs,$(filter-out %/main.c,$(wildcard host-sim/realradar/*.c)))
$(T): $(O)/host-sim/realradar/main.o $(LIB_realradar) $(LIB_db) $(LIB_hs) $(LIB_firmware) $(LIB_fixed)
$(T): LDLIBS := $(call pkgs,libs,$(REALRADAR_PKGS) openblas libpng)
