# The comparison with real radar: its parts on echoes of known shape, and the real data within physical bounds.
TEST_REALRADAR := $(O)/bin/tests/system/test_realradar
TESTS += $(TEST_REALRADAR)
$(O)/tests/system/test_realradar.o: EXTRA_CFLAGS := $(call host_cflags,realradar)
$(TEST_REALRADAR): $(O)/tests/system/test_realradar.o $(LIB_support) $(call host_archives,realradar firmware fixed) \
    | $(O)/bin/landmass-realradar $(O)/bin/landmass-db
$(TEST_REALRADAR): LDLIBS := -lcmocka $(call host_links,realradar)
