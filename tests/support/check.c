#include "check.h"

#include <errno.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static struct check_case *first_case;
static CMFixtureFunction group_setup, group_teardown;

void check_add_case(struct check_case *added)
{
    struct check_case **place = &first_case;
    while (*place && (*place)->line < added->line) {
        place = &(*place)->next;
    }
    added->next = *place;
    *place = added;
}

void check_set_fixtures(CMFixtureFunction setup, CMFixtureFunction teardown)
{
    group_setup = setup;
    group_teardown = teardown;
}

int main(int argc, char **argv)
{
    size_t count = 0, i = 0;
    for (const struct check_case *c = first_case; c; c = c->next) {
        count++;
    }
    struct CMUnitTest *tests = calloc(count + 1, sizeof *tests);
    if (!tests) {
        return EXIT_FAILURE;
    }
    for (const struct check_case *c = first_case; c; c = c->next) {
        tests[i++] = c->test;
    }
    int failed = 0;
    if (argc > 1 && strcmp(argv[1], "--list") == 0) {
        for (i = 0; i < count; i++) {
            puts(tests[i].name);
        }
    } else {
        if (argc > 1) {
            cmocka_set_test_filter(argv[1]);
        }
        failed = _cmocka_run_group_tests(program_invocation_short_name, tests, count, group_setup,
                                         group_teardown);
    }
    free(tests);
    return failed;
}
