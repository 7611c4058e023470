# The programs as their users run them.
SYSTEM_SCRIPTS := $(addprefix $(O)/bin/tests/system/,test_sim test_cli test_signatures)
TESTS += $(SYSTEM_SCRIPTS)
$(SYSTEM_SCRIPTS): $(O)/bin/tests/system/%: tests/system/%.sh tests/system/test_sim_tap.sh $(PROGRAMS)
	@mkdir -p $(@D)
	@cp $< $@
	@chmod +x $@

SIM_TOOL := $(O)/bin/tests/system/test_sim_tool
$(O)/bin/tests/system/test_sim: $(SIM_TOOL)
$(SIM_TOOL): $(O)/tests/system/test_sim_tool.o $(LIB_support) $(LIB_fixed)
$(SIM_TOOL): LDLIBS := $(call pkgs,libs,libpng)
