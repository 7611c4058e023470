# One display that flies for weeks: docs/TRUST.md, "Endurance".
ENDURANCE := $(O)/bin/tests/endurance/endurance
PROGRAMS += $(ENDURANCE)
$(ENDURANCE): $(addprefix $(O)/tests/endurance/,endurance.o tour.o) $(LIB_support) $(LIB_hs) $(LIB_firmware) $(LIB_fixed)
$(ENDURANCE): LDLIBS := -lcmocka -lpng -lm

TESTS += $(O)/bin/tests/endurance/test_endurance
$(O)/bin/tests/endurance/test_endurance: tests/endurance/test_endurance.sh $(ENDURANCE)
	@mkdir -p $(@D)
	@cp $< $@
	@chmod +x $@

HOURS ?= 1000
.PHONY: endurance
endurance: $(ENDURANCE) ## Fly one display for HOURS=1000 round the Earth, without a restart: no drift, no growth, no false flag
	@$< $(HOURS)
