# What landmass-bus says of a profile, and the text tables that it reads.
BUS_FORMS := $(O)/bin/tests/unit/bus/test_forms
TESTS += $(BUS_FORMS)
$(BUS_FORMS): tests/unit/bus/test_forms.py | $(O)/bin/landmass-bus
	@mkdir -p $(@D)
	@cp $< $@
	@chmod +x $@

BUS_TEXT := $(O)/bin/tests/unit/bus/test_table_text
TESTS += $(BUS_TEXT)
$(O)/tests/unit/bus/%.o: EXTRA_CFLAGS := -Ihost-sim/bus
$(BUS_TEXT): $(O)/tests/unit/bus/test_table_text.o $(O)/host-sim/bus/table_text.o $(LIB_firmware) $(LIB_fixed) $(LIB_hs)
$(BUS_TEXT): LDLIBS := -lcmocka
