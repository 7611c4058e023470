/* Loss: the distance between a simulated picture and a real one, Niu (13) and (14), over the
 * pixels that both have. */
#ifndef NETEM_LOSS_H
#define NETEM_LOSS_H

#include "netem/picture.h"

enum nm_loss_kind { NM_MSE, NM_MAE };

/* `simulated` is a square of `side` pixels that lies on `real` at `origin`. If `d_simulated` is not
 * NULL it receives the derivative by each pixel. Returns the mean over the common pixels, or 0 when
 * there are none. */
double nm_loss(enum nm_loss_kind kind, const double *simulated, int side,
               const struct nm_picture *real, struct nm_origin origin, double *d_simulated);

#endif
