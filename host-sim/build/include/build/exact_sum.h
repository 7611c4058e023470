/* Exact sum: one whose value does not depend on the order of its terms, so that parts of an image
 * that are made apart add up to what they do together. */
#ifndef BUILD_EXACT_SUM_H
#define BUILD_EXACT_SUM_H

/* Terms are cut to whole multiples of 2^-40. The sum stays below 2^86 = 7.7e25. */
struct build_sum {
    __int128 q40;
};

/* Add a term, which is below 2^80. */
static inline void build_sum_add(struct build_sum *sum, double term)
{
    sum->q40 += (__int128)(term * 1099511627776.0);
}

/* Add another sum. */
static inline void build_sum_join(struct build_sum *sum, const struct build_sum *other)
{
    sum->q40 += other->q40;
}

static inline double build_sum_value(const struct build_sum *sum)
{
    return (double)sum->q40 / 1099511627776.0;
}

#endif
