$(O)/tests/unit/reference/%.o: EXTRA_CFLAGS := -Ihost-sim/reference

REFERENCE_TESTS := $(patsubst tests/unit/reference/%.c,$(O)/bin/tests/unit/reference/%,$(wildcard tests/unit/reference/test_*.c))
TESTS += $(REFERENCE_TESTS)
$(REFERENCE_TESTS): $(O)/bin/tests/unit/reference/%: $(O)/tests/unit/reference/%.o $(O)/tests/support/tiny_image.o $(TEST_SUPPORT) $(LIB_reference) $(LIB_hs) $(LIB_fixed)
$(REFERENCE_TESTS): LDLIBS := -lcmocka $(call pkgs,libs,proj libpng)
