# landmass-netem: reflection learned from radar pictures. LIB_netem is all of it without main.c, for the tests.
LIB_netem := $(O)/host-sim/netem/libnetem.a
NETEM_PKGS := openblas fftw3 gdal libpng zlib
T := $(O)/bin/landmass-netem
PROGRAMS += $(T)
# Aspects and command lines come from landmass-target and real phase histories from landmass-realradar, whose *.mk are read
# later: hence the paths of their libraries; text files are read as landmass-db's are.
SHARED_netem := $(addprefix $(O)/host-sim/db/,text_file.o gdal_start.o)
$(O)/host-sim/netem/%.o: EXTRA_CFLAGS := -Ihost-sim/target -Ihost-sim/db -Ihost-sim/figures -Ihost-sim/realradar $(call pkgs,cflags,$(NETEM_PKGS))
$(LIB_netem): $(call objs,$(filter-out %/main.c,$(wildcard host-sim/netem/*.c))) $(SHARED_netem)
$(T): $(O)/host-sim/netem/main.o $(LIB_netem) $(O)/host-sim/realradar/librealradar.a \
    $(O)/host-sim/target/libtarget.a $(LIB_hs) $(LIB_firmware) $(LIB_fixed)
$(T): LDLIBS = $(LIBS_target) $(call pkgs,libs,$(NETEM_PKGS))
