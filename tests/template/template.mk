T := $(O)/bin/tests/template/test_template
TESTS += $(T)
$(T): tests/template/test_template.sh
	@mkdir -p $(@D)
	@cp $< $@
	@chmod +x $@
