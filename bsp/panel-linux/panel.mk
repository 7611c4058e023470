# landmass-panel: the installed cockpit panel. Built with the tests for this machine, and by `make panel` for ARCH.
LIB_panel := $(O)/libpanel.a
$(call archive, $(LIB_panel), $(filter-out %/main.c,$(wildcard bsp/panel-linux/*.c)))
PANEL := $(O)/bin/landmass-panel
PROGRAMS += $(PANEL)
$(PANEL): $(O)/bsp/panel-linux/main.o $(LIB_panel) $(LIB_drivers) $(LIB_firmware) $(LIB_fixed)
$(PANEL): LDLIBS = $(LINUX_LIBS)

.PHONY: panel-program panel-package
panel-package: $(PANEL)
	@STRIP=$(TRIPLET)-strip OBJDUMP=$(TRIPLET)-objdump \
	    sh bsp/panel-linux/debian/build.sh $(ARCH) $(PANEL) build/packages $(RUN)
panel-program: $(PANEL)
	@echo 'the panel for $(ARCH): $(PANEL)'
