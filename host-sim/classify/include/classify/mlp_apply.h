/* Forward pass of a trained network over many pixels, laid out for vector instructions. */
#ifndef CLASSIFY_MLP_APPLY_H
#define CLASSIFY_MLP_APPLY_H

#include "classify/net_file.h"

/* A network with the normalisation folded into its first layer. */
struct db_applied {
    struct db_mlp shape; /* without weights */
    int member_count;
    float *weights; /* owned: for each member as in db_mlp */
    size_t member_size;
    float *planes; /* owned: scratch, so that one thread at a time may use it */
};

/* Returns 0, or -1 out of memory, reported. */
int db_apply_init(struct db_applied *a, const struct db_net *net);

/* Harmless on a zeroed struct. */
void db_apply_free(struct db_applied *a);

/* The output with the largest sum over the members, for each of `count` pixels. `planes` holds one
 * plane of `stride` values an input, of which the first `count` are used. The sums that enter the
 * output units are compared: units are monotonic, so for a single network the answer is that of its
 * outputs.
 *
 * `margins`, unless NULL, receives by how much the largest sum passes the next, as the mean over
 * the members: with cross-entropy the logarithm of how much likelier the winner is, so that its
 * probability against the next is 1 / (1 + exp(-margin)). */
void db_apply(const struct db_applied *a, const float *planes, size_t stride, size_t count,
              uint8_t *winners, float *margins);

#endif
