# Unit tests of host libraries and programs: one line each, and every test_*.c of the folder is a test.
#
#   host_tests FOLDER,SEES,PROGRAMS,PACKAGES
#
# Tests of tests/unit/host-sim/FOLDER: the libraries that they see, as in host-sim/host-sim.mk, the programs that they run,
# and packages of their own.
# The tests of a library see its private headers too. What several folders use is in support/.
HOST_TEST_SUPPORT := $(O)/tests/unit/host-sim/libsupport.a
$(HOST_TEST_SUPPORT): $(call objs,$(wildcard tests/unit/host-sim/support/*.c) $(addprefix tests/support/,support.c tiny_image.c memory_flash.c))
$(O)/tests/unit/host-sim/support/%.o: EXTRA_CFLAGS := $(call host_cflags,$(HOST_LIBS))

define host_tests_rules
HOST_TESTS_$(1) := $(patsubst %.c,$(O)/bin/%,$(wildcard tests/unit/host-sim/$(1)/test_*.c))
TESTS += $$(HOST_TESTS_$(1))
$(O)/tests/unit/host-sim/$(1)/%.o: EXTRA_CFLAGS := -Ihost-sim/$(1) -Itests/unit/host-sim/support $(call host_cflags,$(2)) $(call pkgs,cflags,$(4))
$$(HOST_TESTS_$(1)): $(O)/bin/%: $(O)/%.o $(call objs,$(filter-out $(wildcard tests/unit/host-sim/$(1)/test_*.c),$(wildcard tests/unit/host-sim/$(1)/*.c))) \
    $(HOST_TEST_SUPPORT) $(call host_archives,$(2)) | $(3:%=$(O)/bin/landmass-%)
$$(HOST_TESTS_$(1)): LDLIBS = -lcmocka $$(call host_links,$(2)) $$(call pkgs,libs,$(4))
endef
host_tests = $(eval $(call host_tests_rules,$(strip $(1)),$(strip $(2)),$(strip $(3)),$(strip $(4))))

# The recorded flights on a whole unit: its rig stands before the libraries.
$(O)/bin/tests/unit/host-sim/nav/test_display_states: $(O)/tests/unit/firmware/unit_rig.o

$(call host_tests, lib,                gis lib fixed firmware,               db)
$(call host_tests, classify,           classify gis lib)
$(call host_tests, image,              image lib fixed firmware,             db)
$(call host_tests, terrain,            terrain image lib fixed firmware,     db)
$(call host_tests, reflectivity,       reflectivity gis lib,                 db)
$(call host_tests, build,              build image lib fixed firmware,       db)
$(call host_tests, tracer,             tracer lib fixed firmware,            target)
$(call host_tests, netem,              netem tracer lib fixed firmware)
$(call host_tests, nav,                nav lib fixed firmware drivers,       nav)
$(call host_tests, bus,                bus lib fixed firmware drivers)
$(call host_tests, scene,              scene lib)
$(call host_tests, reference,          reference lib fixed firmware.h,      ,         proj)
$(call host_tests, sim,                sim lib fixed firmware)
$(call host_tests, programs/db,        gis lib,                              db)
$(call host_tests, programs/target,    tracer lib fixed firmware,            target)
$(call host_tests, programs/netem,     netem tracer lib fixed firmware,      netem)
$(call host_tests, programs/scene,     lib,                                  scene,    gdal)
$(call host_tests, programs/figures,   lib,                                  figures)

# The forms of a bus profile that landmass-bus prints, against the decoder.
BUS_FORMS := $(O)/bin/tests/unit/host-sim/programs/bus/test_forms
TESTS += $(BUS_FORMS)
$(BUS_FORMS): tests/unit/host-sim/programs/bus/test_forms.py | $(O)/bin/landmass-bus $(GEN)/bin/bus_table
	@mkdir -p $(@D)
	@cp $< $@
	@chmod +x $@
