#include "commands.h"

#include "hs/error.h"
#include "hs/report.h"
#include "tracer/setup.h"
#include "tracer/trace_tile.h"

#include <pthread.h>
#include <stdatomic.h>
#include <stdio.h>
#include <stdlib.h>
#include <sys/resource.h>
#include <time.h>

static const struct hs_usage usage = {
    "bench", "measure rays a second, beside bare Embree",
    "Traces a picture again and again for some seconds and prints lines of name and value:\n"
    "  columns, rows, plane_m of the plane that sends the rays: width, height and how far\n"
    "                         its middle is above the scene's centre\n"
    "  primary_rays, rays     of one picture; rays are primary, specular and backward ones\n"
    "  trace_cpu_ms           tracing the picture: processor time of all threads, least of all "
    "runs\n"
    "  embree_cpu_ms          likewise of all these rays when Embree meets them, primary ones and\n"
    "                         the ground too, in ready packets and with nothing done to its "
    "answers\n"
    "  cast_cpu_ms            tracing the picture when every ray is cast and none drawn\n"
    "  rays_per_cpu_s         of the tracer\n"
    "  chip_ms                by the clock: tracing, law, sum over cells, response and pixels\n"
    "  memory_mb              of the whole process, at most"};

static double seconds_of(clockid_t clock)
{
    struct timespec t;
    clock_gettime(clock, &t);
    return (double)t.tv_sec + 1e-9 * (double)t.tv_nsec;
}

/* Packets of the same picture, cast by several threads in blocks. */
struct caster {
    const struct scene *scene;
    const struct embree_baseline_rays *rays;
    atomic_size_t next, met;
};

static void *cast(void *argument)
{
    enum { BLOCK = 128 };
    struct caster *c = argument;
    size_t first;
    while ((first = atomic_fetch_add(&c->next, BLOCK)) < c->rays->count) {
        const size_t end = first + BLOCK < c->rays->count ? first + BLOCK : c->rays->count;
        atomic_fetch_add(&c->met, embree_baseline_cast(c->scene, c->rays, first, end));
    }
    return NULL;
}

static double cast_bare_cpu_s(const struct scene *scene, const struct embree_baseline_rays *rays,
                              long threads)
{
    struct caster c = {.scene = scene, .rays = rays};
    pthread_t others[64];
    long started = 0;
    const double start_s = seconds_of(CLOCK_PROCESS_CPUTIME_ID);
    while (started + 1 < threads && pthread_create(&others[started], NULL, cast, &c) == 0) {
        started++;
    }
    cast(&c);
    for (long i = 0; i < started; i++) {
        pthread_join(others[i], NULL);
    }
    return seconds_of(CLOCK_PROCESS_CPUTIME_ID) - start_s;
}

/* The same model on a ground of two triangles: all that bare Embree needs. */
static int open_whole(const struct setup *s, double ground_half_m, struct scene *scene)
{
    struct mesh m;
    if (setup_load(s, &m) != 0) {
        return -1;
    }
    if (ground_half_m > 0) {
        const double g = ground_half_m;
        const struct vec corners[4] = {{-g, -g, 0}, {g, -g, 0}, {g, g, 0}, {-g, g, 0}};
        const uint32_t a = mesh_add_vertex(&m, corners[0]), b = mesh_add_vertex(&m, corners[1]);
        const uint32_t c = mesh_add_vertex(&m, corners[2]), d = mesh_add_vertex(&m, corners[3]);
        mesh_add_triangle(&m, a, b, c, 0);
        mesh_add_triangle(&m, a, c, d, 0);
    }
    const int result = scene_open(scene, &m, 0, s->model);
    mesh_free(&m);
    return result;
}

/* Trace once more, keeping the rays and nothing else. Returns 0, or -1 reported. */
static int keep_rays(const struct scene *scene, const struct trace_order *order,
                     struct embree_baseline_rays *rays)
{
    struct trace_tiles tiles;
    const bool is_open = trace_tiles_open(&tiles, scene, order) == 0;
    const size_t room = is_open ? tiles.tile_rays : 1;
    struct tile_work *work = is_open ? tile_work_new(&tiles) : NULL;
    struct trace_record *scratch = malloc(TRACE_BOUNCES_MAX * room * sizeof *scratch);
    for (uint32_t i = 0; work && scratch && i < tiles.tile_count; i++) {
        struct tile_result result = {.baseline = rays};
        for (uint32_t b = 0; b < TRACE_BOUNCES_MAX; b++) {
            result.bounces[b].records = scratch + b * room;
        }
        trace_tile(&tiles, i, work, &result);
    }
    embree_baseline_flush(rays);
    const bool is_whole = work && scratch && !rays->is_out_of_memory;
    free(scratch);
    tile_work_free(work);
    trace_tiles_close(&tiles);
    return is_whole ? 0 : hs_error("bench", NULL, "out of memory");
}

/* What bare Embree is given. */
struct bare {
    struct scene scene;
    struct embree_baseline_rays rays;
};

struct times {
    double trace_cpu_s, cast_cpu_s, embree_cpu_s, chip_s;
    uint64_t rays;
    struct trace_sensor sensor;
};

