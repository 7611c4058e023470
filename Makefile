# landmass: the menu. `make` alone prints it. Each part adds its own programs and tests in a *.mk beside its sources.
.DEFAULT_GOAL := help
BOARD ?= bench-linux
O     := build/$(BOARD)
include bsp/$(BOARD)/board.mk

# -g1 has functions and lines, which a backtrace needs; a debugger wants OPT='-Og -g'. It is a tenth of the time of compiling.
OPT  ?= -O2 -g1 -pipe
CORES := $(shell nproc)
CLANG ?= clang-19
PKG_CONFIG ?= pkg-config
# $(call pkgs,WHAT,PACKAGES): what pkg-config says, asked once of each list.
pkgs_name = said--$(1)-$(subst $(subst ,, ),-,$(strip $(2)))
pkgs = $(if $(strip $(2)),$(if $(filter undefined,$(flavor $(pkgs_name))),$(eval \
    $(pkgs_name) := $$(shell $(PKG_CONFIG) --$(1) $(2) 2>/dev/null)))$($(pkgs_name)))

LIB_fixed    := $(O)/libfixed.a
LIB_firmware := $(O)/libfirmware.a
LIB_drivers  := $(O)/libdrivers.a
LIB_support  := $(O)/tests/support/libsupport.a
PROGRAMS :=
TESTS    :=
include make/layers.mk make/compile.mk make/variants.mk firmware/kernels/kernels.mk make/generated.mk make/host.mk
# What is built beside the firmware: a PC's programs and tests, unless the board says otherwise.
PARTS ?= drivers/*.mk bsp/panel-linux/panel.mk host-sim/host-sim.mk tests/*.mk tests/*/*.mk tests/*/*/*.mk
include $(sort $(wildcard $(PARTS)))

