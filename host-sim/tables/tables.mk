# landmass-tables: prints the constant tables; LIB_tables is the same without main, for the test.
LIB_tables := $(O)/host-sim/tables/libtables.a
T := $(O)/bin/landmass-tables
PROGRAMS += $(T)
$(LIB_tables): $(O)/host-sim/tables/sets.o $(O)/host-sim/tables/print.o
$(T): $(O)/host-sim/tables/main.o $(LIB_tables) $(LIB_hs)
$(T): LDLIBS := $(call pkgs,libs,libpng)
