# landmass-figures as its user meets it.
T := $(O)/bin/tests/unit/figures/test_figures
TESTS += $(T)
$(T): $(O)/tests/unit/figures/test_figures.o $(TEST_SUPPORT) | $(O)/bin/landmass-figures
$(T): LDLIBS := -lcmocka $(call pkgs,libs,libpng)
