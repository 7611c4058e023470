# landmass: the menu. `make` alone prints it. Each part adds its own programs and tests in a *.mk beside its sources.
.DEFAULT_GOAL := help
BOARD ?= bench-linux
O     := build/$(BOARD)
include bsp/$(BOARD)/board.mk

OPT    ?= -O2 -g
Q      := $(if $(V),,@)
WARN   := -Wall -Wextra -Wconversion -Wshadow -Wstrict-prototypes -Wmissing-prototypes -Wvla -Werror
WARN   += -Wno-enum-float-conversion # an enumerator is how C11 names a whole number
CSTD   := -std=c11
DEPGEN  = -MMD -MP
PKG_CONFIG ?= pkg-config
pkgs    = $(shell $(PKG_CONFIG) --$(1) $(2) 2>/dev/null)

# Each layer sees its own headers and those below it, and no more (docs/DESIGN.md, "Who may include whom").
# The two lowest layers do not even see the C library: -nostdinc leaves the compiler's own headers only.
FREESTANDING := -ffreestanding -nostdinc -isystem $(shell $(CC) -print-file-name=include)
INC_fixed    := -Ifixed/include
include firmware/rooms.mk
INC_room      = $(INC_fixed) $(call ROOM_HEADERS,$(1) $(SEES_$(1)))
INC_firmware := $(INC_fixed) $(call ROOM_HEADERS,$(ROOMS))
INC_drivers  := $(INC_fixed) $(call ROOM_HEADERS,$(SEES_drivers)) -Idrivers/include
INC_bsp      := $(INC_firmware) -Idrivers/include -Ibsp/$(BOARD)
INC_host      = $(INC_bsp)

CFLAGS_fixed    = $(CSTD) $(WARN) $(OPT) $(FREESTANDING) $(INC_fixed)
CFLAGS_room     = $(CSTD) $(WARN) $(OPT) $(FREESTANDING) $(call INC_room,$(1))
CFLAGS_drivers  = $(CSTD) $(WARN) $(OPT) -D_GNU_SOURCE $(INC_drivers)
CFLAGS_bsp      = $(CSTD) $(WARN) $(OPT) -D_GNU_SOURCE $(INC_bsp)
CFLAGS_host     = $(CSTD) $(WARN) $(OPT) -D_GNU_SOURCE $(INC_host)

include make/generated.mk

objs = $(patsubst %.c,$(O)/%.o,$(1))
LIB_fixed    := $(O)/libfixed.a
LIB_firmware := $(O)/libfirmware.a
LIB_drivers  := $(O)/libdrivers.a
TEST_SUPPORT := $(O)/tests/support/support.o

PROGRAMS :=
TESTS    :=
# What is built beside the firmware: a PC's programs and tests, unless the board says otherwise.
PARTS ?= drivers/*.mk bsp/panel-linux/panel.mk host-sim/host-sim.mk tests/*.mk tests/*/*.mk tests/*/*/*.mk
include $(sort $(wildcard $(PARTS)))

.PHONY: help deps all run check check-panel panel package bench gallery fuzz rooms lint format clean zcu102 run-zcu102 size bench-zcu102

help: ## Print this menu
	@echo 'landmass: make TARGET'
	@sed -n 's/^\([a-z0-9-]*\):.*## /  \1\t/p' $(MAKEFILE_LIST) | expand -t 14

deps: ## Install the Debian packages of bsp/bench-linux/packages.txt (as root or through sudo)
	@sh bsp/bench-linux/deps.sh

all: $(PROGRAMS) ## Build every program, without running anything

run: deps ## Build, make the database of the built-in scene, fly over it, leave pictures
	@$(MAKE) --no-print-directory all
	@sh host-sim/run/run.sh $(O)

check: deps ## Build and run every test; ends in "N passed, N failed, N skipped"
	@$(MAKE) --no-print-directory -j2 check-built

panel: deps ## Build the cockpit panel's program for this machine, or for ARCH=arm64 or amd64
	@$(MAKE) --no-print-directory BOARD=panel-linux panel-program

package: deps ## Build the panel's Debian packages for arm64 and amd64 in build/packages
	@$(MAKE) --no-print-directory BOARD=panel-linux ARCH=amd64 panel-package
	@$(MAKE) --no-print-directory BOARD=panel-linux ARCH=arm64 panel-package

check-panel: deps ## Run the panel on real kernel interfaces: a Debian kernel in QEMU (part of check)
	@$(MAKE) --no-print-directory -j2 check-panel-built

bench: deps ## Measure: instructions a pixel, ratios against peers, memory, the panel's latency
	@$(MAKE) --no-print-directory all
	@sh tests/bench/bench.sh $(O)
	@$(MAKE) --no-print-directory bench-panel

