# The same sources compiled otherwise, in a folder of their own beside the plain objects and with the same archives
# ($(O)/sanitized/libfirmware.a, ...), which every program of a variant shares:
#
#   sanitized   under the address and undefined-behaviour sanitizers, which stop at the first finding; FUZZER=1 adds libFuzzer
#   clang       by clang at its highest level
#
# They are compiled with the headers that tests see, for whether a layer keeps to its own is seen by the plain build.
comma := ,
SANITIZERS     := address,undefined,float-cast-overflow
LINK_sanitized := -fsanitize=$(SANITIZERS)$(if $(FUZZER),$(comma)fuzzer)
VARIANT_CFLAGS  = $(CFLAGS_host) -Itests/support -Itests/golden -Ibsp/panel-linux $(VARIANT_PKGS) $(EXTRA_CFLAGS)
VARIANT_PKGS    = $(eval VARIANT_PKGS := $(call pkgs,cflags,gdal openblas fftw3 sdl2 libdrm libusb-1.0 libcrypto))$(VARIANT_PKGS)

# archive ARCHIVE,SOURCES: an archive, and that of each variant.
define archive_rules
$(1): $(call objs,$(2))
$(patsubst $(O)/%,$(O)/sanitized/%,$(1)): $(patsubst %.c,$(O)/sanitized/%.o,$(2))
$(patsubst $(O)/%,$(O)/clang/%,$(1)): $(patsubst %.c,$(O)/clang/%.o,$(2))
endef
archive = $(eval $(call archive_rules,$(strip $(1)),$(strip $(2))))

# Objects and archives $(1) of the plain build, sanitized.
sanitized = $(patsubst $(O)/%,$(O)/sanitized/%,$(1))

# -O1 behind OPT: findings name the lines as they are written. The sanitizers' own code hides from gcc which range a
# number has, so that it would warn of conversions that the plain build shows to be fine.
#
# FUZZER=1 tells libFuzzer of branches alone; FUZZER=compare of each comparison too, which finds more in each input and costs
# most of its time.
FUZZED_1       := -O2 -fsanitize=fuzzer-no-link -fno-sanitize-coverage=trace-cmp,indirect-calls
FUZZED_compare := -O2 -fsanitize=fuzzer-no-link
SANITIZED_CFLAGS := -O1 -fsanitize=$(SANITIZERS) -fno-sanitize-recover=all -fno-omit-frame-pointer -Wno-conversion \
    $(FUZZED_$(FUZZER))
$(O)/clang/%.o: override CC := clang
$(call compile, sanitized/,, $$(VARIANT_CFLAGS) $$(SANITIZED_CFLAGS), sanitizers)
$(call compile, clang/,,     $$(VARIANT_CFLAGS) -O3, clang)