/* Processor time of one picture; the records are freed. Returns below 0 with the error reported. */
static double cast_all_cpu_s(const struct setup *s, const struct scene *scene,
                             const struct trace_order *order)
{
    struct trace_records r;
    struct trace_order all = *order;
    all.casts_all = true;
    const double start_s = seconds_of(CLOCK_PROCESS_CPUTIME_ID);
    if (trace_run(scene, &all, s->model, &r, NULL) != 0) {
        return -1;
    }
    const double cpu_s = seconds_of(CLOCK_PROCESS_CPUTIME_ID) - start_s;
    trace_records_free(&r);
    return cpu_s;
}

static int measure_once(const struct setup *s, const struct scene *scene,
                        const struct trace_order *order, const struct bare *bare, struct times *t)
{
    struct trace_records r;
    int width, height;
    const double start_s = seconds_of(CLOCK_MONOTONIC);
    const double start_cpu_s = seconds_of(CLOCK_PROCESS_CPUTIME_ID);
    if (trace_run(scene, order, s->model, &r, &t->rays) != 0) {
        return -1;
    }
    const double trace_cpu_s = seconds_of(CLOCK_PROCESS_CPUTIME_ID) - start_cpu_s;
    float *chip = setup_chip(s, &r, &width, &height);
    const double chip_s = seconds_of(CLOCK_MONOTONIC) - start_s;
    t->sensor = r.sensor;
    trace_records_free(&r);
    if (!chip) {
        return -1;
    }
    free(chip);
    const double cast_cpu_s = cast_all_cpu_s(s, scene, order);
    if (cast_cpu_s < 0) {
        return -1;
    }
    t->cast_cpu_s = fmin(t->cast_cpu_s, cast_cpu_s);
    t->trace_cpu_s = fmin(t->trace_cpu_s, trace_cpu_s);
    t->chip_s = fmin(t->chip_s, chip_s);
    t->embree_cpu_s = fmin(t->embree_cpu_s, cast_bare_cpu_s(&bare->scene, &bare->rays, s->threads));
    return 0;
}

static void print(const struct times *t)
{
    struct rusage use;
    getrusage(RUSAGE_SELF, &use);
    const struct trace_sensor *p = &t->sensor;
    const double height_m = p->rows * p->step_up_m;
    printf("columns %u\nrows %u\n", p->columns, p->rows);
    printf("plane_m %.9g %.9g %.9g\n", p->columns * p->step_across_m, height_m,
           p->low_up_m + height_m / 2);
    printf("primary_rays %u\nrays %llu\n", p->columns * p->rows, (unsigned long long)t->rays);
    printf("trace_cpu_ms %.2f\nembree_cpu_ms %.2f\n", 1e3 * t->trace_cpu_s, 1e3 * t->embree_cpu_s);
    printf("cast_cpu_ms %.2f\n", 1e3 * t->cast_cpu_s);
    printf("rays_per_cpu_s %.4g\n", (double)t->rays / t->trace_cpu_s);
    hs_report_put("columns", p->columns);
    hs_report_put("rows", p->rows);
    hs_report_put("plane_width_m", p->columns * p->step_across_m);
    hs_report_put("plane_height_m", height_m);
    hs_report_put("plane_middle_m", p->low_up_m + height_m / 2);
    hs_report_put("primary_rays", (uint64_t)p->columns * p->rows);
    hs_report_put("rays", t->rays);
    hs_report_put("trace_cpu_s", t->trace_cpu_s);
    hs_report_put("embree_cpu_s", t->embree_cpu_s);
    hs_report_put("cast_cpu_s", t->cast_cpu_s);
    hs_report_put("rays_per_cpu_s", (double)t->rays / t->trace_cpu_s);
    hs_report_put("chip_s", t->chip_s);
    hs_report_put("memory_bytes", (uint64_t)use.ru_maxrss * 1024);
    printf("chip_ms %.2f\nmemory_mb %ld\n", 1e3 * t->chip_s, use.ru_maxrss / 1024);
}

static int run(const struct setup *s, double seconds)
{
    struct scene scene;
    struct bare bare = {0};
    struct times t = {.trace_cpu_s = INFINITY,
                      .cast_cpu_s = INFINITY,
                      .embree_cpu_s = INFINITY,
                      .chip_s = INFINITY};
    if (setup_scene(s, &scene) != 0) {
        return HS_EXIT_FAILED;
    }
    const struct trace_order order = setup_order(s, s->azimuth_deg);
    int result = open_whole(s, scene.ground_half_m, &bare.scene);
    if (result == 0) {
        result = keep_rays(&scene, &order, &bare.rays);
    }
    for (const double end_s = seconds_of(CLOCK_MONOTONIC) + seconds;
         result == 0 && seconds_of(CLOCK_MONOTONIC) < end_s;) {
        result = measure_once(s, &scene, &order, &bare, &t);
    }
    if (result == 0) {
        print(&t);
    }
    embree_baseline_free(&bare.rays);
    scene_close(&bare.scene);
    scene_close(&scene);
    return result == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
}

int target_cmd_bench(int argc, char **argv)
{
    struct setup s = setup_default();
    double seconds = 3;
    enum { OWN = 2, COUNT = OWN + SETUP_OPTIONS };
    struct hs_option options[COUNT] = {
        {"azimuth", HS_REAL, &s.azimuth_deg, -360, 360, "DEG", "of the radar", false},
        {"seconds", HS_REAL, &seconds, 0.1, 600, "S", "to measure", false},
    };
    int exit_code;
    setup_options(&s, options + OWN);
    if (!hs_options_read(&usage, options, COUNT, argc, argv, &exit_code)) {
        return exit_code;
    }
    return run(&s, seconds);
}
