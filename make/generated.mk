# Sources that are made and not written: the constant tables, by their formulas, and the bus table of the board.
# They are named as if they stood in the tree, and lie in $(GEN) under the same path, where vpath finds them.
# HOSTCC builds the programs that make them for the machine that builds, with libc and libm alone.
HOSTCC    ?= gcc
HOSTAR    ?= ar
GEN       := $(O)/gen
BUS_TABLE ?= host-sim/bus/arinc825.bus
vpath %.c $(GEN)

SRC_fixed    := $(sort $(wildcard fixed/src/*.c) fixed/src/tables.c)
SRC_firmware := $(sort $(wildcard firmware/*/*.c) $(SRC_kernels) \
    $(addprefix firmware/,bus/bus_generic.c clutter/grain_table.c clutter/noise_table.c clutter/response_table.c map/grown_table.c))
SRC_core     := $(SRC_firmware) $(SRC_fixed)

GEN_INC := $(INC_firmware) $(foreach l,lib tables bus,-Ihost-sim/$l/include)
$(GEN)/host/%.o: override CC := $(HOSTCC)
$(call compile, gen/host/,, $$(CSTD) -O1 -D_GNU_SOURCE $$(GEN_INC), build machine)
$(GEN)/bin/%:
	@mkdir -p $(@D)
	$(call say,LINK,$@)
	$(Q)$(HOSTCC) $^ -lm -o $@

gen_objs = $(patsubst %.c,$(GEN)/host/%.o,$(1))
GEN_base := $(call gen_objs,$(addprefix host-sim/lib/,atomic_file.c error.c input_file.c json.c number.c report.c))
GEN_options := $(call gen_objs,$(addprefix host-sim/lib/,menu.c options.c options_help.c manual.c output_path.c))

$(GEN)/bin/tables: $(call gen_objs,$(wildcard host-sim/tables/*.c host-sim/programs/tables/*.c)) $(GEN_options) $(GEN_base)
$(GEN)/fixed/src/tables.c: SET := fixed
$(GEN)/firmware/clutter/grain_table.c: SET := grain
$(GEN)/firmware/clutter/noise_table.c: SET := noise
$(GEN)/firmware/clutter/response_table.c: SET := response
$(GEN)/firmware/map/grown_table.c: SET := grown
$(GEN)/fixed/src/tables.c $(addprefix $(GEN)/firmware/,clutter/grain_table.c clutter/noise_table.c clutter/response_table.c map/grown_table.c): $(GEN)/bin/tables
	@mkdir -p $(@D)
	$(Q)$< $(SET) $@

# Of the firmware, bus_table takes what knows the fields of the bus. Another BUS_TABLE than the last time makes the
# source anew.
GEN_bus := $(call gen_objs,$(wildcard firmware/bus/*.c) $(SRC_fixed))
$(GEN)/host/libbus.a: $(GEN_bus)
	@rm -f $@
	$(Q)$(HOSTAR) rcs $@ $^
$(GEN)/bin/bus_table: $(call gen_objs,$(addprefix host-sim/,programs/bus_table/main.c bus/print_c.c bus/table_text.c)) \
    $(GEN_base) $(GEN)/host/libbus.a
$(GEN)/firmware/bus/bus_generic.c: $(GEN)/bin/bus_table $(BUS_TABLE) $(GEN)/bus_table.name
	@mkdir -p $(@D)
	$(Q)$< $(BUS_TABLE) $@
$(GEN)/bus_table.name: always
	@mkdir -p $(@D)
	@echo '$(BUS_TABLE)' | cmp -s - $@ || echo '$(BUS_TABLE)' >$@

# The identity of the build, which recordings carry: a hash of the sources that decide the pictures, in the order of their
# names. It is the same for every board and compiler, with git or without.
RECORD_SOURCES := $(sort $(wildcard bsp/record/*.c) bsp/record/build_identity.c)
$(GEN)/bsp/record/build_identity.c: always
	@mkdir -p $(@D)
	@hash=$$(find firmware fixed host-sim/tables -name '*.[ch]' | LC_ALL=C sort | xargs sha256sum | sha256sum | cut -c1-12); \
	    { echo '#include "record.h"'; echo; echo "const char record_build[] = \"$$hash\";"; } >$@.new; \
	    cmp -s $@.new $@ && rm $@.new || mv $@.new $@
.PHONY: always
