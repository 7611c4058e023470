# The main job on inputs that nobody here made, and on an airfield with parked targets: each test runs a scene of
# host-sim/run/gallery_scene.sh and looks at its pictures.
REAL_TESTS := $(patsubst tests/system/%.c,$(O)/bin/tests/system/%, \
    $(wildcard tests/system/test_real_*.c) tests/system/test_airfield.c)
TESTS += $(REAL_TESTS)
$(REAL_TESTS:$(O)/bin/%=$(O)/%.o) $(O)/tests/system/real_scene.o: EXTRA_CFLAGS := $(call pkgs,cflags,gdal)
$(REAL_TESTS): $(O)/bin/tests/system/%: $(O)/tests/system/%.o $(O)/tests/system/real_scene.o \
    $(O)/drivers/flash/flash_file.o \
    $(LIB_support) $(O)/host-sim/lib/liblib.a $(LIB_firmware) $(LIB_fixed) \
    | $(addprefix $(O)/bin/landmass-,db nav sim target)
$(REAL_TESTS): LDLIBS := -lcmocka $(call pkgs,libs,gdal proj libpng)