$(call archive, $(LIB_fixed), $(SRC_fixed))
$(call archive, $(LIB_firmware), $(SRC_firmware))
$(call archive, $(LIB_drivers), $(DRIVERS:%=drivers/%.c))
$(call archive, $(LIB_support), $(wildcard tests/support/*.c))

# A make for another board: what this one was told about compilers and folders is not for it.
make_board = env $(patsubst %,-u %,MAKEFLAGS MAKEOVERRIDES CC OPT OPT_core LDFLAGS) $(MAKE) --no-print-directory -j2 BOARD=$(1)

.PHONY: help deps all run check check-clang check-panel panel package bench gallery fuzz rooms lint format clean
.PHONY: cuts deps-world reproduce web world zcu102 run-zcu102 size bench-zcu102 bench-m7 cycles coverage figures prove

help: ## Print this menu
	@echo 'landmass: make TARGET'
	@sed -n 's/^\([a-z0-9-]*\):.*## /  \1\t/p' $(MAKEFILE_LIST) | expand -t 16

deps: ## Install the Debian packages of bsp/bench-linux/packages.txt (as root or through sudo)
	@sh bsp/bench-linux/deps.sh

deps-world: ## Install what make world and its tests need besides: host-sim/world/packages.txt
	@sh bsp/bench-linux/deps.sh host-sim/world/packages.txt

world: deps deps-world ## Make a world in shards on this machine: WORLD_OPTIONS, or the built-in generator; pictures in build/world
	@$(MAKE) --no-print-directory $(PROGRAMS)
	@sh host-sim/world/world.sh $(O)

all: $(PROGRAMS) ## Build every program, without running anything

# How long a target takes has a goal (tests/figures/goals.txt), and is kept.
begins = mkdir -p build && date +%s >build/$(1).began
lasted = echo "$$(($$(date +%s) - $$(cat build/$(1).began))) s $(2)" | python3 -B tests/figures/figures.py --keep $(1)
RUN_PROGRAMS := $(addprefix $(O)/bin/landmass-,db scene)
RUN_LATER    := $(addprefix $(O)/bin/landmass-,nav sim target)
run: deps ## Build what it needs, make the database of the built-in scene, fly over it, leave pictures
	@$(call begins,run)
	@$(MAKE) --no-print-directory -j$(CORES) $(RUN_PROGRAMS)
	@sh host-sim/run/run.sh $(O) $(MAKE) --no-print-directory -j$(CORES) $(RUN_LATER)
	@$(call lasted,run,from the packages to the pictures)

check: deps ## Build and run every test; ends in "N passed, N failed, N skipped"
	@$(call begins,check)
	@$(MAKE) --no-print-directory -j2 check-built
	@$(call lasted,check,from the packages to the sum)

# The program test_NAME, or else all that have NAME in folder or name.
TESTS_named = $(strip $(or $(filter %/$(NAME) %/test_$(NAME),$(TESTS)), \
    $(foreach t,$(TESTS:$(O)/bin/tests/%=%),$(if $(findstring $(NAME),$t $(subst /test_,/,$t)),$(O)/bin/tests/$t))))
.PHONY: test
test: $(if $(NAME),$(TESTS_named)) ## Build and run the tests of one name or folder: NAME=page, NAME=firmware/bus
	@$(if $(and $(NAME),$(TESTS_named)),sh tests/run.sh $(O) $(TESTS_named),\
	    echo 'make test NAME=...: a test, or a part of its folder or name, one of'; \
	    printf '  %s\n' $(patsubst test_%,%,$(subst /test_,/,$(TESTS:$(O)/bin/tests/%=%))); exit 1)

panel: deps ## Build the cockpit panel's program for this machine, or for ARCH=arm64 or amd64
	@$(MAKE) --no-print-directory BOARD=panel-linux panel-program

package: deps ## Build the Debian packages in build/packages: the panel for arm64 and amd64, the tools for this machine
	@$(MAKE) --no-print-directory BOARD=panel-linux ARCH=amd64 panel-package
	@$(MAKE) --no-print-directory BOARD=panel-linux ARCH=arm64 panel-package
	@$(MAKE) --no-print-directory O=build/tools HAS_AVX2= tools-package

reproduce: deps ## Build the Debian packages twice, in two folders: the same, bit by bit? Part of .ci/run
	@sh host-sim/package/reproduce.sh

check-clang: deps ## Unit tests and golden pictures once more, built by CLANG (clang-19); like check, part of .ci/run
	@$(MAKE) --no-print-directory -j2 CC=$(CLANG) O=build/$(CLANG) check-twice

check-panel: deps ## Run the panel on real kernel interfaces: a Debian kernel in QEMU (part of check)
	@$(MAKE) --no-print-directory -j2 check-panel-built

bench: deps ## Measure: instructions a pixel, ratios against peers, memory, the panel's latency, each beside its goal
	@$(MAKE) --no-print-directory -j$(CORES) all
	@sh tests/bench/bench.sh $(O)
	@$(MAKE) --no-print-directory bench-panel

gallery: deps ## Fly the real data of ../shared/data and leave the pictures in build/gallery
	@$(MAKE) --no-print-directory all
	@sh host-sim/run/gallery.sh $(O)

fuzz: deps ## Fuzz every parser for FOR seconds (FOR=60), or until each has tried RUNS inputs; `make check` replays seeds and random damage
	@sh tests/fuzz/fuzz.sh $(if $(RUNS),--until $(RUNS)) $(or $(FOR),$(if $(RUNS),0,60))

cuts: $(O)/bin/tests/unit/host-sim/slots/test_cuts $(O)/bin/tests/unit/host-sim/slots/test_kills ## Cut the power of 30,000 loads of a database (LANDMASS_SEED=1), and kill 1,000 more
	@LANDMASS_CUTS=30000 $< 'no_cut*'
	@BUILD=$(O) LANDMASS_KILLS=1000 $(O)/bin/tests/unit/host-sim/slots/test_kills

web: deps ## The display as a page: build/web/site, which any web server with byte ranges serves
	@$(MAKE) --no-print-directory -j2 BOARD=web all
	@sh bsp/web/site.sh $(O)

zcu102: deps ## Build the bare-metal image for the board ZCU102: build/zcu102/landmass.elf
	@$(MAKE) --no-print-directory BOARD=zcu102 all

run-zcu102: zcu102 ## Fly the built-in scene on that board in QEMU; leave its screen dumps in build/zcu102/run
	@$(MAKE) --no-print-directory $(PROGRAMS) $(ZCU102_TOOLS)
	@sh bsp/zcu102/run.sh $(O)

size: zcu102 ## Print that board's memory map, its budgets, the deepest stack, and the last release's
	@python3 -B tests/zcu102/memory.py

bench-zcu102: zcu102 ## Count the instructions of a flight there, by stage and mode: the same figures in each run
	@$(MAKE) --no-print-directory $(PROGRAMS) $(ZCU102_TOOLS)
	@sh bsp/zcu102/run.sh $(O) count

bench-m7: deps ## Count the instructions of a patch on a Cortex-M7, which has no vectors
	@$(MAKE) --no-print-directory -j$(CORES) $(CORTEX_M7)/bench.elf $(STAGE_BENCH)
	@sh tests/cortex-m7/bench.sh $(O)

cycles: zcu102 ## Estimate the cycles of that flight at 1.2 GHz by stage and loop, and what bounds each; a minute or two
	@$(MAKE) --no-print-directory $(PROGRAMS) $(ZCU102_TOOLS)
	@sh bsp/zcu102/run.sh $(O) cycles

COUNTED := -fprofile-instr-generate
coverage: deps ## Print the share of lines, branches and conditions of fixed and firmware that unit tests and golden pictures run
	@$(MAKE) --no-print-directory -j2 CC=clang-19 O=build/coverage OPT='-O1 -g' LDFLAGS=$(COUNTED) \
	    OPT_core='$(COUNTED) -fcoverage-mapping -fcoverage-mcdc' coverage-built

prove: deps ## Prove with CBMC what tests/prove states: all, or NAME=canas; PLANTS=1: see planted bugs found
	@$(MAKE) -s --no-print-directory $(GEN)/fixed/src/tables.c
	@python3 -B tests/prove/prove.py $(O) $(if $(PLANTS),--plants) $(NAME)

figures: deps ## Print size, stack, instructions and coverage beside those of the last release
	@sh tests/figures/figures.sh $(O)

rooms: $(O)/tests/discipline/flags ## Print which room, library or program may see which, and which does
	@python3 -B tests/discipline/rooms.py $<

lint: deps ## clang-format, clang-tidy, cppcheck, shellcheck, documents, and CLANG without a warning
	@CLANG=$(CLANG) sh tests/discipline/lint.sh

format: ## Apply clang-format to every C file
	@git ls-files -co --exclude-standard '*.c' '*.h' | xargs clang-format -i

clean: ## Remove everything that was built
	rm -rf build

.PHONY: check-built check-twice
check-built: $(PROGRAMS) $(TESTS)
	@sh tests/run.sh $(O) $(TESTS)
UNIT_TESTS := $(filter $(O)/bin/tests/unit/% $(O)/bin/tests/golden/test_golden,$(TESTS))
# What a second compiler could change; whole programs and packages are tested once.
TWICE := $(filter-out $(addprefix $(O)/bin/tests/unit/host-sim/,programs/% package/%),$(UNIT_TESTS))
check-twice: $(TWICE)
	@sh tests/run.sh $(O) $(TWICE)

.PHONY: coverage-built
COUNTED_TESTS = $(patsubst $(O)/bin/%,$(O)/%.o,$(filter $(O)/bin/tests/unit/fixed/% $(O)/bin/tests/unit/firmware/%,$(UNIT_TESTS)))
coverage-built: $(UNIT_TESTS) $(O)/every_object
	@rm -rf $(O)/profiles
	@status=0; sh tests/run.sh $(O) $(UNIT_TESTS) >$(O)/tests.log || { status=1; grep -A60 FAILED $(O)/tests.log; }; \
	    python3 -B tests/figures/coverage.py $(O) $(O)/every_object $(COUNTED_TESTS) || status=1; tail -n 1 $(O)/tests.log; exit $$status
$(O)/every_object: $(LIB_firmware) $(LIB_fixed)
	@echo 'int main(void) { return 0; }' | $(CC) $(LDFLAGS) -x c - -x none -Wl,--whole-archive $^ -Wl,--no-whole-archive -o $@

-include $(shell find $(O) -type f -name '*.d' 2>/dev/null)
