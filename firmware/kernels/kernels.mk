# The kernels: loops over a line's cells, in plain C for every machine (c/), and once more in a folder for each
# architecture that has vectors of its own (arm64/). KERNELS, in the board's board.mk, says whose the stages call.
KERNELS ?= c
SRC_kernels := $(wildcard firmware/kernels/c/*.c $(if $(filter-out c,$(KERNELS)),firmware/kernels/$(KERNELS)/*.c))

# Beside another folder's, the functions of c/ are called lm_k_..._c (plain.h lists them).
PLAIN_KERNELS := $(shell sed -n 's/.*(\(lm_k_[a-z0-9_]*\)) .*/\1/p' firmware/kernels/plain.h)
ifneq ($(KERNELS),c)
$(O)/firmware/kernels/c/%.o: OPT_core := $(OPT_rest) -fno-unroll-loops -fno-tree-vectorize \
    $(foreach k,$(PLAIN_KERNELS),-D$k=$k_c) # tails, of less than a vector
endif

# A run of cells in one tile has four or five groups, in a tile that stands in for another too.
$(O)/firmware/kernels/%/tile_read.o: OPT_core += -fno-unroll-loops
# Eight times the same for a row need not stand there eight times.
$(O)/firmware/kernels/arm64/tile_row.o: OPT_core := -O2
# A rectangle is some blocks wide.
$(O)/firmware/kernels/arm64/colour.o: OPT_core += -fno-unroll-loops
