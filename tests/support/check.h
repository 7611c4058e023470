/* Test cases that register themselves. A test program is one source file that
 * includes this header, defines its cases with TEST, and is linked with the
 * library of tests/support, which holds `main`:
 *
 *     #include "check.h"
 *
 *     TEST(the_root_of_nine_is_three)
 *     {
 *         assert_int_equal(fx_sqrt_u64(9), 3);
 *     }
 *
 * `main` runs all cases in the order of their definition. The assertions are
 * those of cmocka, whose header this one includes, with <stddef.h> and
 * <stdint.h>. Results go to the standard output in TAP form if
 * CMOCKA_MESSAGE_OUTPUT=TAP. Arguments:
 *
 *     test_root --list        print the names of the cases
 *     test_root 'PATTERN'     run the cases whose name matches; * and ? are
 * wild
 */
#ifndef CHECK_H
#define CHECK_H

#include <setjmp.h>
#include <stdarg.h>
#include <stddef.h>
#include <stdint.h>

#include <cmocka.h>

/* A case: a function body follows. It sees `void **state`, which its setup or
 * the group's may set.
 */
#define TEST(name) TEST_WITH(name, NULL, NULL)

/* A case with a function before and one after it: `int f(void **state)`, 0 if
 * it went well, or NULL for none. The second runs when an assertion has failed,
 * too. */
#define TEST_WITH(name, setup, teardown)                                                           \
    static void name(void **state);                                                                \
    static void __attribute__((constructor)) check_add_##name(void)                                \
    {                                                                                              \
        static struct check_case self = {{#name, name, setup, teardown, NULL}, __LINE__, NULL};    \
        check_add_case(&self);                                                                     \
    }                                                                                              \
    static void name(__attribute__((unused)) void **state)

/* Functions before the first and after the last case; at most once in a
 * program, at file scope. */
#define TEST_GROUP(setup, teardown)                                                                \
    static void __attribute__((constructor)) check_group_fixtures(void)                            \
    {                                                                                              \
        check_set_fixtures(setup, teardown);                                                       \
    }                                                                                              \
    struct check_case /* takes the semicolon */

struct check_case {
    struct CMUnitTest test;
    int line; /* of the definition: constructors may run in another order */
    struct check_case *next;
};

/* What the macros call before `main`. Cases are not copied: they must be
 * static. */
void check_add_case(struct check_case *added);
void check_set_fixtures(CMFixtureFunction setup, CMFixtureFunction teardown);

#endif
