# The golden pictures as a module, beside the product's.
CFLAGS_host += -Itests/golden -Ibsp/web -Itests/web/libc
GOLDEN_MODULE := $(O)/golden.wasm
PROGRAMS += $(GOLDEN_MODULE)
$(GOLDEN_MODULE): $(call objs,tests/web/golden.c tests/golden/golden_flight.c $(addprefix tests/support/memory_,board.c flash.c))
