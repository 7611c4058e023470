# Images of the board that only tests run: `make zcu102` builds them beside the product.
CFLAGS_host += -Itests/golden -Itests/zcu102 -Itests/zcu102/images
TEST_IMAGES := $(O)/golden.elf
PROGRAMS    += $(TEST_IMAGES)
image_objs   = $(call objs,$(addprefix tests/zcu102/images/,$(1)))
$(TEST_IMAGES): $(call image_objs,look.c)
$(O)/golden.elf: $(call image_objs,golden.c) $(call objs,tests/golden/golden_flight.c tests/support/memory_flash.c)
