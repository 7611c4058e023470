# template: the board that you copy (docs/PORTING.md). It compiles for the machine that builds, and flies with nothing.

# Your compiler, and the archive tool that belongs to it.
CC := gcc
AR := gcc-ar

# How everything is compiled: which core, whether there is a C library, ...
OPT := -O2 -g
# How the two lowest layers are compiled besides. They are integers: the picture is the same whatever you choose.
OPT_core := -O3 -funroll-loops
OPT_rest  = $(OPT_core)

# Loops written for vectors of the machine: arm64 on any 64-bit Arm, c on every other (firmware/kernels).
KERNELS := c

# The drivers that the board has, each without its ending.
DRIVERS := not_fitted/not_fitted

# The text table of the avionics bus that is built in as the profile "generic" (docs/bus.md), when it is your own.
# BUS_TABLE := bsp/template/my.bus

# Instead of a PC's programs and tests: how your program is linked.
PARTS := bsp/template/program.mk
