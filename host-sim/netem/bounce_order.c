#include "bounce_order.h"

#include "hs/error.h"

#include <stdlib.h>
#include <string.h>

/* Scratch: of each row its bounce and its number afterwards. */
struct order {
    uint8_t *bounce[NM_DIRECTIONS];
    int32_t *place[NM_DIRECTIONS];
};

/* A row's bounce is one more than that of the echo's row before, which is known already. */
static void find_bounces(const struct nm_paths *p, struct order *o)
{
    for (int d = 0; d < NM_DIRECTIONS; d++) {
        for (int r = 0; r < p->rows[d]; r++) {
            const int32_t before = p->from[d][r].row[NM_BK];
            o->bounce[d][r] = before < 0 ? 0 : (uint8_t)(o->bounce[NM_BK][before] + 1);
        }
    }
}

/* Counting sort: p->until and o->place. */
static void find_places(struct nm_paths *p, struct order *o, int d)
{
    int32_t next[TRACE_BOUNCES_MAX] = {0};
    memset(p->until[d], 0, sizeof p->until[d]);
    for (int r = 0; r < p->rows[d]; r++) {
        p->until[d][o->bounce[d][r]]++;
    }
    for (int b = 1; b < TRACE_BOUNCES_MAX; b++) {
        next[b] = p->until[d][b - 1];
        p->until[d][b] += next[b];
    }
    for (int r = 0; r < p->rows[d]; r++) {
        o->place[d][r] = next[o->bounce[d][r]]++;
    }
}

static void renumber(int32_t row[NM_DIRECTIONS], const struct order *o)
{
    for (int d = 0; d < NM_DIRECTIONS; d++) {
        row[d] = row[d] < 0 ? -1 : o->place[d][row[d]];
    }
}

static int move_rows(struct nm_paths *p, const struct order *o, int d)
{
    const size_t rows = (size_t)p->rows[d] + 1;
    struct nm_reflection *table = malloc(rows * sizeof *table);
    struct nm_from *from = malloc(rows * sizeof *from);
    if (!table || !from) {
        free(table);
        free(from);
        return hs_error("paths", "trace with fewer rays", "out of memory");
    }
    for (int r = 0; r < p->rows[d]; r++) {
        table[o->place[d][r]] = p->table[d][r];
        from[o->place[d][r]] = p->from[d][r];
        renumber(from[o->place[d][r]].row, o);
    }
    free(p->table[d]);
    free(p->from[d]);
    p->table[d] = table;
    p->from[d] = from;
    return 0;
}

int nm_paths_order(struct nm_paths *p)
{
    struct order o;
    int result = 0;
    for (int d = 0; d < NM_DIRECTIONS; d++) {
        o.bounce[d] = malloc((size_t)p->rows[d] + 1);
        o.place[d] = malloc(((size_t)p->rows[d] + 1) * sizeof *o.place[d]);
        result = o.bounce[d] && o.place[d] ? result : -1;
    }
    if (result == 0) {
        find_bounces(p, &o);
        for (int d = 0; d < NM_DIRECTIONS; d++) {
            find_places(p, &o, d);
        }
        for (int d = 0; d < NM_DIRECTIONS && result == 0; d++) {
            result = move_rows(p, &o, d);
        }
        for (int32_t s = 0; s < p->first[p->ray_count]; s++) {
            renumber(p->steps[s].row, &o);
        }
    } else {
        hs_error("paths", "trace with fewer rays", "out of memory");
    }
    for (int d = 0; d < NM_DIRECTIONS; d++) {
        free(o.bounce[d]);
        free(o.place[d]);
    }
    return result;
}
