# Host libraries and programs: one line each, the lowest library first.
#
#   host_library NAME,SEES,PACKAGES     host-sim/NAME/*.c; public headers in host-sim/NAME/include/NAME/ (those of lib: include/hs/)
#   host_program NAME,SEES              host-sim/programs/NAME/*.c, which become bin/landmass-NAME
#   host_generator NAME,SEES            the same, built where make/generated.mk says and not for the user
#
# SEES names all libraries whose public headers a part may include, and `fixed`, `firmware`, `drivers`, `bench` (the bench
# board). `firmware.h` stands for the headers of the firmware without its code. No other header can be found. Programs and tests link what
# they see and what that stands on. A library sees earlier lines only, so that the arrows cannot run in a circle.
# PACKAGES are names of pkg-config, or options of the linker.

HOST_LIBS :=
HOST_HEADERS_fixed      := $(INC_fixed)
HOST_HEADERS_firmware   := $(call ROOM_HEADERS,$(ROOMS))
HOST_HEADERS_firmware.h := $(HOST_HEADERS_firmware)
HOST_HEADERS_drivers    := -Idrivers/include
HOST_HEADERS_bench      := -Ibsp/bench-linux
LIB_bench := $(O)/libbench.a
$(LIB_bench): $(call objs,$(wildcard bsp/bench-linux/*.c))

# Of the libraries $(1): themselves and all below, in the order of linking; their packages; headers; archives.
host_needs    = $(filter $(1) $(foreach l,$(1),$(HOST_NEEDS_$l)),$(HOST_LIBS))
host_outside  = $(foreach l,bench drivers firmware fixed,$(if $(filter $l,$(1) $(foreach n,$(call host_needs,$(1)),$(HOST_SEES_$n))),$(LIB_$l)))
host_archives = $(foreach l,$(call host_needs,$(1)),$(O)/host-sim/$l/lib$l.a) $(call host_outside,$(1))
host_packages = $(sort $(foreach l,$(call host_needs,$(1)),$(HOST_PACKAGES_$l)))
host_links    = -Wl,--as-needed $(filter -%,$(call host_packages,$(1))) $(call pkgs,libs,$(filter-out -%,$(call host_packages,$(1))))
host_headers  = $(sort $(foreach l,$(1),$(or $(HOST_HEADERS_$l),-Ihost-sim/$l/include)))
host_cflags   = $(call host_headers,$(1)) $(call pkgs,cflags,$(filter-out -%,$(call host_packages,$(1))))
# All flags of a library or of programs/NAME.
CFLAGS_host_part = $(CSTD) $(WARN) $(OPT) -D_GNU_SOURCE $(call host_cflags,$(filter-out programs/%,$(1)) $(HOST_SEES_$(1)))

define host_library_rules
HOST_SEES_$(1)     := $(2)
HOST_PACKAGES_$(1) := $(3)
HOST_NEEDS_$(1)    := $(call host_needs,$(2))
HOST_LIBS          := $(1) $(HOST_LIBS)
$$(foreach l,$(2),$$(if $$(or $$(HOST_HEADERS_$$l),$$(filter $$l,$(HOST_LIBS))),,$$(error host-sim.mk: $(1) sees $$l, which is no library above it)))
$$(call archive, $(O)/host-sim/$(1)/lib$(1).a, $(wildcard host-sim/$(1)/*.c))
endef
define host_library_flags
$(O)/host-sim/$(1)/%.o: CFLAGS_part := $(call CFLAGS_host_part,$(1))
endef
host_library = $(eval $(call host_library_rules,$(strip $(1)),$(strip $(2)),$(strip $(3))))$(eval $(call host_library_flags,$(strip $(1))))

define host_program_rules
HOST_PROGRAMS += $(1)
HOST_SEES_programs/$(1) := $(2)
$(O)/host-sim/programs/$(1)/%.o: CFLAGS_part := $$(call CFLAGS_host_part,programs/$(1))
$(O)/bin/landmass-$(1): $(call objs,$(wildcard host-sim/programs/$(1)/*.c)) $(call host_archives,$(2))
$(O)/bin/landmass-$(1): LDLIBS = $$(call host_links,$(2))
endef
host_generator = $(eval $(call host_program_rules,$(strip $(1)),$(strip $(2))))
host_program   = $(call host_generator,$(1),$(2))$(eval PROGRAMS += $(O)/bin/landmass-$(strip $(1)))

$(call host_library, lib,          fixed firmware,                                      libpng)
$(call host_library, gis,          lib,                                                 gdal)
$(call host_library, image,        lib fixed firmware)
$(call host_library, classify,     gis lib,                                             openblas)
$(call host_library, resample,     image gis lib fixed firmware)
$(call host_library, terrain,      resample image gis lib fixed firmware)
$(call host_library, reflectivity, lib)
$(call host_library, build,        terrain resample reflectivity image gis lib fixed firmware)
$(call host_library, tracer,       lib fixed firmware,                                  -lembree3 -lpthread)
$(call host_library, realradar,    gis lib fixed firmware,                              fftw3 zlib)
$(call host_library, netem,        tracer gis lib fixed firmware,                       openblas fftw3)
$(call host_library, nav,          lib,                                                 proj expat zlib)
$(call host_library, bus,          lib fixed firmware drivers)
$(call host_library, scene,        lib,                                                 gdal)
$(call host_library, reference,    lib fixed firmware.h)
$(call host_library, sim,          lib fixed firmware,                                  sdl2)
$(call host_library, tables,       lib fixed firmware.h)

$(call host_program, db,        build terrain resample reflectivity classify image gis lib fixed firmware)
$(call host_program, target,    tracer lib fixed firmware)
$(call host_program, netem,     netem tracer realradar gis lib fixed firmware)
$(call host_program, realradar, realradar gis lib fixed firmware)
$(call host_program, nav,       nav lib)
$(call host_program, bus,       bus lib fixed firmware drivers)
$(call host_program, scene,     scene lib)
$(call host_program, reference, reference lib fixed firmware.h)
$(call host_program, sim,       sim lib fixed firmware drivers bench)
$(call host_program, tables,    tables lib)
$(call host_program, figures,   lib fixed firmware)
$(call host_generator, bus_table, bus lib fixed firmware drivers)

# Tests may include the public headers of every library.
INC_host += $(foreach l,$(HOST_LIBS),-Ihost-sim/$l/include)
LIB_hs        := $(O)/host-sim/lib/liblib.a
LIB_reference := $(call host_archives,reference)
LIB_tables    := $(call host_archives,tables)

# Loops over pixels and rays that are worth vectorising.
VECTOR_LOOPS := classify/mlp_apply reflectivity/reflect $(addprefix tracer/,first_bounce projection ray_angles scene trace_tile)
$(VECTOR_LOOPS:%=$(O)/host-sim/%.o): EXTRA_CFLAGS := -O3 -fno-math-errno -fno-trapping-math
