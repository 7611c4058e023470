TEST_TEMPLATE := $(O)/bin/tests/template/test_template
TESTS += $(TEST_TEMPLATE)
$(TEST_TEMPLATE): tests/template/test_template.sh
	@mkdir -p $(@D)
	@cp $< $@
	@chmod +x $@
