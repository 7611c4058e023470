# One program of the board's own files, its drivers and the firmware. On bare metal this is where your linker script
# from linker/ comes in (bsp/zcu102/zcu102.mk).
PROGRAMS += $(O)/bin/landmass-template
$(O)/bin/landmass-template: $(call objs,$(wildcard bsp/template/*.c)) $(LIB_drivers) $(LIB_firmware) $(LIB_fixed)
