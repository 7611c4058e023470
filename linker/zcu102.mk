# Images of the board ZCU102: each is a main function and the board itself. Beside the product, those that tests run.
CFLAGS_drivers += $(OPT_board)
CFLAGS_bsp     += $(OPT_board)
LDSCRIPT       := linker/zcu102.ld
BOARD_OBJS     := $(call objs,$(filter-out %/main.c,$(wildcard bsp/zcu102/*.c))) \
    $(patsubst %.S,$(O)/%.o,$(wildcard bsp/zcu102/*.S))
LIB_board      := $(O)/libboard.a
IMAGE          := $(O)/landmass.elf
PROGRAMS       += $(IMAGE)

$(LIB_board): $(BOARD_OBJS)
$(IMAGE): $(O)/bsp/zcu102/main.o

$(O)/bsp/%.o: bsp/%.S
	@mkdir -p $(@D)
	$(if $(V),,@echo '  AS   $<')
	$(Q)$(CC) $(OPT) -c $< -o $@

$(O)/%.elf: $(LIB_board) $(LIB_drivers) $(LIB_firmware) $(LIB_fixed) $(LDSCRIPT)
	@mkdir -p $(@D)
	$(if $(V),,@echo '  LINK $@')
	$(Q)$(CC) $(OPT) -nostdlib -static -Wl,--gc-sections,--build-id=none,-T,$(LDSCRIPT),-u,_start,-Map,$@.map $(LDFLAGS) \
	    $(filter %.o,$^) $(LIB_board) $(LIB_drivers) $(LIB_firmware) $(LIB_fixed) -lgcc -o $@

CFLAGS_host += -Itests/golden -Itests/zcu102 -Itests/zcu102/images
TEST_IMAGES := $(addprefix $(O)/,golden.elf flight.elf)
PROGRAMS    += $(TEST_IMAGES)
image_objs   = $(addprefix $(O)/tests/zcu102/images/,$(addsuffix .o,$(1)))
$(TEST_IMAGES): $(call image_objs,look)
$(O)/golden.elf: $(call image_objs,golden) $(call objs,tests/golden/golden_flight.c tests/support/memory_flash.c)
$(O)/flight.elf: $(call image_objs,flight peer core1)

$(O)/tests/%.o: tests/%.S
	@mkdir -p $(@D)
	$(if $(V),,@echo '  AS   $<')
	$(Q)$(CC) $(OPT) -c $< -o $@
