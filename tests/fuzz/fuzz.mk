# Everything that is parsed from wire, file or flash, under the sanitizers: as tests of `make check` (the committed corpus and
# mutations of it), and, built by fuzz.sh with clang and FUZZER=1, as libFuzzer programs. One line each:
#
#   fuzz_target NAME,SEES      tests/fuzz/fuzz_NAME.c and the sanitized libraries, named as in host-sim/host-sim.mk
LIB_fuzz := $(O)/tests/fuzz/libfuzz.a
$(call archive, $(LIB_fuzz), $(addprefix tests/fuzz/,seal.c file.c track.c osm.c))
# In place of what takes long and is not under test: of blocks in all programs, of sums in those of libFuzzer.
FUZZ_LARGE := $(O)/sanitized/tests/fuzz/large.o
FUZZ_SUM   := $(O)/sanitized/tests/fuzz/sum.o
LINK_large := $(addprefix -Wl$(comma)--wrap=,malloc calloc realloc free)
LINK_sum   := -Wl,--wrap=fx_crc32c

define fuzz_rules
FUZZ_NAMES += $(1)
FUZZ_OBJS_$(1) := $(call sanitized,$(addprefix $(O)/tests/fuzz/,fuzz_$(1).o quiet_errors.o) \
    $(LIB_fuzz) $(LIB_support) $(call host_archives,$(2)))
$(O)/bin/tests/fuzz/test_fuzz_$(1): $(O)/sanitized/tests/fuzz/standalone.o $$(FUZZ_OBJS_$(1)) $(FUZZ_LARGE) \
    | $(wildcard tests/fuzz/corpus/$(1)/*)
$(O)/bin/fuzz/$(1): $$(FUZZ_OBJS_$(1)) $(FUZZ_LARGE) $(FUZZ_SUM)
$(O)/bin/tests/fuzz/test_fuzz_$(1): LDLIBS = $$(LINK_sanitized) $$(LINK_large) $$(call host_links,$(2))
$(O)/bin/fuzz/$(1): LDLIBS = $$(LINK_sanitized) $$(LINK_large) $$(LINK_sum) $$(call host_links,$(2))
endef
fuzz_target = $(eval $(call fuzz_rules,$(strip $(1)),$(strip $(2))))

$(call fuzz_target, lz4,          lib firmware fixed)
$(call fuzz_target, image,        lib firmware fixed)
$(call fuzz_target, seal,         trust lib firmware fixed)
$(call fuzz_target, key_file,     trust lib firmware fixed)
$(O)/sanitized/tests/fuzz/fuzz_seal.o $(O)/sanitized/tests/fuzz/fuzz_key_file.o: EXTRA_CFLAGS := -Ihost-sim/trust
$(call fuzz_target, targets,      lib firmware fixed)
$(call fuzz_target, chips,        lib firmware fixed)
$(call fuzz_target, radar_text,   radar lib firmware fixed)
$(call fuzz_target, radar_record, lib firmware fixed)
$(call fuzz_target, signature,    lib firmware fixed)
$(call fuzz_target, unit,         lib firmware fixed)
$(call fuzz_target, bus,          lib firmware fixed)
$(call fuzz_target, bus_record,   lib firmware fixed)
$(call fuzz_target, bus_table,    bus lib firmware fixed drivers)
$(call fuzz_target, fast_packet,  lib firmware fixed)
$(call fuzz_target, can_log,      lib firmware fixed drivers)
$(call fuzz_target, dis,          dis lib firmware fixed drivers)
$(call fuzz_target, cigi,         dis lib firmware fixed drivers)
$(call fuzz_target, dis_kinds,    dis lib firmware fixed drivers)
$(call fuzz_target, script,       sim nav lib firmware fixed)
$(call fuzz_target, ios,          ios image lib firmware fixed drivers)
$(call fuzz_target, live_routes,  nav lib)
$(call fuzz_target, csv,          nav lib)
$(call fuzz_target, gpx,          nav lib)
$(call fuzz_target, igc,          nav lib)
$(call fuzz_target, kml,          nav lib)
$(call fuzz_target, simulator,    nav lib)
$(call fuzz_target, class_table,  lib firmware fixed)
$(call fuzz_target, net,          classify gis lib)
$(call fuzz_target, label_map,    gis lib firmware fixed)
$(call fuzz_target, code_map,     gis lib firmware fixed)
$(call fuzz_target, detail,       build terrain resample reflectivity image gis lib fixed firmware)
$(call fuzz_target, work_plan,    build terrain resample reflectivity image gis lib fixed firmware)
$(call fuzz_target, part,         build terrain resample reflectivity image gis lib fixed firmware)
$(call fuzz_target, rules,        vectors gis lib firmware fixed)
$(call fuzz_target, osm_pbf,      vectors gis lib firmware fixed)
$(call fuzz_target, cdb_name,     visual gis lib)
$(call fuzz_target, obj,          visual gis lib)
$(O)/sanitized/tests/fuzz/fuzz_obj.o: EXTRA_CFLAGS := -Ihost-sim/visual
$(call fuzz_target, osm_xml,      vectors gis lib firmware fixed)
$(call fuzz_target, mstar,        netem lib)
$(call fuzz_target, mat,          realradar gis lib firmware fixed)
$(call fuzz_target, chip_csv,     netem lib)
$(call fuzz_target, netem_model,  netem tracer lib firmware fixed)
$(call fuzz_target, hid,          lib drivers)
$(call fuzz_target, slot,         slots lib fixed firmware drivers)
$(call fuzz_target, wire,         wire lib fixed firmware)
$(call fuzz_target, panel_config, lib)
$(call fuzz_target, traced,       tracer lib firmware fixed)
$(call fuzz_target, replay,       lib firmware fixed)
$(O)/bin/tests/fuzz/test_fuzz_replay $(O)/bin/fuzz/replay: $(call sanitized,$(LIB_record))
$(O)/bin/tests/fuzz/test_fuzz_panel_config $(O)/bin/fuzz/panel_config: $(call sanitized,$(LIB_panel))

# Left out of what the fuzzer is told of: uncovered.txt says why.
ifdef FUZZER
$(addprefix $(O)/sanitized/,host-sim/image/sha256.o $(addprefix tests/fuzz/,large.o sum.o file.o quiet_errors.o)): \
    EXTRA_CFLAGS := -fsanitize-coverage-ignorelist=tests/fuzz/uncovered.txt
endif

TESTS += $(FUZZ_NAMES:%=$(O)/bin/tests/fuzz/test_fuzz_%)

.PHONY: fuzz-programs
fuzz-programs: $(FUZZ_NAMES:%=$(O)/bin/fuzz/%)

.PHONY: fuzz-count fuzz-keep
fuzz-count: ## Print how many inputs the fuzz targets have tried: in each `make check`, and in all campaigns of `make fuzz`
	@grep -ho 'fuzz_mutations = [0-9]*' tests/fuzz/fuzz_*.c | awk -v seeds=$$(find tests/fuzz/corpus -type f | wc -l) \
	    '{ n += $$3 } END { print NR " targets: " seeds " inputs of their corpora, " n " mutations of them in each make check" }'
	@sh tests/fuzz/count.sh $(FUZZ_NAMES)

fuzz-keep: ## Add what `make fuzz` has tried here to tests/fuzz/counted.txt
	@sh tests/fuzz/count.sh --keep $(FUZZ_NAMES)
