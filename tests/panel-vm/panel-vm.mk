# The panel in a machine with real kernel interfaces (docs/panel-vm.md).
PANEL_VM := $(O)/bin/tests/panel-vm
$(PANEL_VM)/glass: $(O)/tests/panel-vm/glass.o $(LIB_firmware) $(LIB_fixed)
$(PANEL_VM)/glass: LDLIBS := $(call pkgs,libs,libpng)
