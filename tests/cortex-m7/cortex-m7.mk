# The firmware as 32-bit code, on the Cortex-M7 of QEMU's MPS2 board: the golden pictures, what a patch costs, and nothing else
# of a board.
CORTEX_M7 := $(O)/bin/tests/cortex-m7
CORTEX_M7_SRC := $(SRC_core) $(addprefix tests/cortex-m7/,host.c start.c) tests/support/memory_flash.c
CORTEX_M7_GOLDEN := tests/cortex-m7/golden.c tests/golden/golden_flight.c tests/support/memory_board.c
CORTEX_M7_BENCH := tests/cortex-m7/bench.c tests/bench/patch_rig.c
CORTEX_M7_FLAGS := -mcpu=cortex-m7 -mthumb -mfloat-abi=soft -O3 -fno-tree-vectorize -g -ffreestanding -ffunction-sections -fdata-sections
TESTS += $(CORTEX_M7)/test_golden

CORTEX_M7_INC := $(INC_firmware) $(addprefix -Itests/,golden support zcu102 bench cortex-m7)
$(O)/cortex-m7/%.o: override CC := arm-none-eabi-gcc
$(call compile, cortex-m7/,, $$(CSTD) $$(WARN) $$(CORTEX_M7_FLAGS) $$(CORTEX_M7_INC), Cortex-M7)
$(CORTEX_M7)/golden.elf: $(CORTEX_M7_GOLDEN:%.c=$(O)/cortex-m7/%.o)
$(CORTEX_M7)/bench.elf: $(CORTEX_M7_BENCH:%.c=$(O)/cortex-m7/%.o)
$(CORTEX_M7)/golden.elf $(CORTEX_M7)/bench.elf: $(CORTEX_M7_SRC:%.c=$(O)/cortex-m7/%.o) linker/mps2-an500.ld
	@mkdir -p $(@D)
	$(call say,LINK,$@)
	$(Q)arm-none-eabi-gcc $(CORTEX_M7_FLAGS) -nostartfiles -Wl,--gc-sections,-T,linker/mps2-an500.ld $(filter %.o,$^) -o $@
$(CORTEX_M7)/test_golden: tests/cortex-m7/test_golden.sh $(O)/bin/tests/zcu102/golden_flash \
    $(if $(shell command -v arm-none-eabi-gcc),$(CORTEX_M7)/golden.elf)
	@mkdir -p $(@D)
	@cp $< $@
	@chmod +x $@
