T := $(O)/bin/tests/unit/common/test_common
TESTS += $(T)
$(T): $(O)/tests/unit/common/test_common.o $(LIB_hs)
$(T): LDLIBS := -lcmocka $(call pkgs,libs,libpng)
