# Everything that is parsed from wire, file or flash, under the sanitizers: as tests of `make check` (the committed corpus and
# mutations of it), and, built by fuzz.sh with clang and FUZZER=1, as libFuzzer programs.
FUZZ_TARGETS  := image targets chips signature unit bus bus_table can_log script csv gpx igc class_table net label_map mstar chip_csv netem_model hid \
    panel_config obj traced
FUZZ_PARTS    := address,undefined,float-cast-overflow
FUZZ_CORE     := $(SRC_core) $(addprefix tests/support/,memory_flash.c tiny_image.c) tests/fuzz/seal.c
FUZZ_TRACK    := $(wildcard host-sim/nav/*.c) tests/fuzz/track.c
FUZZ_TEXT     := $(addprefix host-sim/lib/,text_file.c atomic_file.c) tests/fuzz/file.c

FUZZ_SRC_image       := $(FUZZ_CORE)
FUZZ_SRC_targets     := $(FUZZ_CORE)
FUZZ_SRC_chips       := $(FUZZ_CORE)
FUZZ_SRC_unit        := $(FUZZ_CORE)
FUZZ_SRC_signature   := $(SRC_core) host-sim/lib/signature_file.c host-sim/lib/atomic_file.c tests/fuzz/file.c
FUZZ_SRC_bus         := $(filter firmware/bus/% firmware/nav/%,$(SRC_firmware)) firmware/base/environment.c firmware/base/geo.c $(SRC_fixed)
FUZZ_SRC_bus_table   := $(FUZZ_SRC_bus) host-sim/bus/table_text.c host-sim/bus/print.c host-sim/bus/print_c.c drivers/can/can_socket.c
FUZZ_SRC_can_log     := drivers/can/can_log.c
FUZZ_SRC_script      := host-sim/sim/script.c $(wildcard firmware/table/*.c) tests/fuzz/file.c
FUZZ_SRC_csv         := $(FUZZ_TRACK)
FUZZ_SRC_gpx         := $(FUZZ_TRACK)
FUZZ_SRC_igc         := $(FUZZ_TRACK)
FUZZ_SRC_class_table := host-sim/lib/class_table.c $(FUZZ_TEXT)
FUZZ_SRC_net         := $(addprefix host-sim/,classify/net_file.c classify/mlp.c classify/samples.c gis/raster.c gis/gdal_start.c) host-sim/lib/progress.c $(FUZZ_TEXT)
FUZZ_SRC_mstar       := host-sim/netem/chip_mstar.c host-sim/netem/picture.c
FUZZ_SRC_chip_csv    := host-sim/netem/chip_csv.c host-sim/netem/picture.c
FUZZ_SRC_netem_model := $(patsubst %,host-sim/netem/%.c,model_file train simulator netem paths network architecture netpix \
                       convolve fft picture loss registration optimizer) host-sim/tracer/records.c $(FUZZ_TEXT)
FUZZ_SRC_obj         := $(addprefix host-sim/tracer/,obj_file.c mesh.c mesh_audit.c) host-sim/lib/atomic_file.c tests/fuzz/file.c
FUZZ_SRC_traced      := $(addprefix host-sim/tracer/,records.c records_file.c) $(SRC_fixed) host-sim/lib/atomic_file.c tests/fuzz/file.c
FUZZ_SRC_label_map   := host-sim/gis/label_map.c host-sim/lib/class_table.c $(FUZZ_TEXT)
FUZZ_SRC_hid         := $(addprefix drivers/usb/,hid.c stick.c)
FUZZ_SRC_panel_config := $(addprefix bsp/panel-linux/,config.c config_table.c)

FUZZ_TESTS    := $(FUZZ_TARGETS:%=$(O)/bin/tests/fuzz/test_fuzz_%)
FUZZ_PROGRAMS := $(FUZZ_TARGETS:%=$(O)/bin/fuzz/%)
TESTS += $(FUZZ_TESTS)
FUZZ_LIBS_csv := $(call pkgs,libs,proj expat zlib)
FUZZ_LIBS_gpx := $(FUZZ_LIBS_csv)
FUZZ_LIBS_igc := $(FUZZ_LIBS_csv)
FUZZ_LIBS_net := $(call pkgs,libs,gdal openblas)
FUZZ_LIBS_netem_model := $(call pkgs,libs,openblas fftw3)

define fuzz_target
FUZZ_OBJS_$(1) := $(patsubst %.c,$(O)/sanitized/%.o,tests/fuzz/fuzz_$(1).c tests/fuzz/quiet_errors.c host-sim/lib/rng.c $(FUZZ_SRC_$(1)))
$(O)/bin/tests/fuzz/test_fuzz_$(1): $(O)/sanitized/tests/fuzz/standalone.o $$(FUZZ_OBJS_$(1)) | $(wildcard tests/fuzz/corpus/$(1)/*)
$(O)/bin/fuzz/$(1): $$(FUZZ_OBJS_$(1))
$(O)/bin/tests/fuzz/test_fuzz_$(1) $(O)/bin/fuzz/$(1): LDLIBS := -fsanitize=$(FUZZ_PARTS)$(if $(FUZZER),$(comma)fuzzer) $(FUZZ_LIBS_$(1))
endef
comma := ,
$(foreach target,$(FUZZ_TARGETS),$(eval $(call fuzz_target,$(target))))

.PHONY: fuzz-programs
fuzz-programs: $(FUZZ_PROGRAMS)

# -O1 behind OPT: findings name the lines as they are written.
$(O)/sanitized/%.o: EXTRA_CFLAGS := -Ibsp/panel-linux -Itests/support $(call pkgs,cflags,gdal openblas fftw3)
FUZZ_CFLAGS := -O1 -fsanitize=$(FUZZ_PARTS)$(if $(FUZZER),$(comma)fuzzer-no-link) -fno-sanitize-recover=all \
    -fno-omit-frame-pointer
$(call compile, sanitized/,, $$(CFLAGS_host) $$(FUZZ_CFLAGS) $$(EXTRA_CFLAGS), sanitizers)
