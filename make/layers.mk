# What each layer is compiled with. It sees its own headers and those below it, and no more (docs/EQUATIONS.md, "Who may
# include whom"). The two lowest layers do not even see the C library: -nostdinc leaves the compiler's own headers only.
WARN := -Wall -Wextra -Wconversion -Wshadow -Wstrict-prototypes -Wmissing-prototypes -Wvla -Werror
WARN += -Wno-enum-float-conversion # clang's -Wconversion has it: an enumerator is how C11 names a whole number
CSTD := -std=c11
FREESTANDING := -ffreestanding -nostdinc -isystem $(shell $(CC) -print-file-name=include)

include firmware/rooms.mk
INC_fixed    := -Ifixed/include
INC_room      = $(INC_fixed) $(call ROOM_HEADERS,$(1) $(SEES_$(1)))
INC_firmware := $(INC_fixed) $(call ROOM_HEADERS,$(ROOMS))
INC_drivers  := $(INC_fixed) $(call ROOM_HEADERS,$(SEES_drivers)) -Idrivers/include
INC_bsp      := $(INC_firmware) -Idrivers/include -Ibsp/$(BOARD) -Ibsp/record
INC_host      = $(INC_bsp)

CFLAGS_fixed   = $(CSTD) $(WARN) $(OPT) $(FREESTANDING) $(INC_fixed)
CFLAGS_room    = $(CSTD) $(WARN) $(OPT) $(FREESTANDING) $(call INC_room,$(1))
CFLAGS_drivers = $(CSTD) $(WARN) $(OPT) -D_GNU_SOURCE $(INC_drivers)
CFLAGS_bsp     = $(CSTD) $(WARN) $(OPT) -D_GNU_SOURCE $(INC_bsp)
CFLAGS_host    = $(CSTD) $(WARN) $(OPT) -D_GNU_SOURCE $(INC_host)
