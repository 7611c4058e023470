# What landmass-bus says of a profile, and the text tables that it reads.
BUS_FORMS := $(O)/bin/tests/unit/bus/test_forms
TESTS += $(BUS_FORMS)
$(BUS_FORMS): tests/unit/bus/test_forms.py | $(O)/bin/landmass-bus
	@mkdir -p $(@D)
	@cp $< $@
	@chmod +x $@
