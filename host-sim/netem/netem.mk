# landmass-netem: reflection learned from radar pictures. LIB_netem is all of it without main.c, for the tests.
LIB_netem := $(O)/host-sim/netem/libnetem.a
NETEM_PKGS := openblas fftw3 gdal libpng
$(O)/host-sim/netem/%.o: EXTRA_CFLAGS := -Ihost-sim/target -Ihost-sim/db -Ihost-sim/figures $(call pkgs,cflags,$(NETEM_PKGS))
$(LIB_netem): $(call objs,$(filter-out %/main.c,$(wildcard host-sim/netem/*.c)))
