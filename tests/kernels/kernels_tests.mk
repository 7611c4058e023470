# The kernels of arm64 beside those in plain C, in one process: built for the panel's ARM64, run in qemu-user.
TWINS := $(O)/bin/tests/kernels/twins
$(O)/tests/kernels/twins.o: EXTRA_CFLAGS := -Ifirmware/kernels
$(TWINS): $(O)/tests/kernels/twins.o $(LIB_hs) $(LIB_firmware) $(LIB_fixed)

ifeq ($(BOARD),bench-linux)
TESTS += $(O)/bin/tests/kernels/test_twins
$(O)/bin/tests/kernels/test_twins: tests/kernels/test_twins.sh twins-arm64
	@mkdir -p $(@D)
	@cp $< $@
	@chmod +x $@

.PHONY: twins-arm64
twins-arm64: golden-arm64
	@! command -v aarch64-linux-gnu-gcc >/dev/null || $(call make_board,panel-linux) ARCH=arm64 \
	    O=$(ARM64) $(ARM64)/bin/tests/kernels/twins
endif
