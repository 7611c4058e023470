#include "verify_parts.h"

#include "hs/team.h"
#include "image/codes.h"
#include "image/ground.h"

#include <inttypes.h>
#include <stdbool.h>
#include <stdlib.h>

static const char no_memory[] = "not enough memory to check the levels below it";

/* A tile of the pyramid, as it is made from those below it. */
struct rung {
    struct rung *next;   /* of the spare ones */
    struct lm_tile tile; /* a copy: the reader keeps only so many */
    uint32_t number;     /* of its entry */
    struct image_ground ground;
};

/* A tile as it should be, while it is compared. */
struct scratch {
    struct lm_tile encoded;                         /* its cells */
    int32_t posts_q6[LM_TILE_POSTS][LM_TILE_POSTS]; /* its posts */
    int32_t fine[4][LM_TILE_POSTS][LM_TILE_POSTS];  /* those below */
};

/* Do the posts of a quarter fit those below it? */
static bool posts_fit(const struct rung *made, const struct scratch *wanted,
                      const struct lm_tile *below, int quarter)
{
    enum { HALF = LM_TILE_CELLS / 2 };
    const int row = quarter / 2 * HALF, column = quarter % 2 * HALF;
    const int64_t step = coarser_step(&made->tile, below);
    for (int r = 0; r <= HALF; r++) {
        for (int c = 0; c <= HALF; c++) {
            const int64_t difference = image_post_q6(&made->tile, row + r, column + c) -
                                       wanted->posts_q6[row + r][column + c];
            if (difference < -step || difference > step) {
                return false;
            }
        }
    }
    return true;
}

/* Posts of a tile made again from those below it: every second one, smoothed. */
static void make_posts(struct scratch *wanted, const struct lm_tile *tile,
                       struct rung *const below[4])
{
    enum { HALF = LM_TILE_CELLS / 2 };
    const int32_t(*posts[4])[LM_TILE_POSTS] = {NULL, NULL, NULL, NULL};
    image_posts_decode(tile, wanted->posts_q6);
    for (int i = 0; i < 4; i++) {
        if (!below[i]) {
            continue;
        }
        image_posts_decode(&below[i]->tile, wanted->fine[i]);
        posts[i] = (const int32_t(*)[LM_TILE_POSTS])wanted->fine[i];
        for (int r = 0; r <= HALF; r++) {
            for (int c = 0; c <= HALF; c++) {
                wanted->posts_q6[i / 2 * HALF + r][i % 2 * HALF + c] =
                    wanted->fine[i][2 * r][2 * c];
            }
        }
    }
    image_posts_smooth(posts, wanted->posts_q6);
}

static bool cells_fit(const struct rung *made, const struct lm_tile *encoded, int quarter)
{
    enum { HALF = LM_TILE_CELLS / 2 };
    const int row = quarter / 2 * HALF, column = quarter % 2 * HALF;
    for (int i = 0; i < HALF * HALF; i++) {
        const int r = row + i / HALF, c = column + i % HALF;
        if (image_tile_cell(&made->tile, r, c) != image_tile_cell(encoded, r, c)) {
            return false;
        }
    }
    return true;
}

/* They are large: the system would take and give their memory for each tile. */
static struct rung *rung_new(struct verify *v)
{
    struct rung *made = v->spare;
    if (!made) {
        return malloc(sizeof *made);
    }
    v->spare = made->next;
    return made;
}

/* `made` may be NULL. */
static void rung_put_back(struct verify *v, struct rung *made)
{
    if (made) {
        made->next = v->spare;
        v->spare = made;
    }
}

static void free_spare(struct verify *v)
{
    while (v->spare) {
        struct rung *next = v->spare->next;
        free(v->spare);
        v->spare = next;
    }
}

static int climb_entry(struct verify *v, int64_t entry, struct rung **out);

