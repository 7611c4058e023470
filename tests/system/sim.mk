# The programs as their users run them.
SYSTEM_SCRIPTS := $(addprefix $(O)/bin/tests/system/,test_sim test_cli test_signatures test_radar test_bus_table)
TESTS += $(SYSTEM_SCRIPTS)
$(SYSTEM_SCRIPTS): $(O)/bin/tests/system/%: tests/system/%.sh tests/system/test_sim_tap.sh $(PROGRAMS)
	@mkdir -p $(@D)
	@cp $< $@
	@chmod +x $@

SIM_TOOL := $(O)/bin/tests/system/test_sim_tool
$(O)/bin/tests/system/test_sim $(O)/bin/tests/system/test_radar: $(SIM_TOOL)
$(SIM_TOOL): $(O)/tests/system/test_sim_tool.o $(LIB_support) $(LIB_fixed)
$(SIM_TOOL): LDLIBS := $(call pkgs,libs,libpng)

# What happens to wrong and doubtful inputs; the table of docs/database.md.
INPUTS_TEST := $(O)/bin/tests/system/test_inputs
TESTS += $(INPUTS_TEST)
$(INPUTS_TEST): tests/system/test_inputs.py $(PROGRAMS)
	@mkdir -p $(@D)
	@printf '#!/bin/sh\nexec $${PYTHON:-/usr/bin/python3} -B tests/system/test_inputs.py "$$@"\n' >$@
	@chmod +x $@

# Thermal pictures beside the thermal band of a satellite.
LANDSAT_TEST := $(O)/bin/tests/system/test_real_infrared
TESTS += $(LANDSAT_TEST)
$(LANDSAT_TEST): tests/system/test_real_infrared.py $(O)/bin/landmass-db
	@mkdir -p $(@D)
	@printf '#!/bin/sh\nexec $${PYTHON:-/usr/bin/python3} -B tests/system/test_real_infrared.py\n' >$@
	@chmod +x $@

# Signed images, judged by openssl and hashlib, and what a panel does with them.
SIGN_TESTS := $(addprefix $(O)/bin/tests/system/,test_sign test_panel_trust)
TESTS += $(SIGN_TESTS)
$(SIGN_TESTS): $(O)/bin/tests/system/%: tests/system/%.py $(O)/bin/landmass-db $(PANEL)
	@mkdir -p $(@D)
	@printf '#!/bin/sh\nexec $${PYTHON:-/usr/bin/python3} -B %s "$$@"\n' '$<' >$@
	@chmod +x $@

# Images, and rasters, that are made in shards.
SHARDS_TESTS := $(addprefix $(O)/bin/tests/system/,test_shards test_strips)
TESTS += $(SHARDS_TESTS)
$(SHARDS_TESTS): $(O)/bin/tests/system/%: tests/system/%.py $(addprefix $(O)/bin/landmass-,db scene)
	@mkdir -p $(@D)
	@printf '#!/bin/sh\nexec $${PYTHON:-/usr/bin/python3} -B %s\n' '$<' >$@
	@chmod +x $@