gallery: deps ## Fly the real data of ../shared/data and leave the pictures in build/gallery
	@$(MAKE) --no-print-directory all
	@sh host-sim/run/gallery.sh $(O)

fuzz: deps ## Fuzz every parser for FOR seconds each (FOR=60); `make check` replays seeds and random damage
	@sh tests/fuzz/fuzz.sh $(or $(FOR),60)

zcu102: deps ## Build the bare-metal image for the board ZCU102: build/zcu102/landmass.elf
	@$(MAKE) --no-print-directory BOARD=zcu102 all

run-zcu102: zcu102 ## Fly the built-in scene on that board in QEMU; leave its screen dumps in build/zcu102/run
	@$(MAKE) --no-print-directory $(PROGRAMS) $(ZCU102_TOOLS)
	@sh bsp/zcu102/run.sh $(O)

size: zcu102 ## Print that board's memory map, its budgets, and the deepest stack
	@python3 -B tests/zcu102/memory.py

bench-zcu102: zcu102 ## Count the instructions of a flight there, by stage and mode: the same figures in each run
	@$(MAKE) --no-print-directory $(PROGRAMS) $(ZCU102_TOOLS)
	@sh bsp/zcu102/run.sh $(O) count

rooms: $(O)/tests/discipline/flags ## Print which room, library or program may see which, and which does
	@python3 -B tests/discipline/rooms.py $<

lint: ## Formatting, clang-tidy, cppcheck, and both compilers without a warning
	@sh tests/discipline/lint.sh

format: ## Apply clang-format to every C file
	@git ls-files -co --exclude-standard '*.c' '*.h' | xargs clang-format -i

clean: ## Remove everything that was built
	rm -rf build

.PHONY: check-built
check-built: $(PROGRAMS) $(TESTS)
	@sh tests/run.sh $(O) $(TESTS)

$(LIB_fixed): $(call objs,$(SRC_fixed))
$(LIB_firmware): $(call objs,$(SRC_firmware))
$(LIB_drivers): $(DRIVERS:%=$(O)/drivers/%.o)
$(O)/%.a:
	@mkdir -p $(@D)
	@rm -f $@
	$(if $(V),,@echo '  AR   $@')
	$(Q)$(AR) rcs $@ $^

# A folder's flags are those of its layer, and INC_<folder's program> may add to them (see the *.mk files).
$(O)/fixed/%.o: fixed/%.c
	@mkdir -p $(@D)
	$(if $(V),,@echo '  CC   $<')
	$(Q)$(CC) $(CFLAGS_fixed) $(OPT_core) $(DEPGEN) -c $< -o $@
$(O)/firmware/display/scan_conv.o: OPT_core += -fno-unroll-loops # the row of a line's wedge has a pixel or two
$(O)/firmware/map/scan_line.o: OPT_core += -fno-unroll-loops # a run of cells in one tile has four or five groups
$(O)/firmware/map/tile_read.o: OPT_core += -fno-unroll-loops # and so has a run in a tile that stands in for another
$(foreach r,$(ROOMS),$(eval $(O)/firmware/$r/%.o: ROOM := $r))
$(O)/firmware/%.o: firmware/%.c
	@mkdir -p $(@D)
	$(if $(V),,@echo '  CC   $<')
	$(Q)$(CC) $(call CFLAGS_room,$(ROOM)) $(OPT_core) $(DEPGEN) -c $< -o $@
$(O)/drivers/%.o: drivers/%.c
	@mkdir -p $(@D)
	$(if $(V),,@echo '  CC   $<')
	$(Q)$(CC) $(CFLAGS_drivers) $(DEPGEN) -c $< -o $@
$(O)/bsp/%.o: bsp/%.c
	@mkdir -p $(@D)
	$(if $(V),,@echo '  CC   $<')
	$(Q)$(CC) $(CFLAGS_bsp) $(EXTRA_CFLAGS) $(DEPGEN) -c $< -o $@
$(O)/host-sim/%.o: host-sim/%.c
	@mkdir -p $(@D)
	$(if $(V),,@echo '  CC   $<')
	$(Q)$(CC) $(CFLAGS_part) $(EXTRA_CFLAGS) $(DEPGEN) -c $< -o $@
$(O)/tests/%.o: tests/%.c
	@mkdir -p $(@D)
	$(if $(V),,@echo '  CC   $<')
	$(Q)$(CC) $(CFLAGS_host) -Itests/support $(EXTRA_CFLAGS) $(DEPGEN) -c $< -o $@

# Link: objects and archives in the order of the prerequisites, then what LDLIBS says for this target.
$(O)/bin/%:
	@mkdir -p $(@D)
	$(if $(V),,@echo '  LINK $@')
	$(Q)$(CC) $(OPT) $(LDFLAGS) $(filter %.o %.a,$^) $(LDLIBS) -lm -o $@

-include $(shell find $(O) -type f -name '*.d' 2>/dev/null)
