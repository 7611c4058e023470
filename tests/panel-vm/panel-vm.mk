# The panel in a machine with real kernel interfaces (docs/panel-vm.md). The machine's programs are built for the panel's
# architecture by a make of its own; here are what looks at them and the tests.
PANEL_VM := $(O)/bin/tests/panel-vm
$(PANEL_VM)/glass: $(O)/tests/panel-vm/glass.o $(LIB_firmware) $(LIB_fixed)
$(PANEL_VM)/glass: LDLIBS := $(call pkgs,libs,libpng)
$(PANEL_VM)/can_probe: $(O)/tests/panel-vm/can_probe.o $(O)/drivers/can/can_socket.o $(LIB_firmware) $(LIB_fixed)
$(O)/tests/panel-vm/count_malloc.o: EXTRA_CFLAGS := -fPIC
$(PANEL_VM)/count_malloc.so: $(O)/tests/panel-vm/count_malloc.o
$(PANEL_VM)/count_malloc.so: LDFLAGS := -shared

PANEL_VM_TESTS := $(addprefix $(PANEL_VM)/,test_bus test_panel test_flash test_two test_dis test_systemd test_gpiod2)
ifeq ($(BOARD),bench-linux)
PANEL_VM_TESTS += $(PANEL_VM)/test_loads
TESTS += $(PANEL_VM_TESTS)
endif
$(PANEL_VM_TESTS): $(PANEL_VM)/%: tests/panel-vm/%.py $(PANEL_VM)/glass $(addprefix $(O)/bin/landmass-,sim nav db dis) \
    $(O)/bin/tests/system/test_sim_tool | $(if $(filter build/$(BOARD),$(O)),panel-vm-guest)
	@mkdir -p $(@D)
	@printf '#!/bin/sh\nexec python3 -B %s "$$@"\n' $< >$@
	@chmod +x $@

$(PANEL_VM)/test_loads: $(addprefix $(O)/bin/landmass-,load scene)

kills: deps ## Kill 300 virtual machines while they load a database (KILLS=300, LANDMASS_SEED=1)
	@$(MAKE) --no-print-directory -j2 $(PANEL_VM)/test_loads
	@LANDMASS_VM_KILLS=$(or $(KILLS),300) $(PANEL_VM)/test_loads killed

bench-panel: deps ## Measure the panel in QEMU: nav frame to glass, regularity, processor, memory
	@$(MAKE) --no-print-directory -j2 $(PANEL_VM_TESTS)
	@python3 -B tests/panel-vm/bench_panel.py

.PHONY: kills bench-panel panel-vm-guest panel-vm-programs check-panel-built
# One after the other, because golden pictures and guest are built in one folder.
panel-vm-guest: | golden-arm64
	@$(call make_board,panel-linux) ARCH=amd64 panel-package >/dev/null
	@$(call make_board,panel-linux) ARCH=arm64 panel-package panel-vm-programs >/dev/null
panel-vm-programs: $(addprefix $(PANEL_VM)/,can_probe can_driver count_malloc.so)
check-panel-built: $(PANEL_VM_TESTS)
	@sh tests/run.sh $(O) $(PANEL_VM_TESTS)