/* Make a tile again from the four below it, and compare. */
static void check_below(struct verify *v, struct rung *made, struct rung *const below[4])
{
    const struct lm_classes *classes = &v->image->db.classes;
    struct scratch *wanted = v->scratch;
    for (int i = 0; i < 4; i++) {
        if (below[i]) {
            image_ground_take(&made->ground, &made->tile, &below[i]->ground, i, classes);
        }
    }
    wanted->encoded = made->tile;
    image_ground_encode(&made->ground, &wanted->encoded, classes->height_dm);
    make_posts(wanted, &made->tile, below);
    for (int i = 0; i < 4; i++) {
        if (!below[i]) {
            continue;
        }
        v->counts->children++;
        if (!posts_fit(made, wanted, &below[i]->tile, i) || !cells_fit(made, &wanted->encoded, i)) {
            image_find(v->findings, image_record_offset(v->image, below[i]->number),
                       "tile of entry %" PRIu32 ": the tile above it does not hold its mean",
                       below[i]->number);
        }
    }
}

static int climb_to(struct verify *v, struct rung *made)
{
    const struct lm_tile *t = &made->tile;
    struct rung *below[4] = {NULL, NULL, NULL, NULL};
    int result = 0;
    image_cells_decode(t, made->ground.cells);
    for (int i = 0; i < 4 && result == 0 && t->lod > 0; i++) {
        const uint32_t row = 2 * t->row + (uint32_t)(i / 2),
                       column = 2 * t->column + (uint32_t)(i % 2);
        result = climb_entry(v, lm_db_entry(&v->image->db, (uint8_t)(t->lod - 1), row, column),
                             &below[i]);
    }
    if (!below[0] || !below[1] || !below[2] || !below[3]) { /* else all of it is made of them */
        image_ground_init(&made->ground, t);
    }
    if (result == 0 && (below[0] || below[1] || below[2] || below[3])) {
        check_below(v, made, below);
    }
    for (int i = 0; i < 4; i++) {
        rung_put_back(v, below[i]);
    }
    return result;
}

/* A tree: a tile and all below it, checked by one thread. */
struct tree {
    uint32_t entry;
    int status;       /* of climb */
    struct rung *top; /* owned until it is told; NULL where nothing is made of it */
    struct verify_part part;
};

struct trees {
    struct verify *v;
    struct tree *items; /* owned; by their entries */
    uint32_t count;
    bool are_tops; /* of the coarsest level, so that nothing is made of them */
};

static int by_entry(const void *a, const void *b)
{
    const struct tree *x = a, *y = b;
    return (x->entry > y->entry) - (x->entry < y->entry);
}

static struct tree *find_tree(const struct trees *trees, uint32_t entry)
{
    const struct tree key = {.entry = entry};
    return trees ? bsearch(&key, trees->items, trees->count, sizeof key, by_entry) : NULL;
}

/* What came of a tree, in the order in which one thread would have found it. */
static int tell_tree(struct verify *v, struct tree *tree, struct rung **out)
{
    verify_part_tell(v, &tree->part);
    *out = tree->top;
    tree->top = NULL;
    return tree->status;
}

/* Check the tile of an entry, -1 for none, and all below it. *out is the caller's to put back, NULL
 * without a sound tile. Returns 0, or -1 without memory. */
static int climb_entry(struct verify *v, int64_t entry, struct rung **out)
{
    *out = NULL;
    if (entry < 0 || v->sound[entry] == 0) {
        return 0;
    }
    struct tree *tree = find_tree(v->trees, (uint32_t)entry);
    if (tree) {
        return tell_tree(v, tree, out);
    }
    struct rung *made = rung_new(v);
    if (!made) {
        return -1;
    }
    (void)image_copy_tile(v->image, (uint32_t)entry, &made->tile); /* it is there: it is sound */
    made->number = (uint32_t)entry;
    *out = made;
    return climb_to(v, made);
}

/* ---- trees ---- */

