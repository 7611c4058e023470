# landmass-bus. Its objects without main.o serve the tests too.
BUS_OBJS := $(call objs,$(filter-out %/main.c,$(wildcard host-sim/bus/*.c)))
PROGRAMS += $(O)/bin/landmass-bus
$(O)/bin/landmass-bus: $(O)/host-sim/bus/main.o $(BUS_OBJS) $(O)/drivers/can/can_log.o $(O)/drivers/can/can_socket.o \
    $(LIB_firmware) $(LIB_fixed) $(LIB_hs)

# The text table that is built into the firmware as lm_bus_generic.
BUS_TABLE ?= host-sim/bus/arinc825.bus
.PHONY: bus-table
bus-table: $(O)/bin/landmass-bus ## Build BUS_TABLE=FILE, a text table of your own bus, into the firmware
	@$(O)/bin/landmass-bus generate --table $(BUS_TABLE) --out firmware/bus/bus_generic.c
	@echo 'firmware/bus/bus_generic.c is made of $(BUS_TABLE); build again'
