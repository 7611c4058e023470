# Unit tests. Every tests/unit/**/test_*.c is a program: itself, what it uses of the other sources of its folder and of
# tests/support, and what the line of its folder says. The folders mirror the tree: tests of FOLDER lie in tests/unit/FOLDER and see the private
# headers of FOLDER.
#
#   unit_tests FOLDER,SEES,PROGRAMS,PACKAGES
#
# SEES are libraries and layers as in make/host.mk, PROGRAMS those landmass-* that the tests run, PACKAGES their own
# names of pkg-config, or options of the linker. What a single test needs besides is a line at the end.
UNIT := $(O)/bin/tests/unit

# Sources that are no program or no part of all programs of their folder, and tests that run under the sanitizers: those
# alone, or once more as test_*_sanitized.
UNIT_APART          := drivers/gpio/test_gpio drivers/gpio/fake_gpiod1 drivers/gpio/fake_gpiod2
UNIT_SANITIZED      := firmware/bus/test_bus_fuzz $(addprefix firmware/unit/test_,hostile_controls mounted_targets mounts radar_extremes)
UNIT_ALSO_SANITIZED := $(addprefix firmware/,$(addprefix targets/test_,target_line target_patch signature) unit/test_bus_choice)
ifneq ($(findstring coverage,$(O)),) # only the plain objects count what they run
UNIT_SANITIZED :=
UNIT_ALSO_SANITIZED :=
# Tests count, too, what they run of headers of both layers.
$(O)/tests/unit/fixed/%.o $(O)/tests/unit/firmware/%.o: CFLAGS_host += $(OPT_core)
endif

