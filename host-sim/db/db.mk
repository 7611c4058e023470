# landmass-db: imagery, exemplars and terrain in, database out. LIB_db is all of it without main.c, for the tests.
LIB_db := $(O)/host-sim/db/libdb.a
DB_PKGS := gdal openblas libpng
T := $(O)/bin/landmass-db
PROGRAMS += $(T)
$(O)/host-sim/db/%.o: EXTRA_CFLAGS := $(call pkgs,cflags,$(DB_PKGS))
# The forward pass and the reflectivity noise are loops over pixels that are worth vectorising.
$(O)/host-sim/db/mlp_apply.o $(O)/host-sim/db/reflect.o: EXTRA_CFLAGS += -O3 -fno-math-errno -fno-trapping-math
$(LIB_db): $(patsubst %.c,$(O)/%.o,$(filter-out host-sim/db/main.c,$(wildcard host-sim/db/*.c)))
$(T): $(O)/host-sim/db/main.o $(LIB_db) $(LIB_hs) $(LIB_firmware) $(LIB_fixed)
$(T): LDLIBS := $(call pkgs,libs,$(DB_PKGS))
