/* The members of a committee are trained side by side, several at a time. */
#include "check.h"
#include "classify/learn.h"
#include "classify/mlp_train.h"

#include <stdlib.h>
#include <string.h>

enum { SAMPLES = 240, MEMBERS = 6 /* more than are trained at a time */ };

/* Two classes of two bands that overlap a little. */
static struct db_samples two_clouds(void)
{
    struct db_samples s = {.count = SAMPLES, .input_count = 2};
    s.inputs = malloc(2 * SAMPLES * sizeof *s.inputs);
    s.items = calloc(SAMPLES, sizeof *s.items);
    assert_true(s.inputs && s.items);
    for (int i = 0; i < SAMPLES; i++) {
        const int c = i % 2;
        s.inputs[2 * i] = (float)(c + i * 37 % 101 / 80.0);
        s.inputs[2 * i + 1] = (float)(2 * c + i * 53 % 89 / 60.0);
        s.items[i].region = (uint32_t)(i / 10);
        s.items[i].class_index = (uint8_t)c;
        s.items[i].part = DB_PART_TRAIN;
    }
    return s;
}

static void train(struct db_net *net, int members, uint64_t seed)
{
    static const uint64_t available[DB_CLASS_MAX] = {SAMPLES / 2, SAMPLES / 2};
    struct db_class_table table = {.count = 2};
    strcpy(table.items[0].name, "low");
    strcpy(table.items[1].name, "high");
    const struct db_learn_options options = {
        .train = {.rate = 0.05,
                  .momentum = 0.5,
                  .goal = 0.999,
                  .batch = 16,
                  .epochs = 12,
                  .patience = 5,
                  .seed = seed},
        .priors = DB_PRIORS_EQUAL,
        .available = available,
        .members = members,
    };
    struct db_train_report reports[MEMBERS];
    struct db_samples samples = two_clouds();
    assert_int_equal(db_learn(net, &samples, SAMPLES / 10, &table, 2, 1, &options, reports), 0);
    for (int m = 0; m < members; m++) {
        assert_true(reports[m].epoch_count > 0);
        db_train_report_free(&reports[m]);
    }
    db_samples_free(&samples);
}

static bool are_equal(const struct db_mlp *a, const struct db_mlp *b)
{
    return memcmp(a->weights, b->weights, db_mlp_size(a) * sizeof *a->weights) == 0;
}

TEST(a_member_is_to_the_bit_what_it_is_when_it_is_trained_alone)
{
    struct db_net committee, alone;
    train(&committee, MEMBERS, 40);
    assert_int_equal(committee.member_count, MEMBERS);
    for (int m = 0; m < MEMBERS; m++) {
        train(&alone, 1, 40 + (uint64_t)m);
        assert_true(are_equal(&committee.members[m], &alone.members[0]));
        assert_true(m == 0 || !are_equal(&committee.members[m], &committee.members[m - 1]));
        db_net_free(&alone);
    }
    db_net_free(&committee);
}

TEST_GROUP(NULL, NULL);
