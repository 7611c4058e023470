# Golden pictures: one program, built four ways, that must give the same checksums: as the product is built, by clang, without
# optimisation under the sanitizers, and with clang at its highest level.
GOLDEN_SRC := $(addprefix tests/golden/,golden.c golden_flight.c golden_scene.c golden_signature.c) \
    $(addprefix tests/support/,tiny_image.c memory_flash.c) host-sim/lib/png.c host-sim/lib/error.c \
    host-sim/lib/atomic_file.c $(SRC_core)
GOLDEN := $(O)/bin/tests/golden
TESTS += $(GOLDEN)/test_golden

$(GOLDEN)/golden: $(call objs,$(GOLDEN_SRC))
$(GOLDEN)/twins: $(call objs,tests/golden/twins.c host-sim/lib/rng.c) $(LIB_firmware) $(LIB_fixed)
$(GOLDEN)/golden-clang: $(GOLDEN_SRC:%.c=$(O)/golden-clang/%.o)
$(GOLDEN)/golden-sanitized: $(GOLDEN_SRC:%.c=$(O)/golden-sanitized/%.o)
$(GOLDEN)/golden-clang: CC := clang
$(GOLDEN)/golden-clang: OPT := -O3 -g
$(GOLDEN)/golden-sanitized: OPT := -O0 -g -fsanitize=address,undefined -fno-sanitize-recover=all
$(GOLDEN)/golden $(GOLDEN)/golden-clang $(GOLDEN)/golden-sanitized: LDLIBS := $(call pkgs,libs,libpng)
$(GOLDEN)/test_golden: tests/golden/test_golden.sh tests/golden/pictures.golden $(addprefix $(GOLDEN)/,golden golden-clang golden-sanitized)
	@cp $< $@
	@chmod +x $@

$(call compile, golden-clang/,,     $$(CFLAGS_host) -Itests/support, clang)
$(call compile, golden-sanitized/,, $$(CFLAGS_host) -Itests/support, sanitizers)

# The same once more for the panel's processor, by its own compiler where that is installed.
ifeq ($(BOARD),bench-linux)
ARM64 := build/panel-linux-arm64
TESTS += $(GOLDEN)/test_golden_arm64
$(GOLDEN)/test_golden_arm64: tests/golden/test_golden_arm64.sh $(GOLDEN)/twins golden-arm64
	@mkdir -p $(@D)
	@cp $< $@
	@chmod +x $@

.PHONY: golden-arm64
golden-arm64:
	@! command -v aarch64-linux-gnu-gcc >/dev/null || $(MAKE) --no-print-directory BOARD=panel-linux ARCH=arm64 \
	    CC=aarch64-linux-gnu-gcc O=$(ARM64) $(addprefix $(ARM64)/bin/tests/golden/,golden twins)
endif

.PHONY: golden-update
golden-update: $(GOLDEN)/golden ## Take the pictures of this build as the golden ones; look at them first
	@$(GOLDEN)/golden >$(O)/pictures.golden && mv $(O)/pictures.golden tests/golden/pictures.golden
	@echo 'tests/golden/pictures.golden is that of this build; git diff shows what changed'
