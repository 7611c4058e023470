#include "classify/confusion.h"
#include "hs/atomic_file.h"
#include "hs/report.h"

#include <math.h>

static uint64_t row_sum(const struct db_confusion *c, int t)
{
    uint64_t sum = 0;
    for (int p = 0; p < DB_CLASS_MAX; p++) {
        sum += c->counts[t][p];
    }
    return sum;
}

static uint64_t column_sum(const struct db_confusion *c, int p)
{
    uint64_t sum = 0;
    for (int t = 0; t < DB_CLASS_MAX; t++) {
        sum += c->counts[t][p];
    }
    return sum;
}

uint64_t db_confusion_total(const struct db_confusion *c)
{
    uint64_t sum = 0;
    for (int t = 0; t < DB_CLASS_MAX; t++) {
        sum += row_sum(c, t);
    }
    return sum;
}

static double ratio(double part, double whole)
{
    return whole > 0 ? part / whole : (double)NAN;
}

double db_confusion_accuracy(const struct db_confusion *c)
{
    uint64_t right = 0;
    for (int t = 0; t < DB_CLASS_MAX; t++) {
        right += c->counts[t][t];
    }
    return ratio((double)right, (double)db_confusion_total(c));
}

double db_confusion_kappa(const struct db_confusion *c)
{
    const double total = (double)db_confusion_total(c);
    double chance = 0;
    for (int t = 0; t < DB_CLASS_MAX; t++) {
        chance += ratio((double)row_sum(c, t), total) * ratio((double)column_sum(c, t), total);
    }
    return ratio(db_confusion_accuracy(c) - chance, 1 - chance);
}

double db_confusion_recall(const struct db_confusion *c, int t)
{
    return ratio((double)c->counts[t][t], (double)row_sum(c, t));
}

double db_confusion_precision(const struct db_confusion *c, int p)
{
    return ratio((double)c->counts[p][p], (double)column_sum(c, p));
}

double db_confusion_mean_recall(const struct db_confusion *c)
{
    double sum = 0;
    int classes = 0;
    for (int t = 0; t < DB_CLASS_MAX; t++) {
        if (row_sum(c, t) > 0) {
            sum += db_confusion_recall(c, t);
            classes++;
        }
    }
    return ratio(sum, classes);
}

static int occurs(const struct db_confusion *c, int i)
{
    return row_sum(c, i) + column_sum(c, i) > 0;
}

void db_confusion_print(FILE *out, const struct db_confusion *c, const struct db_class_table *table)
{
    fprintf(out, "%-14s", "true \\ given");
    for (int p = 0; p < table->count; p++) {
        if (occurs(c, p)) {
            fprintf(out, " %11.11s", table->items[p].name);
        }
    }
    fprintf(out, " %11s\n", "recognised");
    for (int t = 0; t < table->count; t++) {
        if (!occurs(c, t)) {
            continue;
        }
        fprintf(out, "%-14.14s", table->items[t].name);
        for (int p = 0; p < table->count; p++) {
            if (occurs(c, p)) {
                fprintf(out, " %11llu", (unsigned long long)c->counts[t][p]);
            }
        }
        fprintf(out, " %9.1f %%\n", 100 * db_confusion_recall(c, t));
    }
    fprintf(out, "%-14s", "correct");
    for (int p = 0; p < table->count; p++) {
        if (occurs(c, p)) {
            fprintf(out, " %9.1f %%", 100 * db_confusion_precision(c, p));
        }
    }
    fprintf(out, "\noverall %.1f %%, mean of the classes %.1f %%, kappa %.3f, %llu pixels\n",
            100 * db_confusion_accuracy(c), 100 * db_confusion_mean_recall(c),
            db_confusion_kappa(c), (unsigned long long)db_confusion_total(c));
}

static void report_class(const struct db_confusion *c, const struct db_class_table *table, int t)
{
    hs_report_object(NULL);
    hs_report_put("name", table->items[t].name);
    hs_report_put("recall", db_confusion_recall(c, t));
    hs_report_put("precision", db_confusion_precision(c, t));
    hs_report_array("given");
    for (int p = 0; p < table->count; p++) {
        if (occurs(c, p)) {
            hs_report_put(NULL, c->counts[t][p]);
        }
    }
    hs_report_close();
    hs_report_close();
}

void db_confusion_report(const char *key, const struct db_confusion *c,
                         const struct db_class_table *table)
{
    hs_report_object(key);
    hs_report_put("pixels", db_confusion_total(c));
    hs_report_put("overall", db_confusion_accuracy(c));
    hs_report_put("mean_recall", db_confusion_mean_recall(c));
    hs_report_put("kappa", db_confusion_kappa(c));
    hs_report_array("classes");
    for (int t = 0; t < table->count; t++) {
        if (occurs(c, t)) {
            report_class(c, table, t);
        }
    }
    hs_report_close();
    hs_report_close();
}

int db_confusion_write(const char *path, const struct db_confusion *c,
                       const struct db_class_table *table)
{
    struct hs_atomic_file file;
    if (hs_atomic_open(&file, path) != 0) {
        return -1;
    }
    fputs("true_class", file.stream);
    for (int p = 0; p < table->count; p++) {
        fprintf(file.stream, ",%s", table->items[p].name);
    }
    fputs(",recall,precision\n", file.stream);
    for (int t = 0; t < table->count; t++) {
        fputs(table->items[t].name, file.stream);
        for (int p = 0; p < table->count; p++) {
            fprintf(file.stream, ",%llu", (unsigned long long)c->counts[t][p]);
        }
        fprintf(file.stream, ",%.4f,%.4f\n", db_confusion_recall(c, t),
                db_confusion_precision(c, t));
    }
    return hs_atomic_commit(&file);
}
