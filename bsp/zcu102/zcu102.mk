# Images of the board ZCU102: each is a main function and the board itself. The product is one; tests have more
# (tests/zcu102/images/images.mk).
CFLAGS_drivers += $(OPT_board)
CFLAGS_bsp     += $(OPT_board)
# Nothing of the display's runs in interrupts, and a picture has many pixels.
$(O)/drivers/display/display_dp.o: OPT_board := -O3
# A row of each picture goes through it.
$(O)/bsp/record/rows_crc.o: OPT_board += -O2
# At -O3 these grow by copies of loops that save no instruction.
$(addprefix $(O)/firmware/,radar/weather.o clutter/class_gain.o clutter/crests.o clutter/layover.o): OPT_core := -O2
# Nor do these of its loops.
$(O)/firmware/display/scan_conv.o: OPT_core += -fno-unswitch-loops -fno-peel-loops -fno-ipa-cp-clone -fno-split-paths
# Every tile goes through it.
$(O)/bsp/zcu102/crc32c.o: OPT_board += -O2
LDSCRIPT       := linker/zcu102.ld
BOARD_OBJS     := $(call objs,$(filter-out %/main.c,$(wildcard bsp/zcu102/*.c)) \
    $(addprefix bsp/record/,build_identity.c control_bytes.c head.c record.c rows_crc.c)) \
    $(patsubst %.S,$(O)/%.o,$(wildcard bsp/zcu102/*.S))
LIB_board      := $(O)/libboard.a
IMAGE          := $(O)/landmass.elf
PROGRAMS       += $(IMAGE)

$(LIB_board): $(BOARD_OBJS)
$(IMAGE): $(O)/bsp/zcu102/main.o

$(O)/%.o: %.S
	@mkdir -p $(@D)
	$(call say,AS,$<)
	$(Q)$(CC) $(OPT) -c $< -o $@

$(O)/%.elf: $(LIB_board) $(LIB_drivers) $(LIB_firmware) $(LIB_fixed) $(LDSCRIPT)
	@mkdir -p $(@D)
	$(call say,LINK,$@)
	$(Q)$(CC) $(OPT) -nostdlib -static -Wl,--gc-sections,--build-id=none,-T,$(LDSCRIPT),-u,_start,-u,fx_crc32c \
	    -Wl,-Map,$@.map $(LDFLAGS) $(filter %.o,$^) $(LIB_board) $(LIB_drivers) $(LIB_firmware) $(LIB_fixed) -lgcc -o $@
