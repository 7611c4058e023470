#include "patch_rig.h"

int patch_rig_open(struct patch_rig *r, const uint8_t *image, size_t image_bytes,
                   memory_flash_fetch *fetch, void *pool, uint8_t *pixels)
{
    memory_flash_open(&r->flash, image, image_bytes);
    r->flash.fetch = fetch;
    r->plane =
        (struct lm_plane){.pixels = pixels, .width_px = PATCH_RIG_PX, .height_px = PATCH_RIG_PX};
    r->frame = lm_frame_of_display(PATCH_RIG_PX, PATCH_RIG_PX);
    int status = lm_db_open(&r->db, &r->flash.port, 10);
    if (status == LM_OK) {
        status = lm_tile_cache_init(&r->tiles, &r->db, pool,
                                    PATCH_RIG_TILES * sizeof(struct lm_tile), 10);
    }
    if (status == LM_OK) {
        status = lm_signature_read(&r->db, 0, &r->signature, 10);
    }
    return status == LM_OK ? lm_tone_set(&r->tone, &lm_radar_default.sar.tone) : status;
}

void patch_rig_make_resident(struct patch_rig *r)
{
    bool is_idle = false;
    for (int i = 0; i < 100000 && !is_idle; i++) {
        lm_chips_service(&r->chips, &r->tiles);
        lm_tile_cache_service(&r->tiles, 0, 1);
        is_idle = lm_tile_cache_is_idle(&r->tiles) && lm_chips_are_settled(&r->chips);
    }
}

int patch_rig_begin(struct patch_rig *r, const struct lm_target_set *targets, uint32_t cell_mm)
{
    struct lm_sar *sar = &r->sar;
    const struct lm_sar_setup scene = {.targets = targets,
                                       .chips = &r->chips,
                                       .relief = {.reference_m_q10 = 60 * 1024},
                                       .sea_state = LM_SEA_STATE_OF_IMAGE};
    const struct lm_sar_command command = {
        .centre = {r->db.centre_latitude, r->db.centre_longitude},
        .cell_mm = cell_mm,
        .look_azimuth = FX_BAM_DEG(37),
        .range_m = 20000,
        .height_m_q6 = 3000 * 64,
    };
    const int status = lm_sar_start(sar, &lm_radar_default, &r->db, &command, &scene);
    if (status != LM_OK) {
        return status;
    }
    const struct lm_patch_fan fan = {.lines = sar->lines,
                                     .cells = lm_radar_default.sar.cells,
                                     .centre_m_q8 = sar->geometry.centre_m_q8,
                                     .cell_m_q8 = sar->geometry.cell_m_q8};
    lm_patch_painter_set(&r->painter, &r->frame, &fan);
    for (uint32_t line = 0; line < sar->lines; line += 8) {
        lm_sar_prefetch(sar, &r->tiles, line);
        patch_rig_make_resident(r);
    }
    lm_sar_prefetch_targets(sar, &r->tiles);
    patch_rig_make_resident(r);
    return LM_OK;
}

void patch_rig_draw(struct patch_rig *r, bool paints)
{
    while (r->sar.line < r->sar.lines) {
        lm_sar_draw_line(&r->sar, &r->tiles, &r->tone, &r->line);
        if (paints) {
            lm_scan_conv_patch(&r->painter, &r->plane, r->sar.line - 1, r->line.grey);
        }
    }
}
