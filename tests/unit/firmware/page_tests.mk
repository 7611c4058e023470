# The page and the unit as a whole, on one rig; test_hostile_controls is built with the sanitizers.
RIG_TESTS := $(addprefix $(O)/bin/tests/unit/firmware/test_,unit page)
TESTS += $(RIG_TESTS)
$(RIG_TESTS): $(O)/bin/%: $(O)/%.o $(addprefix $(O)/tests/unit/firmware/,unit_rig.o glass_text.o) $(TEST_SUPPORT) \
    $(O)/tests/support/tiny_image.o $(O)/tests/support/memory_flash.o $(LIB_hs) $(LIB_firmware) $(LIB_fixed)
$(RIG_TESTS): LDLIBS := -lcmocka $(call pkgs,libs,libpng)

GLASS_TESTS := $(addprefix $(O)/bin/tests/unit/firmware/test_,keys cursor overlay)
TESTS += $(GLASS_TESTS)
$(GLASS_TESTS): $(O)/bin/%: $(O)/%.o $(O)/tests/unit/firmware/glass_text.o $(LIB_firmware) $(LIB_fixed)
$(GLASS_TESTS): LDLIBS := -lcmocka $(call pkgs,libs,proj)

# The objects of tests/fuzz/fuzz.mk.
T := $(O)/bin/tests/unit/firmware/test_hostile_controls
TESTS += $(T)
$(T): $(addprefix $(O)/sanitized/tests/unit/firmware/,test_hostile_controls.o unit_rig.o) \
    $(patsubst %.c,$(O)/sanitized/%.o,host-sim/lib/rng.c tests/support/memory_flash.c tests/support/tiny_image.c \
    $(SRC_core))
$(T): LDLIBS := -fsanitize=address,undefined,float-cast-overflow -lcmocka

# The radar table's contract: its words, and a unit with tables at their ends.
T := $(O)/bin/tests/unit/firmware/test_radar_check
TESTS += $(T)
$(T): $(O)/tests/unit/firmware/test_radar_check.o $(LIB_firmware) $(LIB_fixed)
$(T): LDLIBS := -lcmocka

T := $(O)/bin/tests/unit/firmware/test_radar_extremes
TESTS += $(T)
$(T): $(addprefix $(O)/sanitized/tests/unit/firmware/,test_radar_extremes.o unit_rig.o) \
    $(patsubst %.c,$(O)/sanitized/%.o,host-sim/lib/rng.c tests/support/memory_flash.c tests/support/tiny_image.c \
    $(SRC_core))
$(T): LDLIBS := -fsanitize=address,undefined,float-cast-overflow -lcmocka