/* So many at most, for each keeps its top until what is above it is made: 6 MB. */
enum { TREES_MAX = 64 };

static void *begin_trees(void *ctx)
{
    struct verify *worker = malloc(sizeof *worker);
    struct scratch *scratch = malloc(sizeof *scratch);
    if (!worker || !scratch) {
        free(worker);
        free(scratch);
        return NULL;
    }
    *worker = *((struct trees *)ctx)->v;
    worker->scratch = scratch;
    return worker;
}

static void check_tree(void *ctx, void *own, uint32_t part)
{
    const struct trees *trees = ctx;
    struct verify *worker = own;
    struct tree *tree = &trees->items[part];
    verify_part_begin(&tree->part, trees->v, worker);
    tree->status = climb_entry(worker, tree->entry, &tree->top);
    if (trees->are_tops) {
        rung_put_back(worker, tree->top);
        tree->top = NULL;
    }
}

static void end_trees(void *ctx, void *own)
{
    struct verify *worker = own;
    (void)ctx;
    free_spare(worker);
    free(worker->scratch);
    free(worker);
}

/* Level of the sound tile of an entry; -1 without. */
static int lod_of(const struct verify *v, uint32_t entry)
{
    return v->sound[entry] - 1;
}

/* The finest level of which there are no more sound tiles than trees may be, or the coarsest. */
static int level_of_trees(const struct verify *v)
{
    uint32_t counts[LM_DB_LODS_MAX] = {0};
    int level = 0;
    for (uint32_t i = 0; i < v->entry_count; i++) {
        if (lod_of(v, v->entries[i]) >= 0) {
            counts[lod_of(v, v->entries[i])]++;
        }
    }
    while (level + 1 < v->image->header.lod_count && counts[level] > TREES_MAX) {
        level++;
    }
    return level;
}

static int list_trees(struct trees *trees)
{
    const struct verify *v = trees->v;
    const int level = level_of_trees(v);
    trees->are_tops = level + 1 == v->image->header.lod_count;
    trees->items = calloc((size_t)v->entry_count + 1, sizeof *trees->items);
    for (uint32_t i = 0; trees->items && i < v->entry_count; i++) {
        if (lod_of(v, v->entries[i]) == level) {
            trees->items[trees->count++] = (struct tree){.entry = v->entries[i], .status = -1};
        }
    }
    if (!trees->items) {
        return -1;
    }
    qsort(trees->items, trees->count, sizeof *trees->items, by_entry);
    return 0;
}

static void free_trees(struct trees *trees)
{
    for (uint32_t i = 0; i < trees->count; i++) {
        struct tree *tree = &trees->items[i];
        free(tree->top);
        image_findings_drop(&tree->part.findings);
    }
    free(trees->items);
}

/* From the coarsest level down. */
static void check_tops(struct verify *v)
{
    for (uint32_t i = 0; i < v->entry_count; i++) {
        const uint32_t number = v->entries[i];
        struct rung *top = NULL;
        const bool is_top = lod_of(v, number) + 1 == v->image->header.lod_count;
        if (is_top && climb_entry(v, number, &top) != 0) {
            image_find(v->findings, image_record_offset(v->image, number), "%s", no_memory);
        }
        rung_put_back(v, top);
    }
}

/* Trees by several threads, then what is above them. */
void verify_levels(struct verify *v, uint32_t threads)
{
    struct trees trees = {.v = v};
    const struct hs_team team = {&trees, begin_trees, check_tree, end_trees, NULL};
    struct verify *last = begin_trees(&trees);
    if (last && list_trees(&trees) == 0 && hs_team_run(&team, trees.count, threads) == 0) {
        last->trees = &trees;
        check_tops(last);
    } else {
        image_find(v->findings, v->image->db.records_offset, "%s", no_memory);
    }
    if (last) {
        end_trees(NULL, last);
    }
    free_trees(&trees);
}
