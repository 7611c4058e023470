#include "image/codes.h"

#include <math.h>
#include <stdio.h>

uint8_t image_gamma_code(double gamma_db)
{
    const double code = floor((gamma_db + 80.0) * 2.0 + 0.5);
    return (uint8_t)(code < 0.0 ? 0.0 : code > 255.0 ? 255.0 : code);
}

double image_gamma_db(uint8_t code)
{
    return code / 2.0 - 80.0;
}

uint8_t image_height_code(const uint16_t table_dm[16], double height_dm)
{
    int best = 0;
    for (int i = 1; i < 16; i++) {
        if (fabs(table_dm[i] - height_dm) < fabs(table_dm[best] - height_dm)) {
            best = i;
        }
    }
    return (uint8_t)best;
}

void image_heights_text(const uint16_t table_dm[16], char *text, size_t room)
{
    size_t used = 0;
    for (int i = 0; i < 16 && used < room; i++) {
        used += (size_t)snprintf(text + used, room - used, " %g", table_dm[i] / 10.0);
    }
}

/* Sums over the cells that become one. */
struct sums {
    int count[LM_DB_CLASSES];
    double height_dm[LM_DB_CLASSES];
    double power; /* of the cells with data */
};

static void add_cell(struct sums *s, uint16_t cell, const double power[256],
                     const uint16_t heights_dm[16])
{
    const uint8_t k = image_cell_class(cell);
    s->count[k]++;
    s->height_dm[k] += heights_dm[image_cell_height(cell)];
    s->power += k == LM_DB_CLASS_NONE ? 0.0 : power[image_cell_gamma(cell)];
}

static uint16_t cell_of_sums(const struct sums *s, const uint16_t heights_dm[16])
{
    int best = 0, count = 0;
    for (int k = 0; k < LM_DB_CLASS_NONE; k++) {
        best = s->count[k] > s->count[best] ? k : best;
        count += s->count[k];
    }
    if (count == 0) {
        return IMAGE_CELL_NONE;
    }
    const uint8_t gamma = image_gamma_code(10.0 * log10(s->power / count));
    const uint8_t height = image_height_code(heights_dm, s->height_dm[best] / s->count[best]);
    return image_cell(gamma, (uint8_t)best, height);
}

static uint16_t reduce_block(const uint16_t *fine, size_t stride, int factor,
                             const double power[256], const uint16_t heights_dm[16])
{
    struct sums sums = {0};
    bool are_equal = true;
    for (int r = 0; r < factor; r++) {
        for (int c = 0; c < factor; c++) {
            are_equal = are_equal && fine[(size_t)r * stride + (size_t)c] == fine[0];
        }
    }
    if (are_equal) {
        return fine[0];
    }
    for (int r = 0; r < factor; r++) {
        for (int c = 0; c < factor; c++) {
            add_cell(&sums, fine[(size_t)r * stride + (size_t)c], power, heights_dm);
        }
    }
    return cell_of_sums(&sums, heights_dm);
}

void image_reduce(const uint16_t *fine, size_t fine_stride, int factor, uint16_t *coarse,
                  size_t coarse_stride, int coarse_side, const uint16_t heights_dm[16])
{
    double power[256];
    for (int i = 0; i < 256; i++) {
        power[i] = pow(10.0, image_gamma_db((uint8_t)i) / 10.0);
    }
    for (int r = 0; r < coarse_side; r++) {
        for (int c = 0; c < coarse_side; c++) {
            const size_t from = (size_t)(factor * r) * fine_stride + (size_t)(factor * c);
            coarse[(size_t)r * coarse_stride + (size_t)c] =
                reduce_block(fine + from, fine_stride, factor, power, heights_dm);
        }
    }
}

static int32_t floor_to(int32_t value, int shift)
{
    return (value >> shift) * (1 << shift);
}

void image_cells_encode(uint16_t cells[LM_TILE_CELLS][LM_TILE_CELLS], struct lm_tile *tile)
{
    for (int i = 0; i < LM_TILE_CELLS * LM_TILE_CELLS; i++) {
        const int r = i / LM_TILE_CELLS, c = i % LM_TILE_CELLS;
        tile->points[r + LM_TILE_BORDER][c + LM_TILE_BORDER].cell = cells[r][c];
    }
}

void image_cells_decode(const struct lm_tile *tile, uint16_t cells[LM_TILE_CELLS][LM_TILE_CELLS])
{
    for (int i = 0; i < LM_TILE_CELLS * LM_TILE_CELLS; i++) {
        const int r = i / LM_TILE_CELLS, c = i % LM_TILE_CELLS;
        cells[r][c] = image_tile_cell(tile, r, c);
    }
}

void image_posts_encode(const int32_t posts_q6[LM_TILE_POSTS][LM_TILE_POSTS], struct lm_tile *tile)
{
    int32_t low = posts_q6[0][0], high = low;
    for (int r = 0; r < LM_TILE_POSTS; r++) {
        for (int c = 0; c < LM_TILE_POSTS; c++) {
            low = posts_q6[r][c] < low ? posts_q6[r][c] : low;
            high = posts_q6[r][c] > high ? posts_q6[r][c] : high;
        }
    }
    int shift = 0;
    while ((high - floor_to(low, shift) + (1 << shift) / 2) >> shift > UINT16_MAX) {
        shift++;
    }
    tile->base_m_q6 = floor_to(low, shift);
    tile->post_shift = (uint8_t)shift;
    for (int r = 0; r < LM_TILE_POSTS; r++) {
        for (int c = 0; c < LM_TILE_POSTS; c++) {
            const int32_t above = posts_q6[r][c] - tile->base_m_q6;
            tile->points[r + LM_TILE_BORDER][c + LM_TILE_BORDER].post =
                (uint16_t)((above + (1 << shift) / 2) >> shift);
        }
    }
}
