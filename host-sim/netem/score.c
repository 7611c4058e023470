#include "netem/score.h"

#include <math.h>

enum { WINDOW = 11 };

double nm_score_mse(const double *a, const double *b, int side)
{
    double sum = 0;
    for (int i = 0; i < side * side; i++) {
        sum += (a[i] - b[i]) * (a[i] - b[i]);
    }
    return sum / ((double)side * side);
}

static void make_window(double window[WINDOW * WINDOW])
{
    double sum = 0;
    for (int i = 0; i < WINDOW * WINDOW; i++) {
        const double y = i / WINDOW - WINDOW / 2, x = i % WINDOW - WINDOW / 2;
        window[i] = exp(-(x * x + y * y) / (2 * 1.5 * 1.5));
        sum += window[i];
    }
    for (int i = 0; i < WINDOW * WINDOW; i++) {
        window[i] /= sum;
    }
}

/* The index of one window, whose corner `a` and `b` point at. */
static double window_ssim(const double *window, const double *a, const double *b, int side)
{
    double ma = 0, mb = 0, aa = 0, bb = 0, ab = 0;
    for (int i = 0; i < WINDOW * WINDOW; i++) {
        const int at = i / WINDOW * side + i % WINDOW;
        ma += window[i] * a[at];
        mb += window[i] * b[at];
        aa += window[i] * a[at] * a[at];
        bb += window[i] * b[at] * b[at];
        ab += window[i] * a[at] * b[at];
    }
    const double c1 = 0.01 * 0.01, c2 = 0.03 * 0.03;
    const double spread = aa - ma * ma + bb - mb * mb;
    return (2 * ma * mb + c1) * (2 * (ab - ma * mb) + c2) /
           ((ma * ma + mb * mb + c1) * (spread + c2));
}

double nm_score_ssim(const double *a, const double *b, int side)
{
    double window[WINDOW * WINDOW], sum = 0;
    make_window(window);
    const int places = side - WINDOW + 1;
    for (int y = 0; y < places; y++) {
        for (int x = 0; x < places; x++) {
            sum += window_ssim(window, a + y * side + x, b + y * side + x, side);
        }
    }
    return sum / ((double)places * places);
}

int nm_score(const double *a, const double *b, int side, struct nm_score *score)
{
    score->mse = nm_score_mse(a, b, side);
    score->ssim = nm_score_ssim(a, b, side);
    return nm_score_cw_ssim(a, b, side, &score->cw_ssim);
}
