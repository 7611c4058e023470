# The board in QEMU. The images are built by a make of their own, for the board; these are the tools of the PC.
ZCU102 := $(O)/bin/tests/zcu102
ZCU102_TOOLS := $(addprefix $(ZCU102)/,golden_flash picture_checksum scenario cycles_plugin.so tile_order strides)
ZCU102_TESTS := $(addprefix $(ZCU102)/,test_devices test_golden test_flight test_slots test_memory)
TESTS += $(ZCU102_TESTS)
$(O)/tests/zcu102/%.o: CFLAGS_host += -Itests/golden
$(ZCU102)/golden_flash: $(call objs,$(addprefix tests/,zcu102/golden_flash.c golden/golden_scene.c golden/golden_signature.c)) \
    $(LIB_support) \
    $(LIB_hs) $(LIB_fixed)
$(ZCU102)/picture_checksum: $(O)/tests/zcu102/picture_checksum.o $(LIB_hs) $(LIB_fixed)
$(ZCU102)/picture_checksum: LDLIBS := $(call pkgs,libs,libpng)
$(ZCU102)/scenario: $(O)/tests/zcu102/scenario.o $(call host_archives,sim drivers)

# What QEMU is given to count misses, and the test of its model (make cycles).
CYCLES := $(O)/tests/zcu102/cycles
$(CYCLES)/%.o: EXTRA_CFLAGS := -fPIC
$(ZCU102)/cycles_plugin.so: $(CYCLES)/plugin.o $(CYCLES)/cache_model.o
$(ZCU102)/cycles_plugin.so: LDFLAGS := -shared
$(ZCU102)/tile_order: $(CYCLES)/tile_order.o $(CYCLES)/cache_model.o
$(ZCU102)/strides: $(CYCLES)/strides.o $(CYCLES)/cache_model.o
$(ZCU102)/test_cache_model: $(CYCLES)/test_cache_model.o $(CYCLES)/cache_model.o $(LIB_support) $(LIB_firmware) $(LIB_fixed)
$(ZCU102)/test_cache_model: LDLIBS := -lcmocka
TESTS += $(ZCU102)/test_cache_model $(ZCU102)/test_cycles

.PHONY: zcu102-images
zcu102-images:
	@! command -v aarch64-linux-gnu-gcc >/dev/null || \
	    $(call make_board,zcu102) all

$(ZCU102)/test_slots: | $(O)/bin/landmass-load $(O)/bin/tests/panel-vm/glass
$(ZCU102)/test_cycles: tests/zcu102/cycles/test_cycles.py $(ZCU102_TOOLS) | zcu102-images
	@mkdir -p $(@D)
	@printf '#!/bin/sh\nexec python3 -B $<\n' >$@
	@chmod +x $@
$(ZCU102_TESTS): $(ZCU102)/%: tests/zcu102/%.py $(ZCU102_TOOLS) $(addprefix $(O)/bin/landmass-,sim nav) | zcu102-images
	@mkdir -p $(@D)
	@printf '#!/bin/sh\nexec python3 -B $<\n' >$@
	@chmod +x $@
