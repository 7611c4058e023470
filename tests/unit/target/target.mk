$(O)/tests/unit/target/%.o: EXTRA_CFLAGS := -Ihost-sim/target -Ihost-sim/db
TARGET_TESTS := $(patsubst tests/unit/target/%.c,$(O)/bin/tests/unit/target/%,$(wildcard tests/unit/target/test_*.c))
TESTS += $(TARGET_TESTS)
$(TARGET_TESTS): $(O)/bin/tests/unit/target/%: $(O)/tests/unit/target/%.o $(O)/tests/unit/target/known_records.o $(TEST_SUPPORT) \
    $(LIB_target) $(LIB_hs) $(LIB_firmware) $(LIB_fixed) | $(O)/bin/landmass-target
$(TARGET_TESTS): LDLIBS := -lcmocka $(LIBS_target)
