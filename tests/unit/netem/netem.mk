# Networks, training, scores and chips of landmass-netem.
NETEM_TESTS := $(addprefix $(O)/bin/tests/unit/netem/,test_gradient test_score test_train test_chips test_search test_program)
TESTS += $(NETEM_TESTS)
$(O)/tests/unit/netem/%.o: EXTRA_CFLAGS := -Ihost-sim/netem -Ihost-sim/target -Ihost-sim/db -Itests/unit/target $(call pkgs,cflags,fftw3 gdal)
$(NETEM_TESTS): $(O)/bin/tests/unit/netem/%: $(O)/tests/unit/netem/%.o $(O)/tests/unit/netem/facets.o \
    $(O)/tests/unit/target/known_records.o $(TEST_SUPPORT) $(LIB_netem) $(LIB_target) $(LIB_hs) $(LIB_firmware) $(LIB_fixed)
$(NETEM_TESTS): LDLIBS = -lcmocka $(LIBS_target) $(call pkgs,libs,$(NETEM_PKGS))
$(O)/bin/tests/unit/netem/test_program: | $(O)/bin/landmass-netem
