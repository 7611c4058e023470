# The firmware as 32-bit code, on the Cortex-M7 of QEMU's MPS2 board: the golden pictures, and nothing else of a board.
CORTEX_M7 := $(O)/bin/tests/cortex-m7
CORTEX_M7_SRC := $(SRC_core) tests/golden/golden_flight.c $(addprefix tests/support/memory_,board.c flash.c) \
    $(addprefix tests/cortex-m7/,golden.c host.c)
CORTEX_M7_FLAGS := -mcpu=cortex-m7 -mthumb -mfloat-abi=soft -O2 -g -ffreestanding -ffunction-sections -fdata-sections
TESTS += $(CORTEX_M7)/test_golden

CORTEX_M7_INC := $(INC_firmware) $(addprefix -Itests/,golden support zcu102 cortex-m7)
$(O)/cortex-m7/%.o: override CC := arm-none-eabi-gcc
$(call compile, cortex-m7/,, $$(CSTD) $$(WARN) $$(CORTEX_M7_FLAGS) $$(CORTEX_M7_INC), Cortex-M7)
$(CORTEX_M7)/golden.elf: $(CORTEX_M7_SRC:%.c=$(O)/cortex-m7/%.o) linker/mps2-an500.ld
	@mkdir -p $(@D)
	$(call say,LINK,$@)
	$(Q)arm-none-eabi-gcc $(CORTEX_M7_FLAGS) -nostartfiles -Wl,--gc-sections,-T,linker/mps2-an500.ld $(filter %.o,$^) -o $@
$(CORTEX_M7)/test_golden: tests/cortex-m7/test_golden.sh $(O)/bin/tests/zcu102/golden_flash \
    $(if $(shell command -v arm-none-eabi-gcc),$(CORTEX_M7)/golden.elf)
	@mkdir -p $(@D)
	@cp $< $@
	@chmod +x $@
