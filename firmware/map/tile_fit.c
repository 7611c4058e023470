#include "lm/tile_fit.h"

enum { ROWS_A_PART = 11 };
_Static_assert(LM_TILE_POINTS % ROWS_A_PART == 0, "all parts are as long");

int lm_tile_fit_begin(struct lm_tile_fit *f, struct lm_tile *tile, const struct lm_classes *own,
                      uint8_t own_lod, const struct lm_classes *view, uint8_t lod)
{
    uint32_t differ = 0;
    *f = (struct lm_tile_fit){.tile = tile};
    for (uint32_t i = 0; i < LM_DB_CLASS_NONE; i++) {
        const int32_t more_db_q8 =
            own->entry[i].lod_gain_db_q8[own_lod] - view->entry[i].lod_gain_db_q8[lod];
        f->codes[i] = (int16_t)lm_gamma_codes_of(more_db_q8);
        differ += f->codes[i] != 0;
    }
    return differ != 0 ? LM_BUSY : LM_OK;
}

int lm_tile_fit_run(struct lm_tile_fit *f)
{
    struct lm_tile_point(*points)[LM_TILE_POINTS] = f->tile->points;
    for (uint32_t i = 0; i < ROWS_A_PART; i++, f->row++) {
        for (uint32_t column = 0; column < LM_TILE_POINTS; column++) {
            uint16_t *cell = &points[f->row][column].cell;
            *cell = lm_cell_brightened(*cell, f->codes[*cell >> 4 & 15]);
        }
    }
    return f->row < LM_TILE_POINTS ? LM_BUSY : LM_OK;
}
