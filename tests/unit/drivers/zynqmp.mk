T := $(O)/bin/tests/unit/drivers/test_zynqmp_devices
TESTS += $(T)
$(T): $(O)/tests/unit/drivers/test_zynqmp_devices.o $(addprefix $(O)/drivers/,can/can_zynqmp.o display/dp_link.o flash/flash_gqspi.o \
    irq/irq_gic400.o uart/uart_cadence.o watchdog/watchdog_cadence.o) $(LIB_fixed)
$(T): LDLIBS := -lcmocka

T := $(O)/bin/tests/unit/drivers/test_bezel_serial
TESTS += $(T)
$(T): $(O)/tests/unit/drivers/test_bezel_serial.o $(O)/drivers/bezel/bezel_serial.o $(LIB_hs)
$(T): LDLIBS := -lcmocka $(call pkgs,libs,libpng)
