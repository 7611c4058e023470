STAGE_BENCH := $(O)/bin/tests/bench/stage_bench
PROGRAMS += $(STAGE_BENCH)
$(O)/tests/bench/stage_bench.o: CFLAGS_host += -Itests/golden
$(STAGE_BENCH): $(O)/tests/bench/stage_bench.o $(O)/tests/bench/patch_rig.o $(O)/tests/golden/golden_signature.o \
    $(LIB_support) $(LIB_reference) $(LIB_hs) $(LIB_firmware) $(LIB_fixed)
$(STAGE_BENCH): LDLIBS := $(call host_links,reference)

DIS_GLASS := $(O)/bin/tests/bench/dis_glass
PROGRAMS += $(DIS_GLASS)
$(O)/tests/bench/dis_glass.o: CFLAGS_host += -Ihost-sim/dis
$(DIS_GLASS): $(O)/tests/bench/dis_glass.o $(LIB_support) $(call host_archives,dis lib firmware fixed drivers)
$(DIS_GLASS): LDLIBS := $(call host_links,dis) -lcmocka

# make soak: an hour of a full bus with two displays, in some minutes; make check flies half a minute of it.
SOAK := $(O)/bin/tests/bench/soak
SOAK_S ?= 3600
PROGRAMS += $(SOAK)
$(SOAK): $(O)/tests/bench/soak.o $(LIB_support) $(LIB_hs) $(LIB_firmware) $(LIB_fixed)
$(SOAK): LDLIBS := -lcmocka -lpng -lm
TESTS += $(O)/bin/tests/bench/test_soak
$(O)/bin/tests/bench/test_soak: tests/bench/test_soak.sh $(SOAK)
	@mkdir -p $(@D)
	@cp $< $@
	@chmod +x $@
WORLD_FLIGHTS := $(O)/bin/tests/bench/world_flights
PROGRAMS += $(WORLD_FLIGHTS)
$(WORLD_FLIGHTS): $(O)/tests/bench/world_flights.o $(LIB_support) $(LIB_hs) $(LIB_firmware) $(LIB_fixed)
$(WORLD_FLIGHTS): LDLIBS := -lcmocka -lpng -lm
.PHONY: world-flights
world-flights: $(WORLD_FLIGHTS) ## Fly round the Earth over WORLD=FILE.lmdb: tiles late, bytes a second, steps; some minutes
	@$(WORLD_FLIGHTS) $(or $(WORLD),build/world/world.lmdb)
.PHONY: soak
soak: $(SOAK) ## Two displays for an hour on a bus that is never idle: nothing may be lost (SOAK_S=3600)
	@$(SOAK) $(SOAK_S)
NETEM_PEER := $(O)/bin/tests/bench/netem_peer
PROGRAMS += $(NETEM_PEER)
$(NETEM_PEER): $(O)/tests/bench/netem_peer.o $(call host_archives,netem tracer visual gis lib fixed firmware)
$(NETEM_PEER): LDLIBS := $(call host_links,netem)
