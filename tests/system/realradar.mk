# The comparison with real radar: its parts on echoes of known shape, and the real data within physical bounds.
T := $(O)/bin/tests/system/test_realradar
TESTS += $(T)
$(O)/tests/system/test_realradar.o: EXTRA_CFLAGS := -Ihost-sim/realradar -Ihost-sim/db $(call pkgs,cflags,$(REALRADAR_PKGS))
$(T): $(O)/tests/system/test_realradar.o $(TEST_SUPPORT) $(LIB_realradar) $(LIB_db) $(LIB_hs) $(LIB_firmware) $(LIB_fixed) \
    | $(O)/bin/landmass-realradar $(O)/bin/landmass-db
$(T): LDLIBS := -lcmocka $(call pkgs,libs,$(REALRADAR_PKGS) openblas libpng)
