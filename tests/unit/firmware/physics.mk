# The radar's physics, each stage against theory and the reference in double precision.
PHYSICS := test_texture test_receiver test_weather test_patch_rain test_aperture test_beam
PHYSICS_TESTS := $(addprefix $(O)/bin/tests/unit/firmware/,$(PHYSICS))
TESTS += $(PHYSICS_TESTS)
$(PHYSICS_TESTS): $(O)/bin/tests/%: $(O)/tests/%.o $(O)/tests/support/tiny_image.o $(O)/tests/support/memory_flash.o $(LIB_reference) $(LIB_hs) $(LIB_firmware) $(LIB_fixed)
$(PHYSICS_TESTS): LDLIBS := -lcmocka
