# Every test_*.c here is one program on its own.
FIXED_TESTS := $(patsubst tests/%.c,$(O)/bin/tests/%,$(wildcard tests/unit/fixed/test_*.c))
TESTS += $(FIXED_TESTS)
$(FIXED_TESTS): $(O)/bin/tests/%: $(O)/tests/%.o $(TEST_SUPPORT) $(LIB_tables) $(LIB_fixed) $(LIB_hs)
$(FIXED_TESTS): LDLIBS := -lcmocka $(call pkgs,libs,libpng)
# This one also runs the program.
$(O)/bin/tests/unit/fixed/test_tables: | $(O)/bin/landmass-tables
