#include "hs/taylor.h"

#include <math.h>

static const double pi = 3.14159265358979323846;

/* Coefficient m of the weighting's cosine series. */
static double taylor_coefficient(int m, double a, double sigma2, int n_bar)
{
    double above = 1, below = 1;
    for (int n = 1; n < n_bar; n++) {
        above *= 1 - m * m / (sigma2 * (a * a + (n - 0.5) * (n - 0.5)));
        if (n != m) {
            below *= 1 - (double)(m * m) / (n * n);
        }
    }
    return (m % 2 ? 0.5 : -0.5) * above / below;
}

void hs_taylor(double *weight, int count, double sidelobe_db, int n_bar)
{
    const double a = acosh(pow(10, sidelobe_db / 20)) / pi;
    const double sigma2 = n_bar * n_bar / (a * a + (n_bar - 0.5) * (n_bar - 0.5));
    for (int i = 0; i < count; i++) {
        const double x = (i + 0.5) / count - 0.5;
        weight[i] = 1;
        for (int m = 1; m < n_bar && sidelobe_db > 0; m++) {
            weight[i] += 2 * taylor_coefficient(m, a, sigma2, n_bar) * cos(2 * pi * m * x);
        }
    }
}
