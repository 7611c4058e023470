# Sectors: every stage against the reference, what a sweep shows, and windows in flight.
SECTOR_TESTS := $(addprefix $(O)/bin/tests/unit/firmware/,test_sector test_sector_stages test_sector_doppler \
    test_footprint)
TESTS += $(SECTOR_TESTS)
$(SECTOR_TESTS): $(O)/bin/%: $(O)/%.o $(addprefix $(O)/tests/unit/firmware/,sector_world.o unit_rig.o) \
    $(O)/tests/support/tiny_image.o $(O)/tests/support/memory_flash.o $(LIB_reference) $(LIB_hs) $(LIB_firmware) $(LIB_fixed)
$(SECTOR_TESTS): LDLIBS := -lcmocka $(call pkgs,libs,libpng)
