# Images that tests run on the board ZCU102, beside the product. The board's make builds them (bsp/zcu102/board.mk).
ifeq ($(BOARD),zcu102)
CFLAGS_host += -Itests/golden -Itests/zcu102 -Itests/zcu102/images
TEST_IMAGES := $(addprefix $(O)/,golden.elf flight.elf bench.elf devices.elf faults.elf)
PROGRAMS    += $(TEST_IMAGES)
image_objs   = $(addprefix $(O)/tests/zcu102/images/,$(addsuffix .o,$(1)))
$(TEST_IMAGES): $(call image_objs,look)
$(O)/golden.elf: $(call image_objs,golden) \
    $(call objs,tests/golden/golden_flight.c $(addprefix tests/support/memory_,board.c flash.c))
$(O)/flight.elf: $(call image_objs,flight peer core1 handed)
$(O)/bench.elf: $(call image_objs,bench handed instrument) $(O)/stages.o $(O)/stages.wrap
$(O)/bench.elf: LDFLAGS := -Wl,@$(O)/stages.wrap
$(O)/devices.elf: $(call image_objs,devices registers)
$(O)/faults.elf: $(call image_objs,faults)

# What `make bench-zcu102` counts, those of them that the firmware has. A line is what a *_draw_line and the *_paint
# behind it take.
STAGES := lm_sector_draw_line lm_sar_draw_line lm_sector_sample_ahead lm_sar_sample_ahead lm_scan_conv_sector \
    lm_scan_conv_patch lm_line_trace lm_line_add_targets lm_scan_line_run lm_foreground_line_horizon lm_illuminate \
    lm_antenna_pattern_apply lm_grain_floor_run lm_patch_floor_run lm_receiver_run lm_grain_powers lm_layover_run \
    lm_defocus_run lm_beam_sum lm_tone_run lm_sar_prefetch lm_scan_line_prefetch lm_tile_cache_service lm_show_frame \
    lm_composer_run lm_overlay_symbols lm_overlay_labels lm_nav_take lm_nav_at lm_tile_unpack_run lm_lz4_run lm_tile_check \
    lm_track_step lm_beacon_sample lm_side_lobes_find lm_side_lobes_add lm_foreground_horizon \
    lm_target_patch_set lm_target_patch_add_scatterers lm_target_patch_mark_hidden lm_detail_patch_draw lm_sea_run \
    lm_azimuth_average_begin lm_azimuth_average_add lm_azimuth_average_mean lm_slant_run lm_geo_set_origin \
    lm_geo_set_ray lm_geo_along lm_ground_path_fit lm_receiver_pulse lm_receiver_join \
    lm_sector_floor_run lm_weather_line lm_beam_set_taps lm_beam_steady_sum lm_class_gain_look lm_sea_look \
    lm_sar_load_detail lm_target_candidates_refresh lm_dbs_scallop_q16 lm_dbs_sharpening_q8 lm_beam_next_missing
$(O)/stages.o: tests/zcu102/images/stages.sh tests/zcu102/images/stage.inc tests/zcu102/images/images.mk $(LIB_firmware)
	@{ cat tests/zcu102/images/stage.inc; sh $< "stage " $(LIB_firmware) $(NM) $(STAGES); echo stages_end; } >$(@:.o=.s)
	$(Q)$(CC) $(OPT) -c $(@:.o=.s) -o $@
$(O)/stages.wrap: tests/zcu102/images/stages.sh tests/zcu102/images/images.mk $(LIB_firmware)
	@sh $< --wrap= $(LIB_firmware) $(NM) $(STAGES) >$@
endif
