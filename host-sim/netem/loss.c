#include "netem/loss.h"

#include <math.h>
#include <stddef.h>
#include <string.h>

static int least(int a, int b)
{
    return a < b ? a : b;
}

static int most(int a, int b)
{
    return a > b ? a : b;
}

double nm_loss(enum nm_loss_kind kind, const double *simulated, int side,
               const struct nm_picture *real, struct nm_origin origin, double *d_simulated)
{
    const int x0 = most(0, -origin.x), x1 = least(side, real->width - origin.x);
    const int y0 = most(0, -origin.y), y1 = least(side, real->height - origin.y);
    if (d_simulated) {
        memset(d_simulated, 0, (size_t)side * (size_t)side * sizeof *d_simulated);
    }
    if (x1 <= x0 || y1 <= y0) {
        return 0;
    }
    const double share = 1.0 / ((double)(x1 - x0) * (y1 - y0));
    double sum = 0;
    for (int y = y0; y < y1; y++) {
        for (int x = x0; x < x1; x++) {
            const double error =
                simulated[y * side + x] - real->pixels[(origin.y + y) * real->width + origin.x + x];
            sum += kind == NM_MSE ? error * error : fabs(error);
            if (d_simulated) {
                const double sign = (error > 0) - (error < 0);
                d_simulated[y * side + x] = share * (kind == NM_MSE ? 2 * error : sign);
            }
        }
    }
    return share * sum;
}
