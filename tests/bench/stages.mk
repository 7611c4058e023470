STAGE_BENCH := $(O)/bin/tests/bench/stage_bench
PROGRAMS += $(STAGE_BENCH)
$(O)/tests/bench/stage_bench.o: CFLAGS_host += -Itests/golden
$(STAGE_BENCH): $(O)/tests/bench/stage_bench.o $(O)/tests/golden/golden_signature.o \
    $(LIB_support) $(LIB_reference) $(LIB_hs) $(LIB_firmware) $(LIB_fixed)
$(STAGE_BENCH): LDLIBS := $(call host_links,reference)

DIS_GLASS := $(O)/bin/tests/bench/dis_glass
PROGRAMS += $(DIS_GLASS)
$(O)/tests/bench/dis_glass.o: CFLAGS_host += -Ihost-sim/dis
$(DIS_GLASS): $(O)/tests/bench/dis_glass.o $(LIB_support) $(call host_archives,dis lib firmware fixed drivers)
$(DIS_GLASS): LDLIBS := $(call host_links,dis) -lcmocka
