# Host libraries and programs, the lowest library first: name, what it may include, packages (make/host.mk).
# A library sees earlier lines only, so that the arrows cannot run in a circle.
$(call host_library, lib,          fixed firmware,                                      libpng)
$(call host_library, gis,          lib,                                                 gdal proj)
$(call host_library, image,        lib fixed firmware,                                  liblz4 libcrypto)
$(call host_library, radar,        lib fixed firmware)
$(call host_library, trust,        lib fixed firmware,                                  libcrypto)
$(call host_library, classify,     gis lib,                                             openblas -lpthread)
$(call host_library, resample,     image gis lib fixed firmware)
$(call host_library, terrain,      resample image gis lib fixed firmware)
$(call host_library, reflectivity, lib)
$(call host_library, infrared,     lib)
$(call host_library, build,        terrain resample reflectivity image gis lib fixed firmware)
$(call host_library, vectors,      gis lib,                                             expat zlib gdal)
$(call host_library, visual,       gis lib,                                             assimp -lembree3)
$(call host_library, tracer,       visual lib fixed firmware,                           -lembree3 -lpthread fftw3)
$(call host_library, realradar,    gis lib fixed firmware,                              fftw3 zlib)
$(call host_library, netem,        tracer gis lib fixed firmware,                       openblas fftw3)
$(call host_library, nav,          lib,                                                 proj expat zlib libzip)
$(call host_library, slots,        lib fixed firmware drivers)
$(call host_library, wire,         lib fixed firmware,                                  libcrypto libusb-1.0 -lpthread)
$(call host_library, bus,          lib fixed firmware drivers)
$(call host_library, dis,          lib fixed firmware drivers,                          libpcap)
$(call host_library, ios,          image lib fixed firmware drivers)
$(call host_library, scene,        lib,                                                 gdal)
$(call host_library, reference,    lib fixed firmware.h,                                liblz4)
$(call host_library, sim,          nav lib fixed firmware,                              sdl2)
$(call host_library, tables,       lib fixed firmware.h)

$(call host_program, db,        vectors visual build infrared terrain resample reflectivity classify radar trust bus image gis lib fixed firmware)
$(call host_program, load,      wire slots trust lib fixed firmware drivers)
$(call host_program, radar,     radar image lib fixed firmware)
$(call host_program, target,    tracer visual gis lib fixed firmware)
$(call host_program, netem,     netem tracer realradar gis lib fixed firmware)
$(call host_program, realradar, realradar gis lib fixed firmware)
$(call host_program, nav,       nav lib fixed firmware drivers)
$(call host_program, bus,       bus lib fixed firmware drivers)
$(call host_program, dis,       dis image lib fixed firmware drivers)
$(call host_program, ios,       ios image lib fixed firmware drivers,      libwebsockets)
$(call host_program, scene,     scene lib)
$(call host_program, reference, reference lib fixed firmware.h)
$(call host_program, sim,       sim nav radar bus lib fixed firmware drivers bench)
$(call host_program, tables,    tables lib)
$(call host_program, figures,   lib fixed firmware)
$(call host_generator, bus_table, bus lib fixed firmware drivers)
HOST_TOOLS := $(patsubst %,$(O)/bin/landmass-%,$(filter-out bus_table,$(HOST_PROGRAMS)))

# Tests may include the public headers of every library.
INC_host += $(foreach l,$(HOST_LIBS),-Ihost-sim/$l/include)
LIB_hs        := $(O)/host-sim/lib/liblib.a
LIB_reference := $(call host_archives,reference)
LIB_tables    := $(call host_archives,tables)

# Loops over pixels and rays that are worth vectorising, for the processor that builds as OPT_core has it. No product is
# added to a sum without being rounded, so that what they make is the same on all.
VECTORS_host := $(if $(filter yes,$(HAS_AVX2)),-march=x86-64-v3 -ffp-contract=off)
VECTOR_LOOPS := classify/mlp_apply classify/units reflectivity/reflect reflectivity/place image/codes image/ground image/verify_tile \
    $(addprefix scene/,erosion land noise) $(addprefix tracer/,first_bounce projection ray_angles scene trace_tile)
$(VECTOR_LOOPS:%=$(O)/host-sim/%.o): EXTRA_CFLAGS := -O3 -fno-math-errno -fno-trapping-math $(VECTORS_host)

# The Debian package of the tools. HAS_AVX2= on the command line makes programs for any processor of this kind.
.PHONY: tools-package
tools-package: $(HOST_TOOLS) $(O)/ios/.made
	@sh host-sim/package/build.sh $(O)/bin build/packages
