CORE_TESTS := geo tile_cache db
CORE_TEST_BINS := $(CORE_TESTS:%=$(O)/bin/tests/unit/firmware/test_%)
TESTS += $(CORE_TEST_BINS)
$(CORE_TEST_BINS): $(O)/bin/tests/unit/firmware/%: $(O)/tests/unit/firmware/%.o $(TEST_SUPPORT) \
    $(O)/tests/support/tiny_image.o $(O)/tests/support/memory_flash.o $(LIB_hs) $(LIB_firmware) $(LIB_fixed)
$(CORE_TEST_BINS): LDLIBS := -lcmocka $(call pkgs,libs,proj libpng)

T := $(O)/bin/tests/unit/firmware/test_against_reference
TESTS += $(T)
$(T): $(O)/tests/unit/firmware/test_against_reference.o $(O)/tests/support/tiny_image.o \
    $(O)/tests/support/memory_flash.o $(LIB_reference) $(LIB_hs) $(LIB_firmware) $(LIB_fixed)
$(T): LDLIBS := -lcmocka $(call pkgs,libs,libpng)
