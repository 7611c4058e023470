# Golden pictures: one program, built three ways, that must give the same checksums: as the product is built, and in the
# variants of make/variants.mk, by clang at its highest level and under the sanitizers.
GOLDEN := $(O)/bin/tests/golden
# A build by clang anyhow (make check-clang) or for coverage draws them once.
GOLDEN_VARIANTS := $(if $(findstring clang,$(CC))$(findstring coverage,$(O)),,golden-clang golden-sanitized)
TESTS += $(GOLDEN)/test_golden
GOLDEN_PARTS := $(patsubst %,$(O)/tests/golden/%.o,golden golden_flight golden_scene golden_signature) \
    $(LIB_support) $(LIB_hs) $(LIB_firmware) $(LIB_fixed)
$(GOLDEN)/golden: $(GOLDEN_PARTS)
$(GOLDEN)/golden-clang: $(GOLDEN_PARTS:$(O)/%=$(O)/clang/%)
$(GOLDEN)/golden-sanitized: $(call sanitized,$(GOLDEN_PARTS))
$(GOLDEN)/golden $(GOLDEN)/golden-clang: LDLIBS = $(call pkgs,libs,libpng)
$(GOLDEN)/golden-sanitized: LDLIBS = $(LINK_sanitized) $(call pkgs,libs,libpng)
$(GOLDEN)/test_golden: tests/golden/test_golden.sh tests/golden/pictures.golden $(addprefix $(GOLDEN)/,golden $(GOLDEN_VARIANTS))
	@cp $< $@
	@chmod +x $@

# The same once more for the panel's processor, by its own compiler where that is installed.
ifeq ($(BOARD),bench-linux)
ARM64 := build/panel-linux-arm64
TESTS += $(GOLDEN)/test_golden_arm64
$(GOLDEN)/test_golden_arm64: tests/golden/test_golden_arm64.sh golden-arm64
	@mkdir -p $(@D)
	@cp $< $@
	@chmod +x $@

.PHONY: golden-arm64
golden-arm64:
	@! command -v aarch64-linux-gnu-gcc >/dev/null || $(call make_board,panel-linux) ARCH=arm64 \
	    O=$(ARM64) $(ARM64)/bin/tests/golden/golden
endif

.PHONY: golden-update
golden-update: $(GOLDEN)/golden ## Take the pictures of this build as the golden ones; look at them first
	@$(GOLDEN)/golden >$(O)/pictures.golden && mv $(O)/pictures.golden tests/golden/pictures.golden
	@echo 'tests/golden/pictures.golden is that of this build; git diff shows what changed'
