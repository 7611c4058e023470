/* Network file: a trained classifier, that is the networks of a committee and all that is needed
 * to use them on another image.
 *
 * The file is text, one item a line, '#' begins a remark, in this order:
 *
 *     landmass-net 2
 *     bands B                     1..1024
 *     context C                   side of the window of samples.h in pixels, odd, 1..31
 *     unit tanh | sigmoid
 *     loss square | cross-entropy
 *     hidden H1 ..                units of each hidden layer, 1..1024; 1..4 layers
 *     members M                   1..32: networks; their outputs are added, the largest is taken
 *     class NAME                  for each output, in order; 2..16 lines
 *     input MEAN SCALE LOW HIGH   for each input: what is subtracted, then the divisor, > 0; then
 *                                 the range of the exemplars that it was trained on
 *     unit-weights W1 .. Wn BIAS  for each unit of each layer, the outputs last; member after
 *                                 member
 *     end
 *
 * Version 1 is still read: one hidden layer, and no LOW HIGH.
 * Numbers are decimal with nine digits, which gives single precision back exactly. */
#ifndef CLASSIFY_NET_FILE_H
#define CLASSIFY_NET_FILE_H

#include "classify/mlp.h"
#include "hs/class_table.h"

#include <stdbool.h>

enum { DB_MEMBERS_MAX = 32, DB_HIDDEN_MAX = 1024 };

struct db_net {
    int band_count, context, input_count, output_count, member_count;
    char class_names[DB_CLASS_MAX][DB_NAME_SIZE];
    float *mean, *scale; /* owned; input_count of each */
    float *low, *high;   /* owned likewise: range of the training exemplars */
    bool has_range;      /* false of a file of version 1 */
    struct db_mlp members[DB_MEMBERS_MAX];
};

/* Both return 0, or -1 with file, line, cause and remedy reported. Reading believes nothing:
 * counts, names and numbers are checked, and every number must be finite and within +-1e9. */
int db_net_write(const struct db_net *net, const char *path);
int db_net_read(struct db_net *net, const char *path);

/* Take memory for what belongs to each of net->input_count inputs. Returns 0, or -1 reported. */
int db_net_alloc_inputs(struct db_net *net);

/* Harmless on a zeroed struct. */
void db_net_free(struct db_net *net);

#endif
