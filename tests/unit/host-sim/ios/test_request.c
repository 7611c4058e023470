/* What browsers ask for, and what others try. */
#include "check.h"
#include "ios/request.h"

#include <string.h>

TEST(each_path_means_what_the_document_says)
{
    static const struct {
        const char *path;
        enum ios_route_kind kind;
        const char *name;
    } cases[] = {{"/", IOS_ROUTE_FILE, "index.html"},
                 {"/web/", IOS_ROUTE_FILE, "web/index.html"},
                 {"/web/unit.mjs", IOS_ROUTE_FILE, "web/unit.mjs"},
                 {"/image", IOS_ROUTE_IMAGE, "image"},
                 {"/map.json", IOS_ROUTE_MAP, "map.json"},
                 {"/station.json", IOS_ROUTE_STATION, "station.json"},
                 {"/recordings.json", IOS_ROUTE_LIST, "recordings.json"},
                 {"/counters.json", IOS_ROUTE_COUNTERS, "counters.json"},
                 {"/bus", IOS_ROUTE_BUS, "bus"},
                 {"/display/left", IOS_ROUTE_DISPLAY, "left"},
                 {"/recordings/a.log", IOS_ROUTE_RECORDING, "a.log"},
                 {"/recordings/left/a.log", IOS_ROUTE_RECORDING, "left/a.log"}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct ios_route r;
        assert_true(ios_route_read(&r, cases[i].path));
        assert_int_equal(r.kind, cases[i].kind);
        assert_string_equal(r.name, cases[i].name);
    }
}

TEST(paths_that_lead_elsewhere_are_none)
{
    static const char *const paths[] = {"",
                                        "x",
                                        "//",
                                        "/..",
                                        "/../a",
                                        "/a/../b",
                                        "/.git",
                                        "/a//b",
                                        "/a b",
                                        "/a\\b",
                                        "/a%2fb",
                                        "/\xc3\xa4",
                                        "/a?b",
                                        "/display/a/b",
                                        "/recordings/a/b/c",
                                        "/map/1/1",
                                        "/map/1/1/1.gif",
                                        "/map/1/2/0.png",
                                        "/map/1/0/2.png",
                                        "/map/23/0/0.png",
                                        "/map/-1/0/0.png",
                                        "/map/99999999999/0/0.png",
                                        "/map/1/0/0.png/x"};
    struct ios_route r;
    for (size_t i = 0; i < sizeof paths / sizeof paths[0]; i++) {
        if (ios_route_read(&r, paths[i])) {
            fail_msg("%s is taken", paths[i]);
        }
    }
    char name[300];
    memset(name, 'a', sizeof name);
    name[0] = '/';
    name[IOS_NAME_MAX + 2] = '\0';
    assert_false(ios_route_read(&r, name));
    name[IOS_NAME_MAX + 1] = '\0';
    assert_true(ios_route_read(&r, name));
}

TEST(tiles_have_their_numbers_below_their_zoom)
{
    struct ios_route r;
    assert_true(ios_route_read(&r, "/map/22/4194303/0.png"));
    assert_true(r.kind == IOS_ROUTE_TILE && r.zoom == 22 && r.x == 4194303 && r.y == 0);
    assert_true(ios_route_read(&r, "/map/0/0/0.png"));
}

TEST(ranges_are_cut_to_the_body)
{
    static const struct {
        const char *header;
        uint64_t size;
        enum ios_range_kind kind;
        uint64_t first, bytes;
    } cases[] = {{NULL, 10, IOS_RANGE_ALL, 0, 10},
                 {"bytes=0-0", 10, IOS_RANGE_PART, 0, 1},
                 {"bytes=3-", 10, IOS_RANGE_PART, 3, 7},
                 {"bytes=3-99", 10, IOS_RANGE_PART, 3, 7},
                 {"bytes=-4", 10, IOS_RANGE_PART, 6, 4},
                 {"bytes=-99", 10, IOS_RANGE_PART, 0, 10},
                 {"bytes=10-", 10, IOS_RANGE_NONE, 0, 0},
                 {"bytes=-0", 10, IOS_RANGE_NONE, 0, 0},
                 {"bytes=0-", 0, IOS_RANGE_NONE, 0, 0},
                 {"bytes=4-3", 10, IOS_RANGE_ALL, 0, 10},
                 {"bytes=1-2,4-5", 10, IOS_RANGE_ALL, 0, 10},
                 {"bytes=", 10, IOS_RANGE_ALL, 0, 10},
                 {"bytes=x-2", 10, IOS_RANGE_ALL, 0, 10},
                 {"bytes=99999999999999999999-", 10, IOS_RANGE_ALL, 0, 10},
                 {"lines=0-1", 10, IOS_RANGE_ALL, 0, 10}};
    for (size_t i = 0; i < sizeof cases / sizeof cases[0]; i++) {
        struct ios_range range;
        assert_int_equal(ios_range_read(&range, cases[i].header, cases[i].size), cases[i].kind);
        if (cases[i].kind != IOS_RANGE_NONE) {
            assert_int_equal(range.first, cases[i].first);
            assert_int_equal(range.bytes, cases[i].bytes);
        }
    }
}

TEST(only_our_own_names_are_hosts_and_origins)
{
    struct ios_hosts hosts = {0};
    assert_true(ios_hosts_add(&hosts, "127.0.0.1:8470"));
    assert_true(ios_hosts_add(&hosts, "Station.Example"));
    assert_false(ios_hosts_add(&hosts, ""));
    assert_false(ios_hosts_add(&hosts, "a/b"));
    assert_true(ios_host_is_ours(&hosts, "127.0.0.1:8470"));
    assert_true(ios_host_is_ours(&hosts, "STATION.example"));
    static const char *const strange[] = {"", "127.0.0.1", "127.0.0.1:84700", "station.example.",
                                          "xstation.example"};
    for (size_t i = 0; i < sizeof strange / sizeof strange[0]; i++) {
        assert_false(ios_host_is_ours(&hosts, strange[i]));
    }
    assert_true(ios_origin_is_ours(&hosts, "http://127.0.0.1:8470"));
    assert_true(ios_origin_is_ours(&hosts, "https://station.example"));
    static const char *const origins[] = {"",
                                          "null",
                                          "ftp://127.0.0.1:8470",
                                          "http://127.0.0.1:8470/",
                                          "http://evil",
                                          "127.0.0.1:8470"};
    for (size_t i = 0; i < sizeof origins / sizeof origins[0]; i++) {
        assert_false(ios_origin_is_ours(&hosts, origins[i]));
    }
    while (hosts.count < IOS_HOSTS_MAX) {
        assert_true(ios_hosts_add(&hosts, "more"));
    }
    assert_false(ios_hosts_add(&hosts, "more"));
}

TEST(secrets_are_compared_whole)
{
    assert_true(ios_is_same_secret("abc", "abc"));
    assert_false(ios_is_same_secret("abc", "abd"));
    assert_false(ios_is_same_secret("abc", "ab"));
    assert_false(ios_is_same_secret("abc", "abcd"));
    char value[8];
    assert_true(ios_cookie_read("a=1; landmass=xyz", "landmass", value, sizeof value));
    assert_string_equal(value, "xyz");
    assert_false(ios_cookie_read("xlandmass=1", "landmass", value, sizeof value));
    assert_false(ios_cookie_read("landmass=12345678", "landmass", value, sizeof value));
    assert_false(ios_cookie_read("landmass", "landmass", value, sizeof value));
    assert_string_equal(ios_bearer_token("bearer abc"), "abc");
    assert_null(ios_bearer_token("Basic abc"));
}
