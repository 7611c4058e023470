#include "hs/progress.h"

#include <stdio.h>
#include <unistd.h>

enum { BAR_WIDTH = 40 };

void hs_progress_begin(struct hs_progress *p, const char *label, uint64_t total)
{
    p->label = label;
    p->total = total ? total : 1;
    p->shown_permille = -1;
    p->is_terminal = isatty(STDERR_FILENO);
    hs_progress_update(p, 0);
}

void hs_progress_begin_beside(struct hs_progress *p, FILE *out, const char *label, uint64_t total)
{
    if (total > 0 && !isatty(fileno(out))) {
        hs_progress_begin(p, label, total);
    } else {
        *p = (struct hs_progress){.label = label, .total = 1};
    }
}

void hs_progress_update(struct hs_progress *p, uint64_t done)
{
    if (!p->is_terminal) {
        return;
    }
    const double part = (double)done / (double)p->total;
    const int permille = (int)(1000 * (part < 1 ? part : 1));
    if (permille == p->shown_permille) {
        return;
    }
    p->shown_permille = permille;
    const int filled = permille * BAR_WIDTH / 1000;
    fprintf(stderr, "\r%-24s [", p->label);
    for (int i = 0; i < BAR_WIDTH; i++) {
        fputc(i < filled ? '#' : '.', stderr);
    }
    fprintf(stderr, "] %3d.%d %%", permille / 10, permille % 10);
    fflush(stderr);
}

void hs_progress_end(struct hs_progress *p)
{
    if (p->is_terminal) {
        fputs("\r\033[K", stderr);
    }
}
