# The comparison with real radar: its parts on echoes of known shape, and the real data within physical bounds.
T := $(O)/bin/tests/system/test_realradar
TESTS += $(T)
$(O)/tests/system/test_realradar.o: EXTRA_CFLAGS := $(call host_cflags,realradar)
$(T): $(O)/tests/system/test_realradar.o $(TEST_SUPPORT) $(call host_archives,realradar firmware fixed) \
    | $(O)/bin/landmass-realradar $(O)/bin/landmass-db
$(T): LDLIBS := -lcmocka $(call host_links,realradar)
