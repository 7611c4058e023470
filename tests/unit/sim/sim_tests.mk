# The bench's script, bezel, hands and window.
SIM_TESTS := $(addprefix $(O)/bin/tests/unit/sim/test_,script bezel window)
TESTS += $(SIM_TESTS)
$(O)/tests/unit/sim/%.o: EXTRA_CFLAGS := -Ihost-sim/sim $(call pkgs,cflags,sdl2)
$(SIM_TESTS): $(O)/bin/%: $(O)/%.o $(addprefix $(O)/host-sim/sim/,script.o bezel.o hands.o window.o) $(TEST_SUPPORT) \
    $(LIB_hs) $(LIB_firmware) $(LIB_fixed)
$(SIM_TESTS): LDLIBS := -lcmocka $(call pkgs,libs,sdl2 libpng)
