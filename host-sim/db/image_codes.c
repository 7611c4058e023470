#include "image_codes.h"

#include <math.h>

const uint16_t image_heights_dm[16] = {0,   20,  30,  40,  50,  60,  80,  100,
                                       120, 150, 180, 220, 270, 350, 500, 800};

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

static uint8_t commonest_class(const uint16_t cell[4])
{
    uint8_t best = LM_DB_CLASS_NONE;
    int best_count = 0;
    for (int i = 0; i < 4; i++) {
        const uint8_t c = image_cell_class(cell[i]);
        int count = 0;
        for (int j = 0; j < 4; j++) {
            count += image_cell_class(cell[j]) == c;
        }
        const bool wins = count > best_count || (count == best_count && c < best);
        if (c != LM_DB_CLASS_NONE && wins) {
            best = c;
            best_count = count;
        }
    }
    return best;
}

static uint16_t reduce_four(const uint16_t cell[4], const double power[256],
                            const uint16_t heights_dm[16])
{
    const uint8_t class_number = commonest_class(cell);
    if (class_number == LM_DB_CLASS_NONE) {
        return IMAGE_CELL_NONE;
    }
    double power_sum = 0.0, height_sum = 0.0;
    int data_count = 0, class_count = 0;
    for (int i = 0; i < 4; i++) {
        const uint8_t c = image_cell_class(cell[i]);
        if (c != LM_DB_CLASS_NONE) {
            power_sum += power[image_cell_gamma(cell[i])];
            data_count++;
        }
        if (c == class_number) {
            height_sum += heights_dm[image_cell_height(cell[i])];
            class_count++;
        }
    }
    const uint8_t gamma = image_gamma_code(10.0 * log10(power_sum / data_count));
    const uint8_t height = image_height_code(heights_dm, height_sum / class_count);
    return image_cell(gamma, class_number, height);
}

void image_reduce(const uint16_t *fine, size_t fine_stride, uint16_t *coarse, size_t coarse_stride,
                  int coarse_side, const uint16_t heights_dm[16])
{
    double power[256];
    for (int i = 0; i < 256; i++) {
        power[i] = pow(10.0, image_gamma_db((uint8_t)i) / 10.0);
    }
    for (int r = 0; r < coarse_side; r++) {
        for (int c = 0; c < coarse_side; c++) {
            const uint16_t *f = fine + 2 * (size_t)r * fine_stride + 2 * (size_t)c;
            const uint16_t four[4] = {f[0], f[1], f[fine_stride], f[fine_stride + 1]};
            const bool are_equal = four[0] == four[1] && four[0] == four[2] && four[0] == four[3];
            coarse[(size_t)r * coarse_stride + (size_t)c] =
                are_equal ? four[0] : reduce_four(four, power, heights_dm);
        }
    }
}

static int32_t floor_to(int32_t value, int shift)
{
    return (value >> shift) * (1 << shift);
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
    tile->base_q6 = floor_to(low, shift);
    tile->post_shift = (uint8_t)shift;
    for (int r = 0; r < LM_TILE_POSTS; r++) {
        for (int c = 0; c < LM_TILE_POSTS; c++) {
            const int32_t above = posts_q6[r][c] - tile->base_q6;
            tile->posts[r][c] = (uint16_t)((above + (1 << shift) / 2) >> shift);
        }
    }
}
