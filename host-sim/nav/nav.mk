# landmass-nav. Its objects without main.o serve the tests too.
NAV_OBJS := $(call objs,$(filter-out %/main.c,$(wildcard host-sim/nav/*.c)))
PROGRAMS += $(O)/bin/landmass-nav
$(O)/bin/landmass-nav: $(O)/host-sim/nav/main.o $(NAV_OBJS) $(LIB_hs)
$(O)/bin/landmass-nav: LDLIBS := $(call pkgs,libs,proj expat zlib)
