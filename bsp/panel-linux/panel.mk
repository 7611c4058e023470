# landmass-panel: the installed cockpit panel. Built with the tests for this machine, and by `make panel` for ARCH.
LIB_panel := $(O)/libpanel.a
$(call archive, $(LIB_panel), $(filter-out %/main.c,$(wildcard bsp/panel-linux/*.c)))
# It reads tables of the bus and slots, and checks signatures, by the libraries of the tools.
PANEL_READER := $(call objs,host-sim/bus/table_text.c \
    $(patsubst %,host-sim/slots/%.c,check medium_file medium_mtd progress slot) \
    $(patsubst %,host-sim/trust/%.c,crypto head keys seal serial verify) \
    $(patsubst %,host-sim/lib/%.c,atomic_file durable_file error input_file json number output_path real_time report whole_file))
$(O)/bsp/panel-linux/%.o $(O)/sanitized/bsp/panel-linux/%.o: EXTRA_CFLAGS := \
    $(patsubst %,-Ihost-sim/%/include,bus lib slots trust)
$(O)/bsp/panel-linux/check_devices.o: EXTRA_CFLAGS += $(call pkgs,cflags,libdrm)
PANEL := $(O)/bin/landmass-panel
PROGRAMS += $(PANEL)
$(PANEL): $(O)/bsp/panel-linux/main.o $(PANEL_READER) $(LIB_panel) $(LIB_record) $(LIB_drivers) $(LIB_firmware) $(LIB_fixed)
PANEL_LIBS = $(LINUX_LIBS) $(call pkgs,libs,libcrypto)
$(PANEL): LDLIBS = $(PANEL_LIBS)

.PHONY: panel-program panel-package
panel-package: $(PANEL) $(O)/bin/landmass-load
	@STRIP=$(TRIPLET)-strip OBJDUMP=$(TRIPLET)-objdump \
	    sh bsp/panel-linux/debian/build.sh $(ARCH) $(PANEL) build/packages $(RUN)
panel-program: $(PANEL)
	@echo 'the panel for $(ARCH): $(PANEL)'
