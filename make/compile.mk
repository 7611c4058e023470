# How a source becomes an object, and objects an archive or a program.
Q      := $(if $(V),,@)
DEPGEN  = -MMD -MP
say     = $(if $(V),,@printf '  %-4s %s\n' '$(1)' '$(2)')
objs    = $(patsubst %.c,$(O)/%.o,$(1))

# $(call compile, OBJECTS, SOURCES, FLAGS, REMARK): the rule that makes build/<board>/OBJECTS%.o of SOURCES%.c. FLAGS
# come in $$, so that each object has its own.
define compile_rule
$(O)/$(1)%.o: $(2)%.c
	@mkdir -p $$(@D)
	$$(call say,CC,$$<$(if $(4), ($(4))))
	$$(Q)$$(CC) $(3) $$(DEPGEN) -c $$< -o $$@
endef
compile = $(eval $(call compile_rule,$(strip $(1)),$(strip $(2)),$(strip $(3)),$(strip $(4))))

# A folder's flags are those of its layer. EXTRA_CFLAGS of an object are what its part adds (see the *.mk files).
$(foreach r,$(ROOMS),$(eval $(O)/firmware/$r/%.o: ROOM := $r))
# What has no loop over cells or pixels: a board that counts its bytes compiles it for size.
WITHOUT_LOOPS := base/% table/% bus/% nav/% page/% unit/% map/db map/detail map/detail_reader map/geoid \
    map/geoid_reader map/images map/slot map/slot_flash map/tile_cache map/tile_fill clutter/sea radar/dbs radar/defocus radar/shower targets/rcs \
    targets/chips targets/mover targets/signature targets/target targets/target_candidates targets/target_patch \
    targets/chip_sector targets/chip_patch targets/chip_slope radar/patch_rain radar/beacon radar/sector radar/track radar/track_sight \
    display/test_pattern display/symbols display/overlay display/view display/cursor
$(foreach f,$(WITHOUT_LOOPS),$(eval $(O)/firmware/$f.o: OPT_core := $(OPT_rest)))
$(foreach f,$(UNROLLED),$(eval $(O)/$f.o: OPT_core += -funroll-loops))
$(call compile, fixed/,    fixed/,    $$(CFLAGS_fixed) $$(OPT_core))
$(call compile, firmware/, firmware/, $$(call CFLAGS_room,$$(ROOM)) $$(OPT_core))
$(call compile, drivers/,  drivers/,  $$(CFLAGS_drivers))
$(call compile, bsp/,      bsp/,      $$(CFLAGS_bsp) $$(EXTRA_CFLAGS))
$(call compile, host-sim/, host-sim/, $$(CFLAGS_part) $$(EXTRA_CFLAGS))
$(call compile, tests/,    tests/,    $$(CFLAGS_host) -Itests/support $$(EXTRA_CFLAGS))

$(O)/firmware/display/scan_conv.o: OPT_core += -fno-unroll-loops # the row of a line's wedge has a pixel or two
$(O)/firmware/map/scan_line.o: OPT_core += -fno-unroll-loops # a run of cells in one tile has four or five groups
$(O)/firmware/radar/detail_patch.o: OPT_core += -fno-unroll-loops -fno-tree-vectorize # a roof has four cells of a line

$(O)/%.a:
	@mkdir -p $(@D)
	@rm -f $@
	$(call say,AR,$@)
	$(Q)$(AR) rcs $@ $^

# A build id covers debug information, which names the building folder: installed programs go without (make reproduce).
$(O)/bin/landmass-%: LDFLAGS += -Wl,--build-id=none

# Objects, archives in whatever order, then what LDLIBS says for this target.
$(O)/bin/%:
	@mkdir -p $(@D)
	$(call say,LINK,$@)
	$(Q)$(CC) $(OPT) $(LDFLAGS) $(filter %.o,$^) -Wl,--start-group $(filter %.a,$^) -Wl,--end-group $(LDLIBS) -lm -o $@
