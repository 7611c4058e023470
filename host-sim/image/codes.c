#include "image/codes.h"

#include "hs/report.h"
#include <math.h>
#include <pthread.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

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
    double least = fabs(table_dm[0] - height_dm);
    int best = 0;
    for (int i = 1; i < 16 && least > 0; i++) { /* most ground has no height, which comes first */
        const double apart = fabs(table_dm[i] - height_dm);
        best = apart < least ? i : best;
        least = apart < least ? apart : least;
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

void image_heights_report(const uint16_t table_dm[16])
{
    hs_report_array("heights_m");
    for (int i = 0; i < 16; i++) {
        hs_report_put(NULL, table_dm[i] / 10.0);
    }
    hs_report_close();
}

enum { FALL = 12 }; /* codes that a quarter of a power lies below it: 6 dB */

/* Powers of the reflectivity codes, and where each code begins, FALL zeros before them. */
struct powers {
    double of_code[256], least[FALL + 256];
};

static struct powers powers;
static pthread_once_t powers_once = PTHREAD_ONCE_INIT;

static void set_powers(void)
{
    for (int i = 0; i < 256; i++) {
        const double db = image_gamma_db((uint8_t)i);
        powers.of_code[i] = pow(10.0, db / 10.0);
        powers.least[FALL + i] = i > 0 ? pow(10.0, (db - 0.25) / 10.0) : 0.0;
    }
}

/* The code of a power that is that of code `high` at most and a quarter of it at least. Beside the
 * beginning of a code the logarithm decides, which need not be exact. */
static uint8_t code_of_power(double power, uint8_t high)
{
    static const double close = 1e-9;
    const double *least = &powers.least[high + 1];
    int below = 0;
    for (int i = 0; i < FALL; i++) {
        below += power < least[i];
    }
    const int code = high - below;
    const bool is_sure = power > powers.least[FALL + code] * (1 + close) &&
                         (code == 255 || power < powers.least[FALL + code + 1] * (1 - close));
    return is_sure ? (uint8_t)code : image_gamma_code(10.0 * log10(power));
}

/* What the rule of coarser cells asks of the class table. */
struct rule {
    const uint16_t *heights_dm;
    double least_built;           /* share of the power from which structures win the cell */
    const double *power;          /* of the reflectivity codes */
    uint8_t group[LM_DB_CLASSES]; /* of a class: the lowest number of those that differ in their
                                   * facing alone */
    bool stands[LM_DB_CLASSES];   /* it is a class of structures */
    uint8_t same_height[16];      /* the lowest code of the same height */
};

static void set_rule(struct rule *rule, const struct lm_classes *classes, enum image_vote vote)
{
    rule->heights_dm = classes->height_dm;
    rule->least_built = vote == IMAGE_VOTE_POWER ? IMAGE_BUILT_SHARE : 1;
    pthread_once(&powers_once, set_powers);
    rule->power = powers.of_code;
    for (int k = 0; k < LM_DB_CLASSES; k++) {
        const struct lm_class *c = &classes->entry[k];
        int first = c->facing == 0 ? k : 0;
        while (first < k && (classes->entry[first].kind != c->kind ||
                             memcmp(classes->entry[first].name, c->name, sizeof c->name) != 0)) {
            first++;
        }
        rule->group[k] = (uint8_t)first;
        rule->stands[k] = c->kind == LM_KIND_STRUCTURE && k != LM_DB_CLASS_NONE;
    }
    for (int i = 0; i < 16; i++) {
        rule->same_height[i] = image_height_code(rule->heights_dm, rule->heights_dm[i]);
    }
}

/* Sums over the cells that become one. */
struct sums {
    int count[LM_DB_CLASSES], of_group[LM_DB_CLASSES];
    double height_dm[LM_DB_CLASSES]; /* of groups */
    double power, structures;        /* of the cells with data; of those of structures */
};

static void add_cell(struct sums *s, uint16_t cell, const struct rule *rule)
{
    const uint8_t k = image_cell_class(cell);
    const double power = k == LM_DB_CLASS_NONE ? 0.0 : rule->power[image_cell_gamma(cell)];
    s->count[k]++;
    s->of_group[rule->group[k]]++;
    s->height_dm[rule->group[k]] += rule->heights_dm[image_cell_height(cell)];
    s->power += power;
    s->structures += rule->stands[k] ? power : 0.0;
}

static uint16_t cell_of_sums(const struct sums *s, const struct rule *rule)
{
    const bool is_built = s->structures > s->power * rule->least_built;
    int best = -1, count = 0; /* a group */
    for (int k = 0; k < LM_DB_CLASS_NONE; k++) {
        const bool may_win = s->of_group[k] > 0 && (!is_built || rule->stands[k]);
        best = may_win && (best < 0 || s->of_group[k] > s->of_group[best]) ? k : best;
        count += s->count[k];
    }
    if (count == 0) {
        return IMAGE_CELL_NONE;
    }
    int facing = best;
    for (int k = 0; k < LM_DB_CLASS_NONE; k++) {
        facing = rule->group[k] == best && s->count[k] > s->count[facing] ? k : facing;
    }
    const uint8_t gamma = image_gamma_code(10.0 * log10(s->power / count));
    const uint8_t height =
        image_height_code(rule->heights_dm, s->height_dm[best] / s->of_group[best]);
    return image_cell(gamma, (uint8_t)facing, height);
}

/* Of four cells that differ in their reflectivity alone, which is what most ground is. */
static uint16_t cell_of_like(const uint16_t cells[4], const struct rule *rule)
{
    double power = 0;
    uint8_t high = 0;
    for (int i = 0; i < 4; i++) {
        const uint8_t gamma = image_cell_gamma(cells[i]);
        power += rule->power[gamma];
        high = gamma > high ? gamma : high;
    }
    return image_cell(code_of_power(power / 4, high), image_cell_class(cells[0]),
                      rule->same_height[image_cell_height(cells[0])]);
}

static uint16_t reduce_block(const uint16_t *fine, size_t stride, int factor,
                             const struct rule *rule)
{
    bool are_equal = true;
    for (int r = 0; r < factor; r++) {
        for (int c = 0; c < factor; c++) {
            are_equal = are_equal && fine[(size_t)r * stride + (size_t)c] == fine[0];
        }
    }
    if (are_equal) {
        return fine[0];
    }
    struct sums sums = {0};
    for (int r = 0; r < factor; r++) {
        for (int c = 0; c < factor; c++) {
            add_cell(&sums, fine[(size_t)r * stride + (size_t)c], rule);
        }
    }
    return cell_of_sums(&sums, rule);
}

/* `fine` is the south-western of four cells. */
static uint16_t reduce_four(const uint16_t *fine, size_t stride, const struct rule *rule)
{
    const uint16_t cells[4] = {fine[0], fine[1], fine[stride], fine[stride + 1]};
    const int differ = (cells[0] ^ cells[1]) | (cells[0] ^ cells[2]) | (cells[0] ^ cells[3]);
    if (differ == 0) {
        return cells[0];
    }
    const bool are_like = (differ & 255) == 0 && image_cell_class(cells[0]) != LM_DB_CLASS_NONE;
    return are_like ? cell_of_like(cells, rule) : reduce_block(fine, stride, 2, rule);
}

void image_reduce(const struct image_reduction *how, const uint16_t *fine, size_t fine_stride,
                  uint16_t *coarse, size_t coarse_stride)
{
    struct rule rule;
    set_rule(&rule, how->classes, how->vote);
    for (int r = 0; r < how->side; r++) {
        for (int c = 0; c < how->side; c++) {
            const size_t from = (size_t)(how->factor * r) * fine_stride + (size_t)(how->factor * c);
            coarse[(size_t)r * coarse_stride + (size_t)c] =
                how->factor == 2 ? reduce_four(fine + from, fine_stride, &rule)
                                 : reduce_block(fine + from, fine_stride, how->factor, &rule);
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

void image_posts_decode(const struct lm_tile *tile, int32_t posts_q6[LM_TILE_POSTS][LM_TILE_POSTS])
{
    for (int r = 0; r < LM_TILE_POSTS; r++) {
        for (int c = 0; c < LM_TILE_POSTS; c++) {
            posts_q6[r][c] = (int32_t)image_post_q6(tile, r, c);
        }
    }
}

/* The post at a row and column of the four tiles below, 0..128; NULL where none has it. Tiles that
 * share an edge have the same posts there. */
static const int32_t *post_below(const int32_t (*const below[4])[LM_TILE_POSTS], int row,
                                 int column)
{
    for (int i = 0; i < 4; i++) {
        const int r = row - i / 2 * LM_TILE_CELLS, c = column - i % 2 * LM_TILE_CELLS;
        if (below[i] && r >= 0 && r <= LM_TILE_CELLS && c >= 0 && c <= LM_TILE_CELLS) {
            return &below[i][r][c];
        }
    }
    return NULL;
}

/* The mean of the nine posts around one, or `otherwise` if one is missing. */
static int32_t mean_of_nine(const int32_t (*const below[4])[LM_TILE_POSTS], int row, int column,
                            int32_t otherwise)
{
    int64_t sum = 8; /* half of the weights: rounds */
    for (int i = -1; i <= 1; i++) {
        for (int k = -1; k <= 1; k++) {
            const int32_t *post = post_below(below, row + i, column + k);
            if (!post) {
                return otherwise;
            }
            sum += (int64_t)*post * (2 - abs(i)) * (2 - abs(k));
        }
    }
    return (int32_t)(sum >> 4);
}

/* The same around every second post of one tile, its edges apart, for a quarter of what is above.
 */
static void smooth_quarter(const int32_t below[LM_TILE_POSTS][LM_TILE_POSTS],
                           int32_t posts_q6[LM_TILE_POSTS][LM_TILE_POSTS], int row0, int column0)
{
    for (int r = 1; r < LM_TILE_CELLS / 2; r++) {
        int64_t sums[LM_TILE_POSTS];
        for (int c = 0; c < LM_TILE_POSTS; c++) {
            sums[c] =
                (int64_t)below[2 * r - 1][c] + 2 * (int64_t)below[2 * r][c] + below[2 * r + 1][c];
        }
        for (int c = 1; c < LM_TILE_CELLS / 2; c++) {
            const int64_t sum = 8 + sums[2 * c - 1] + 2 * sums[2 * c] + sums[2 * c + 1];
            posts_q6[row0 + r][column0 + c] = (int32_t)(sum >> 4);
        }
    }
}

void image_posts_smooth(const int32_t (*const below[4])[LM_TILE_POSTS],
                        int32_t posts_q6[LM_TILE_POSTS][LM_TILE_POSTS])
{
    enum { HALF = LM_TILE_CELLS / 2 };
    for (int i = 0; i < 4; i++) {
        if (below[i]) {
            smooth_quarter(below[i], posts_q6, i / 2 * HALF, i % 2 * HALF);
        }
    }
    for (int i = 1; i < LM_TILE_CELLS; i++) { /* between the four */
        posts_q6[HALF][i] = mean_of_nine(below, LM_TILE_CELLS, 2 * i, posts_q6[HALF][i]);
        if (i != HALF) {
            posts_q6[i][HALF] = mean_of_nine(below, 2 * i, LM_TILE_CELLS, posts_q6[i][HALF]);
        }
    }
}
