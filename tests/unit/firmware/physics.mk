# The radar's physics, each stage against theory in double precision.
PHYSICS_TESTS := $(addprefix $(O)/bin/tests/unit/firmware/,test_texture)
TESTS += $(PHYSICS_TESTS)
$(PHYSICS_TESTS): $(O)/bin/tests/%: $(O)/tests/%.o $(O)/tests/support/tiny_image.o $(LIB_firmware) $(LIB_fixed) $(O)/host-sim/common/src/rng.o
$(PHYSICS_TESTS): LDLIBS := -lcmocka
