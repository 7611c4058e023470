$(O)/bin/tests/bench/stage_bench: $(O)/tests/bench/stage_bench.o $(O)/tests/support/tiny_image.o $(O)/tests/support/memory_flash.o $(LIB_firmware) $(LIB_fixed)
$(O)/bin/tests/bench/stage_bench: LDLIBS :=
PROGRAMS += $(O)/bin/tests/bench/stage_bench
