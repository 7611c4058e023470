/* The confusion matrix against a published one, and the list of the worst regions. */
#include "check.h"
#include "classify/confusion.h"
#include "classify/error_regions.h"
#include "fixture.h"

#include <math.h>
#include <stdlib.h>

/* Congalton, "A review of assessing the accuracy of classifications of remotely sensed data",
 * Remote Sensing of Environment 37, 1991, table 1: deciduous, conifer, agriculture, shrub; rows
 * there are the classified, columns the reference data. */
static struct db_confusion congalton(void)
{
    static const uint64_t table[4][4] = {
        {65, 4, 22, 24}, {6, 81, 5, 8}, {0, 11, 85, 19}, {4, 7, 3, 90}};
    struct db_confusion c = {0};
    for (int given = 0; given < 4; given++) {
        for (int truth = 0; truth < 4; truth++) {
            c.counts[truth][given] = table[given][truth];
        }
    }
    return c;
}

TEST(accuracy_and_kappa_are_those_of_congaltons_table)
{
    const struct db_confusion c = congalton();
    assert_int_equal(db_confusion_total(&c), 434);
    assert_true(fabs(db_confusion_accuracy(&c) - 321.0 / 434) < 1e-12);
    /* By hand: chance is (115 * 75 + 100 * 103 + 115 * 115 + 104 * 141) / 434^2 = 0.24854. */
    assert_true(fabs(db_confusion_kappa(&c) - 0.6535) < 5e-5);
}

TEST(producers_and_users_accuracies_are_those_of_congaltons_table)
{
    static const double producers[] = {65.0 / 75, 81.0 / 103, 85.0 / 115, 90.0 / 141};
    static const double users[] = {65.0 / 115, 81.0 / 100, 85.0 / 115, 90.0 / 104};
    const struct db_confusion c = congalton();
    double mean = 0;
    for (int i = 0; i < 4; i++) {
        assert_true(fabs(db_confusion_recall(&c, i) - producers[i]) < 1e-12);
        assert_true(fabs(db_confusion_precision(&c, i) - users[i]) < 1e-12);
        mean += producers[i] / 4;
    }
    assert_true(fabs(db_confusion_mean_recall(&c) - mean) < 1e-12);
}

TEST(an_empty_matrix_has_no_accuracy)
{
    const struct db_confusion c = {0};
    assert_true(isnan(db_confusion_accuracy(&c)));
    assert_true(isnan(db_confusion_kappa(&c)));
    assert_true(isnan(db_confusion_mean_recall(&c)));
}

TEST(agreement_by_chance_alone_has_a_kappa_of_zero)
{
    struct db_confusion c = {0};
    c.counts[0][0] = 90 * 90;
    c.counts[0][1] = c.counts[1][0] = 90 * 10;
    c.counts[1][1] = 10 * 10;
    assert_true(fabs(db_confusion_kappa(&c)) < 1e-12);
    assert_true(db_confusion_accuracy(&c) > 0.8);
}

TEST(the_worst_region_comes_first_with_what_it_was_taken_for)
{
    const struct db_exemplar items[] = {
        {0, 0, 0, 1, 0}, {1, 0, 0, 1, 0}, {2, 0, 1, 2, 0}, {3, 0, 1, 2, 0}, {4, 0, 1, 2, 0},
    };
    const uint8_t given[] = {1, 1, 2, 5, 5};
    size_t count;
    struct db_error_region *places = db_error_regions_by_region(items, given, 5, 3, &count);
    assert_non_null(places);
    assert_int_equal(count, 2);
    assert_int_equal(places[0].index, 1);
    assert_int_equal(places[0].right, 1);
    assert_int_equal(places[0].count, 3);
    assert_int_equal(places[0].mistaken_for, 5);
    assert_int_equal(places[1].mistaken_for, DB_CLASS_NODATA);
    free(places);
    const struct db_grid grid = {.width = 5, .height = 1};
    places = db_error_regions_by_square(items, given, 5, 4, &grid, &count);
    assert_int_equal(count, 2);
    assert_int_equal(places[0].index, 1);
    assert_int_equal(places[1].count, 4);
    assert_int_equal(places[1].right, 3);
    free(places);
}

TEST_GROUP(fixture_open, fixture_close);
