# The programs as their users run them.
SYSTEM_SCRIPTS := $(addprefix $(O)/bin/tests/system/,test_sim test_cli test_signatures)
TESTS += $(SYSTEM_SCRIPTS)
$(SYSTEM_SCRIPTS): $(O)/bin/tests/system/%: tests/system/%.sh tests/system/test_sim_tap.sh $(PROGRAMS)
	@mkdir -p $(@D)
	@cp $< $@
	@chmod +x $@

T := $(O)/bin/tests/system/test_sim_tool
$(O)/bin/tests/system/test_sim: $(T)
$(T): $(O)/tests/system/test_sim_tool.o $(O)/tests/support/tiny_image.o $(LIB_fixed)
$(T): LDLIBS := $(call pkgs,libs,libpng)
