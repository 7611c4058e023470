/* Learning of a classifier from samples: normalisation, choice of outputs, training of a committee
 * of networks, and the classes that it gives to samples. */
#ifndef CLASSIFY_LEARN_H
#define CLASSIFY_LEARN_H

#include "classify/confusion.h"
#include "classify/mlp_train.h"
#include "classify/net_file.h"
#include "classify/samples.h"

/* How often the network is to expect each class. */
enum db_priors {
    DB_PRIORS_EXEMPLARS, /* as often as it has exemplar pixels in the image */
    DB_PRIORS_EQUAL,
    DB_PRIORS_GIVEN
};

struct db_learn_options {
    struct db_train_options train;
    int layer_count;           /* hidden layers; 0: one of db_mlp_default_hidden units */
    int hidden[DB_LAYERS_MAX]; /* units of each */
    enum db_priors priors;
    double prior[DB_CLASS_MAX]; /* when given: of each class of the table, >= 0 */
    const uint64_t *available;  /* borrowed: exemplar pixels of each class in the image */
    enum db_unit unit;
    enum db_loss loss;
    int members;
    double validate; /* part of the training regions set aside, anew for each member, to stop by; 0:
                        none */
    double thin;     /* cell of db_thin; 0: none */
    bool thin_is_loud;
};

/* The prior of each class of the table that has training samples, 0 of the others; they add up to
 * 1. "As the exemplars" means all pixels of the training regions: a class of which only some were
 * drawn as samples counts for all, and thinning changes nothing. Returns 0, or -1 reported: a class
 * with training samples has no prior above 0 among those given. */
int db_priors_find(double priors[DB_CLASS_MAX], const struct db_samples *samples,
                   const struct db_class_table *table, const struct db_learn_options *options);

/* Train a classifier on the training samples. Thins them and changes parts, so that `samples` holds
 * the survivors afterwards; held-out samples stay as they are. `reports` receives `members`
 * reports, each to be freed. Returns 0, or -1 with the error reported and nothing to free:
 * - fewer than two classes have samples,
 * - every input is constant over them (a single constant input is warned of),
 * - db_priors_find fails; no memory. */
int db_learn(struct db_net *net, struct db_samples *samples, size_t region_count,
             const struct db_class_table *table, int band_count, int context,
             const struct db_learn_options *options, struct db_train_report *reports);

/* The class, by index into `table`, that the network gives each sample. Returns 0, or -1 reported.
 */
int db_classify_samples(const struct db_net *net, const struct db_class_table *table,
                        const struct db_samples *samples, uint8_t *given);

/* Where each output of the network stands in the class table. Returns 0, or -1 reported when the
 * table lacks a class; `net_path` is for the message. */
int db_net_classes(const struct db_net *net, const struct db_class_table *table,
                   const char *net_path, uint8_t *class_of_output);

/* Count the samples of one part. */
void db_confusion_count(struct db_confusion *c, const struct db_samples *samples,
                        const uint8_t *given, enum db_part part);

#endif