LIB_host_support := $(O)/tests/unit/host-sim/libsupport.a
$(call archive, $(LIB_host_support), $(wildcard tests/unit/host-sim/support/*.c))
$(O)/tests/unit/host-sim/support/%.o: EXTRA_CFLAGS := $(call pkgs,cflags,gdal)

unit_sources  = $(filter-out $(UNIT_APART),$(patsubst tests/unit/%.c,%,$(wildcard tests/unit/$(1)/$(2).c)))
unit_helpers  = $(filter-out $(1)/test_%,$(call unit_sources,$(1),*))
unit_archives = $(O)/tests/unit/$(1)/libhelpers.a $(if $(filter host-sim/%,$(1)),$(LIB_host_support)) $(LIB_support) $(call host_archives,$(2))
unit_links    = $(call host_links,$(1)) -lcmocka $(filter -%,$(2)) $(call pkgs,libs,$(filter-out -%,$(2)))

define unit_tests_rules
$(O)/tests/unit/$(1)/%.o $(O)/sanitized/tests/unit/$(1)/%.o: EXTRA_CFLAGS := -I$(1) -Itests/unit/$(1) -Itests/unit/host-sim/support \
    $(call host_cflags,$(2)) $(call pkgs,cflags,$(filter-out -%,$(4)))
$$(call archive, $(O)/tests/unit/$(1)/libhelpers.a, $(patsubst %,tests/unit/%.c,$(call unit_helpers,$(1))))
UNIT_$(1) := $$(filter-out $(UNIT_SANITIZED:%=$(UNIT)/%),$(patsubst %,$(UNIT)/%,$(call unit_sources,$(1),test_*)))
$$(UNIT_$(1)): $(UNIT)/%: $(O)/tests/unit/%.o $(call unit_archives,$(1),$(2))
SANE_$(1) := $(patsubst %,$(UNIT)/%,$(filter $(1)/%,$(UNIT_SANITIZED)))
SANE_TOO_$(1) := $(patsubst %,$(UNIT)/%_sanitized,$(filter $(1)/%,$(UNIT_ALSO_SANITIZED)))
$$(SANE_$(1)): $(UNIT)/%: $(O)/sanitized/tests/unit/%.o
$$(SANE_TOO_$(1)): $(UNIT)/%_sanitized: $(O)/sanitized/tests/unit/%.o
$$(SANE_$(1)) $$(SANE_TOO_$(1)): $(call sanitized,$(call unit_archives,$(1),$(2)))
$$(UNIT_$(1)): LDLIBS = $$(call unit_links,$(2),$(4))
$$(SANE_$(1)) $$(SANE_TOO_$(1)): LDLIBS = $$(LINK_sanitized) $$(call unit_links,$(2),$(4))
$$(UNIT_$(1)) $$(SANE_$(1)) $$(SANE_TOO_$(1)): | $(3:%=$(O)/bin/landmass-%)
TESTS += $$(UNIT_$(1)) $$(SANE_$(1)) $$(SANE_TOO_$(1))
endef
unit_tests = $(eval $(call unit_tests_rules,$(strip $(1)),$(strip $(2)),$(strip $(3)),$(strip $(4))))

$(call unit_tests, fixed,                       tables lib fixed,                     tables)
$(foreach room,$(ROOMS),$(call unit_tests, firmware/$(room), reference lib firmware fixed drivers, , proj zlib))
$(foreach kind,bezel can display flash gpio usb watchdog,$(call unit_tests, drivers/$(kind), lib firmware fixed drivers, , zlib libdrm libusb-1.0 -pthread))
$(call unit_tests, drivers,                     lib fixed drivers)
$(call unit_tests, bsp/panel-linux,             slots trust bus lib firmware fixed drivers, ,             libusb-1.0 libgpiod -pthread)

$(call unit_tests, bsp/zcu102,                  lib firmware fixed drivers)

$(call unit_tests, host-sim/lib,                gis lib fixed firmware,               db)
$(call unit_tests, host-sim/classify,           classify gis lib)
$(call unit_tests, host-sim/image,              image lib fixed firmware,             db)
$(call unit_tests, host-sim/trust,              trust lib fixed firmware)
$(call unit_tests, host-sim/terrain,            terrain image lib fixed firmware,     db)
$(call unit_tests, host-sim/reflectivity,       reflectivity gis lib,                 db)
$(call unit_tests, host-sim/infrared,           infrared reflectivity gis lib,        db)
$(call unit_tests, host-sim/build,              build image lib fixed firmware,       db)
$(call unit_tests, host-sim/vectors,            vectors gis lib fixed firmware,       db)
$(call unit_tests, host-sim/tracer,             tracer lib fixed firmware,            target)
$(call unit_tests, host-sim/netem,              netem tracer lib fixed firmware)
$(call unit_tests, host-sim/nav,                nav lib fixed firmware drivers,       nav)
$(call unit_tests, host-sim/bus,                bus lib fixed firmware drivers)
$(call unit_tests, host-sim/slots,              slots lib fixed firmware drivers)
$(call unit_tests, host-sim/wire,               wire lib fixed firmware)
$(call unit_tests, host-sim/dis,                dis lib fixed firmware drivers,       dis,      proj)
$(call unit_tests, host-sim/ios,                ios image lib fixed firmware drivers)
$(call unit_tests, host-sim/scene,              scene lib)
$(call unit_tests, host-sim/reference,          reference lib fixed firmware.h,      reference,     proj)
$(call unit_tests, host-sim/sim,                sim nav lib fixed firmware)
$(call unit_tests, host-sim/radar,              radar lib fixed firmware,             radar)
$(call unit_tests, host-sim/programs/db,        infrared gis lib,                              db)
$(call unit_tests, host-sim/programs/target,    tracer lib fixed firmware,            target)
$(call unit_tests, host-sim/programs/netem,     netem tracer lib fixed firmware,      netem)
$(call unit_tests, host-sim/programs/scene,     lib,                                  scene,        gdal)
$(call unit_tests, host-sim/programs/figures,   lib,                                  figures)

# Where a system call or the clock is a fake, the linker leads the driver's calls to it.
WRAP = $(1:%=-Wl,--wrap=%)
$(UNIT)/drivers/display/test_drm:     LDLIBS += $(call WRAP,open close ioctl read mmap munmap)
$(UNIT)/drivers/display/test_fbdev:   LDLIBS += $(call WRAP,open ioctl)
$(UNIT)/drivers/flash/test_flash_mtd: LDLIBS += $(call WRAP,open close ioctl pread)
$(UNIT)/drivers/usb/test_usb:         LDLIBS += $(call WRAP,clock_gettime)

# Where each text of the glass stands, the test learns from the firmware's calls.
$(UNIT)/firmware/unit/test_glass:      LDLIBS += $(call WRAP,lm_draw_text)

# The bezel over both versions of libgpiod, each a fake: version 1 where its header is installed, version 2 with a header of
# ours where it is not. Both versions' objects come before the library, which has one of them.
GPIO_TESTS := $(addprefix $(UNIT)/drivers/gpio/test_gpio,$(filter 1,$(GPIOD_MAJOR)) 2)
TESTS += $(GPIO_TESTS)
WRAP_gpiod2 := $(call WRAP,opendir readdir closedir)
GPIOD2_HEADER := $(if $(filter 2,$(GPIOD_MAJOR)),,-Itests/unit/drivers/gpio/gpiod2)
$(O)/tests/unit/drivers/gpio/fake_gpiod2.o: EXTRA_CFLAGS := $(GPIOD2_HEADER)
$(O)/drivers/gpio/lines_gpiod2.o: CFLAGS_drivers += $(GPIOD2_HEADER)
$(GPIO_TESTS): $(UNIT)/drivers/gpio/test_gpio%: $(addprefix $(O)/tests/unit/drivers/gpio/,test_gpio.o fake_gpio.o fake_gpiod%.o) \
    $(O)/drivers/gpio/lines_gpiod%.o $(LIB_support) $(LIB_drivers)
$(GPIO_TESTS): LDLIBS := -lcmocka
$(UNIT)/drivers/gpio/test_gpio2: LDLIBS += $(WRAP_gpiod2)

# Devices of the board ZCU102, as memory.
$(UNIT)/drivers/test_zynqmp_devices: $(addprefix $(O)/drivers/,can/can_zynqmp.o display/dp_link.o flash/flash_gqspi.o \
    irq/irq_gic400.o uart/uart_cadence.o watchdog/watchdog_cadence.o)
$(UNIT)/drivers/bezel/test_bezel_serial: $(O)/drivers/bezel/bezel_serial.o

# Of the board itself, what needs no board.
$(UNIT_bsp/zcu102): $(addprefix $(O)/,bsp/zcu102/recording.o bsp/zcu102/console.o drivers/uart/uart_cadence.o) $(LIB_record)
$(O)/bsp/zcu102/%.o: EXTRA_CFLAGS += -Ibsp/zcu102

# The panel's program is a library without its main; its bezel stands on the fake lines of drivers/gpio.
$(UNIT_bsp/panel-linux): $(LIB_panel) $(LIB_record)
$(O)/tests/unit/bsp/panel-linux/%.o: EXTRA_CFLAGS += -Itests/unit/drivers/gpio
$(UNIT)/bsp/panel-linux/test_bezel: $(addprefix $(O)/tests/unit/drivers/gpio/,fake_gpio.o fake_gpiod$(GPIOD_MAJOR).o)
$(UNIT)/bsp/panel-linux/test_bezel: LDLIBS += $(call WRAP,open) $(if $(filter 2,$(GPIOD_MAJOR)),$(WRAP_gpiod2))

# Tests that are scripts.
define unit_script
TESTS += $(UNIT)/$(basename $(1))
$(UNIT)/$(basename $(1)): tests/unit/$(1)
	@mkdir -p $$(@D)
	@cp $$< $$@
	@chmod +x $$@
endef
$(eval $(call unit_script,bsp/panel-linux/test_package.sh))
$(eval $(call unit_script,host-sim/package/test_package.sh))
$(eval $(call unit_script,host-sim/package/test_sbom.py))
$(eval $(call unit_script,host-sim/programs/bus/test_forms.py))
$(eval $(call unit_script,host-sim/programs/dis/test_dis.py))
$(eval $(call unit_script,host-sim/programs/json/test_json.py))
$(eval $(call unit_script,host-sim/slots/test_kills.py))
$(eval $(call unit_script,host-sim/slots/test_plants.sh))
$(eval $(call unit_script,host-sim/wire/test_send.py))
$(eval $(call unit_script,host-sim/programs/nav/test_nav_live.py))
$(eval $(call unit_script,host-sim/programs/progress/test_progress.py))
$(UNIT)/bsp/panel-linux/test_package: $(PANEL) $(O)/bin/landmass-load $(wildcard bsp/panel-linux/debian/*)
$(UNIT)/host-sim/package/test_package: $(PROGRAMS) $(O)/ios/.made $(wildcard host-sim/package/*)
$(UNIT)/host-sim/package/test_sbom: $(PANEL) $(O)/bin/landmass-load $(wildcard host-sim/package/*)
$(UNIT)/host-sim/programs/dis/test_dis: | $(O)/bin/landmass-dis
$(UNIT)/host-sim/programs/nav/test_nav_live: | $(O)/bin/landmass-nav
$(UNIT)/host-sim/slots/test_kills: | $(addprefix $(O)/bin/landmass-,load db scene)
$(UNIT)/host-sim/wire/test_send: | $(addprefix $(O)/bin/,landmass-load landmass-db tests/system/test_sim_tool)
$(UNIT)/host-sim/slots/test_plants: | $(UNIT)/host-sim/slots/test_cuts
$(UNIT)/host-sim/programs/json/test_json $(UNIT)/host-sim/programs/progress/test_progress: | $(HOST_TOOLS)
$(UNIT)/host-sim/programs/bus/test_forms: | $(O)/bin/landmass-bus $(GEN)/bin/bus_table

# SEED and TABLES of the command line are in the test's environment.
.PHONY: tables
tables: $(UNIT)/firmware/unit/test_radar_extremes ## Draw radar tables by SEED=1, fly and look with each: nothing may overflow (TABLES=1000)
	@SEED=$(or $(SEED),1) TABLES=$(or $(TABLES),1000) $<
