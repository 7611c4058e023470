# bench-linux: an ordinary PC. Flash is a file, glass is a window or PNG files, the bus is a log or SocketCAN.
CC  := gcc
AR  := gcc-ar
RUN :=

# Of drivers/, each without its ending: those of the panel too, which is tested here.
DRIVERS = can/can_line can/can_log $(LINUX_DRIVERS)

# How the two lowest layers are compiled. They are all integers, so the picture is the same whatever is chosen here. A PC of
# the last ten years has 256-bit vectors: its compiler is told so when the machine that builds, which is the one that
# runs, says it has them. Tuned for haswell, because the tuning for no machine in particular avoids vector gathers.
OPT_core := -O3 -funroll-loops
OPT_rest  = $(OPT_core)
ifeq ($(findstring clang,$(CC)),)
OPT_core += -fno-tree-loop-distribution # or gcc makes two loops of tile_read.c's, each of which works out the places
endif
HAS_AVX2 := $(shell grep -qsw avx2 /proc/cpuinfo && grep -qsw bmi2 /proc/cpuinfo && echo yes)
ifeq ($(HAS_AVX2),yes)
OPT_core += -march=x86-64-v3 -mtune=haswell
endif
