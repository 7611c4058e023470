# The panel's configuration, its loop, and its package.
T := $(O)/bin/tests/unit/panel/test_config
TESTS += $(T)
$(O)/tests/unit/panel/%.o: EXTRA_CFLAGS := -Ibsp/panel-linux -Itests/unit/firmware
$(T): $(addprefix $(O)/,tests/unit/panel/test_config.o bsp/panel-linux/config.o bsp/panel-linux/config_table.o) $(LIB_firmware) $(LIB_fixed)
$(T): LDLIBS := -lcmocka

T := $(O)/bin/tests/unit/panel/test_panel
TESTS += $(T)
$(T): $(O)/tests/unit/panel/test_panel.o $(O)/tests/unit/firmware/unit_rig.o $(TEST_SUPPORT) $(O)/tests/support/tiny_image.o \
    $(O)/tests/support/memory_flash.o $(LIB_panel) $(LIB_drivers) $(LIB_hs) $(LIB_firmware) $(LIB_fixed)
$(T): LDLIBS = -lcmocka $(LINUX_LIBS) $(call pkgs,libs,libpng)

T := $(O)/bin/tests/unit/panel/test_package
TESTS += $(T)
$(T): tests/unit/panel/test_package.sh $(PANEL) $(wildcard bsp/panel-linux/debian/*)
	@mkdir -p $(@D)
	@cp $< $@
	@chmod +x $@

T := $(O)/bin/tests/unit/panel/test_bezel
TESTS += $(T)
$(O)/tests/unit/panel/test_bezel.o: EXTRA_CFLAGS += -Itests/unit/drivers
$(T): $(addprefix $(O)/,tests/unit/panel/test_bezel.o tests/unit/drivers/fake_gpio.o tests/unit/drivers/fake_gpiod$(GPIOD_MAJOR).o \
    $(addprefix bsp/panel-linux/,bezel.o config.o config_table.o report.o) $(addprefix drivers/gpio/,gpio.o debounce.o lines_gpiod$(GPIOD_MAJOR).o)) \
    $(TEST_SUPPORT) $(LIB_firmware) $(LIB_fixed) $(LIB_hs)
$(T): LDLIBS = -lcmocka $(call pkgs,libs,libpng) $(call WRAP,open $(if $(filter 2,$(GPIOD_MAJOR)),opendir readdir closedir))
