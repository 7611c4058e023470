# zcu102: the Zynq UltraScale+ board ZCU102, Cortex-A53, no operating system (docs/zcu102.md).
CC      := aarch64-linux-gnu-gcc
AR      := aarch64-linux-gnu-ar
SIZE    := aarch64-linux-gnu-size
NM      := aarch64-linux-gnu-nm
DRIVERS := bezel/bezel_serial can/can_zynqmp display/display_dp display/dp_link flash/flash_gqspi irq/irq_gic400 \
    timer/timer_generic uart/uart_cadence watchdog/watchdog_cadence

# Loops written for the vectors of 64-bit Arm (firmware/kernels).
KERNELS := arm64

# No operating system, no C library, nothing loaded at an address that is not known when it is linked.
OPT      := -O2 -g -mcpu=cortex-a53 -ffreestanding -fno-pic -fno-stack-protector -ffunction-sections -fdata-sections \
    -fcallgraph-info=su # for the deepest stack (tests/zcu102/memory.py)
# Its flash holds one image.
OPT      += -DLM_IMAGES_MAX=1
# The two lowest layers are integers and make vectors of loops; drivers and board run in interrupts, which keep their
# hands off the vector registers, and before the MMU allows unaligned access.
OPT_core := -O3
# Where it pays for its bytes: what runs for every cell, pixel or byte of a tile.
UNROLLED := $(addprefix firmware/,display/composer map/tile_unpack radar/antenna radar/beam radar/line \
    radar/receiver targets/target_line \
    $(addprefix kernels/arm64/,beam grain layover noise bins))
OPT_rest := -Os # of what has no such loops
OPT_board := $(OPT_rest) -mgeneral-regs-only -mstrict-align

# Instead of the programs and tests of a PC.
PARTS := bsp/zcu102/zcu102.mk tests/zcu102/images/images.mk
