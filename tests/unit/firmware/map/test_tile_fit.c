/* A tile of one image of several takes what its classes gain more than the view's, and nothing else
 * of it changes. */
#include "lm/tile_fit.h"

#include "check.h"
#include "tiny_image.h"

#include <stdlib.h>
#include <string.h>

enum { OWN_LOD = 1, LOD = 4, PARTS = 6, ROWS_A_PART = 11 };

/* By class, 1/256 dB, and what that is in codes of 1/2 dB. Class 15 has no data and no gain. */
static const int16_t more_db_q8[LM_DB_CLASSES] = {0,   63,   64,  -64, -65,   1000, -1000, 128,
                                                  127, 9000, 191, 192, -9000, 300,  5,     4000};
static const int codes[LM_DB_CLASSES] = {0, 0, 1, 0, -1, 8, -8, 1, 1, 70, 1, 2, -70, 2, 0, 0};

struct fixture {
    struct lm_tile tile, before;
    struct lm_classes own, view;
    struct lm_tile_fit fit;
};

static struct fixture *make(void)
{
    struct fixture *f = calloc(1, sizeof *f);
    for (uint32_t i = 0; i < LM_DB_CLASSES; i++) {
        for (int lod = 0; lod < LM_DB_LODS_MAX; lod++) { /* those of other LODs mislead */
            f->own.entry[i].lod_gain_db_q8[lod] = (int16_t)(700 - 100 * lod);
            f->view.entry[i].lod_gain_db_q8[lod] = (int16_t)(-500 + 300 * lod);
        }
        f->view.entry[i].lod_gain_db_q8[LOD] = -40;
        f->own.entry[i].lod_gain_db_q8[OWN_LOD] = (int16_t)(more_db_q8[i] - 40);
    }
    for (uint32_t i = 0; i < LM_TILE_POINTS * LM_TILE_POINTS; i++) {
        f->tile.points[i / LM_TILE_POINTS][i % LM_TILE_POINTS] =
            (struct lm_tile_point){(uint16_t)(i * 40503u >> 3), (uint16_t)(i * 7)};
    }
    f->before = f->tile;
    return f;
}

static uint32_t fitted(uint32_t cell)
{
    const int code = (int)(cell >> 8) + codes[cell >> 4 & 15];
    return (uint32_t)(code < 0 ? 0 : code > 255 ? 255 : code) << 8 | (cell & 255);
}

/* Rows below `rows` are fitted, and no other bit of the tile is touched. */
static void compare(const struct fixture *f, uint32_t rows)
{
    struct lm_tile wanted = f->before;
    for (uint32_t r = 0; r < rows; r++) {
        for (uint32_t c = 0; c < LM_TILE_POINTS; c++) {
            wanted.points[r][c].cell = (uint16_t)fitted(f->before.points[r][c].cell);
        }
    }
    assert_memory_equal(&f->tile, &wanted, sizeof wanted);
}

TEST(every_cell_takes_the_difference_of_its_class_eleven_rows_a_part)
{
    struct fixture *f = make();
    assert_int_equal(lm_tile_fit_begin(&f->fit, &f->tile, &f->own, OWN_LOD, &f->view, LOD),
                     LM_BUSY);
    for (uint32_t part = 1; part <= PARTS; part++) {
        const int status = lm_tile_fit_run(&f->fit);
        assert_int_equal(status, part < PARTS ? LM_BUSY : LM_OK);
        compare(f, part * ROWS_A_PART);
    }
    free(f);
}

TEST(nothing_is_to_be_done_where_gains_are_within_a_quarter_of_a_decibel)
{
    struct fixture *f = make();
    for (uint32_t i = 0; i < LM_DB_CLASS_NONE; i++) {
        f->own.entry[i].lod_gain_db_q8[OWN_LOD] = (int16_t)(-40 + (i % 2 ? 63 : -64));
    }
    assert_int_equal(lm_tile_fit_begin(&f->fit, &f->tile, &f->own, OWN_LOD, &f->view, LOD), LM_OK);
    f->own.entry[LM_DB_CLASS_NONE - 1].lod_gain_db_q8[OWN_LOD] = -105;
    assert_int_equal(lm_tile_fit_begin(&f->fit, &f->tile, &f->own, OWN_LOD, &f->view, LOD),
                     LM_BUSY);
    free(f);
}

TEST(each_class_may_be_the_only_one_that_differs)
{
    for (uint32_t i = 0; i < LM_DB_CLASS_NONE; i++) {
        struct fixture *f = make();
        for (uint32_t k = 0; k < LM_DB_CLASS_NONE; k++) {
            f->own.entry[k].lod_gain_db_q8[OWN_LOD] = (int16_t)(-40 + (k == i ? 1280 : 0));
        }
        f->tile.points[0][0].cell = (uint16_t)(100u << 8 | i << 4);
        assert_int_equal(lm_tile_fit_begin(&f->fit, &f->tile, &f->own, OWN_LOD, &f->view, LOD),
                         LM_BUSY);
        (void)lm_tile_fit_run(&f->fit);
        assert_int_equal(f->tile.points[0][0].cell, 110u << 8 | i << 4); /* 5 dB: ten codes */
        free(f);
    }
}
