# Drawn faults in flight: docs/faults.md.
FAULTS_BIN := $(O)/bin/tests/faults
$(FAULTS_BIN)/campaign: $(addprefix $(O)/tests/faults/,campaign.o faults.o) $(LIB_support) $(LIB_hs) $(LIB_firmware) $(LIB_fixed)
$(FAULTS_BIN)/campaign: LDLIBS = -lcmocka $(call pkgs,libs,libpng)

TESTS += $(FAULTS_BIN)/test_faults
$(FAULTS_BIN)/test_faults: tests/faults/test_faults.sh $(FAULTS_BIN)/campaign
	@mkdir -p $(@D)
	@cp $< $@
	@chmod +x $@

FAULTS ?= 10000
.PHONY: faults
faults: $(FAULTS_BIN)/campaign ## Fly FAULTS=10000 faults drawn by SEED=1; print what the glass says of each
	@$< $(FAULTS) $(or $(SEED),1)
