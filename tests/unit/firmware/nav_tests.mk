# The bus and the ownship. Linked with their rooms alone, so that they build whatever else is being changed.
BUS_SRC   := $(filter firmware/bus/% firmware/nav/%,$(SRC_firmware)) firmware/base/environment.c firmware/base/geo.c
BUS_TESTS := $(addprefix $(O)/bin/tests/unit/firmware/,test_canas test_canas_service test_nav test_weather_bus)
TESTS += $(BUS_TESTS)
$(BUS_TESTS): $(O)/bin/tests/%: $(O)/tests/%.o $(TEST_SUPPORT) $(call objs,$(BUS_SRC)) \
    $(O)/drivers/can/can_log.o $(LIB_fixed) $(LIB_hs)
$(BUS_TESTS): LDLIBS := -lcmocka -lz $(call pkgs,libs,proj libpng)

# The same sources once more under the address and undefined-behaviour sanitizers, which stop at the first finding.
BUS_FUZZ     := $(O)/bin/tests/unit/firmware/test_bus_fuzz
BUS_FUZZ_SRC := tests/unit/firmware/test_bus_fuzz.c $(BUS_SRC) \
    drivers/can/can_log.c $(SRC_fixed) host-sim/lib/rng.c
TESTS += $(BUS_FUZZ)
$(BUS_FUZZ): $(BUS_FUZZ_SRC) $(wildcard tests/unit/firmware/bus_frames.h firmware/*/include/lm/*.h drivers/include/drv/*.h)
	@mkdir -p $(@D)
	$(call say,CC,$@ (sanitizers))
	@$(CC) $(CFLAGS_host) -O1 -fsanitize=address,undefined -fno-sanitize-recover=all $(filter %.c,$^) -lcmocka -lm -o $@
