# Exemplars, network, segmentation and reflectivity.
DB_CLASSIFIER_TESTS := $(addprefix $(O)/bin/tests/unit/db/,test_class_table test_exemplars test_mlp \
    test_evaluate test_reflect test_segment)
TESTS += $(DB_CLASSIFIER_TESTS)
DB_CLASSIFIER_OBJECTS := $(addprefix $(O)/tests/unit/db/,fixture.o test_class_table.o test_exemplars.o \
    test_mlp.o test_evaluate.o test_reflect.o test_segment.o)
$(DB_CLASSIFIER_OBJECTS): EXTRA_CFLAGS := -Ihost-sim/db $(call pkgs,cflags,gdal)
$(DB_CLASSIFIER_TESTS): $(O)/bin/tests/unit/db/%: $(O)/tests/unit/db/%.o $(O)/tests/unit/db/fixture.o \
    $(TEST_SUPPORT) $(LIB_db) $(LIB_hs) $(LIB_firmware) $(LIB_fixed)
$(DB_CLASSIFIER_TESTS): LDLIBS := -lcmocka $(call pkgs,libs,gdal openblas libpng)
# The commands are tested as programs.
$(addprefix $(O)/bin/tests/unit/db/,test_class_table test_reflect test_segment): | $(O)/bin/landmass-db
