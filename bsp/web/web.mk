# Modules of WebAssembly: no main, no C library; what JavaScript calls is marked in the sources.
MODULE   := $(O)/landmass.wasm
PROGRAMS += $(MODULE)
$(MODULE): $(call objs,bsp/web/board.c bsp/web/replay_board.c drivers/can/can_line.c \
    $(addprefix bsp/record/,build_identity.c control_bytes.c head.c replay.c rows_crc.c))

$(O)/%.wasm: $(O)/bsp/web/memory.o $(LIB_firmware) $(LIB_fixed)
	@mkdir -p $(@D)
	$(call say,LINK,$@)
	$(Q)$(LD_wasm) --no-entry --gc-sections $(STRIP_wasm) -z stack-size=65536 --stack-first $(LDFLAGS) \
	    $(filter %.o,$^) --whole-archive $(LIB_firmware) $(LIB_fixed) -o $@
