T := $(O)/bin/tests/unit/drivers/test_zynqmp_devices
TESTS += $(T)
$(T): $(O)/tests/unit/drivers/test_zynqmp_devices.o $(addprefix $(O)/drivers/,can/can_zynqmp.o flash/flash_gqspi.o \
    irq/irq_gic400.o uart/uart_cadence.o watchdog/watchdog_cadence.o) $(LIB_fixed)
$(T): LDLIBS := -lcmocka
