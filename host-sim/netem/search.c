#include "netem/search.h"

#include "hs/error.h"

#include <math.h>
#include <stdlib.h>
#include <string.h>

int nm_library_open(struct nm_library *l, int views, int side_px)
{
    *l = (struct nm_library){
        views, side_px,
        calloc((size_t)views * (size_t)side_px * (size_t)side_px, sizeof *l->pictures)};
    return l->pictures ? 0 : hs_error("search", "take fewer views", "out of memory");
}

void nm_library_close(struct nm_library *l)
{
    free(l->pictures);
    *l = (struct nm_library){0};
}

static int by_value(const void *a, const void *b)
{
    const double x = *(const double *)a, y = *(const double *)b;
    return (x > y) - (x < y);
}

int nm_library_calibrate(struct nm_library *l, double clutter)
{
    const size_t count = (size_t)l->views * (size_t)l->side_px * (size_t)l->side_px;
    double *sorted = malloc(count * sizeof *sorted);
    if (!sorted) {
        return hs_error("search", "take fewer views", "out of memory");
    }
    memcpy(sorted, l->pictures, count * sizeof *sorted);
    qsort(sorted, count, sizeof *sorted, by_value);
    const double ground = sorted[count / 2];
    free(sorted);
    for (size_t i = 0; i < count; i++) {
        l->pictures[i] = tanh(clutter / ground * l->pictures[i]);
    }
    return ground > 0 ? 0
                      : hs_error("search", "give a law whose ground returns something",
                                 "the simulated pictures have no ground");
}

int nm_match_open(struct nm_match *m, int views)
{
    m->scores = malloc((size_t)views * sizeof *m->scores);
    m->origins = malloc((size_t)views * sizeof *m->origins);
    if (!m->scores || !m->origins) {
        nm_match_close(m);
        return hs_error("search", "take fewer views", "out of memory");
    }
    return 0;
}

void nm_match_close(struct nm_match *m)
{
    free(m->scores);
    free(m->origins);
    *m = (struct nm_match){0};
}

/* Mean 0 and length 1, on a plane of the chips' size. */
static void take_view(struct nm_searcher *s, const double *picture, fftw_complex *spectrum)
{
    const int pixels = s->side_px * s->side_px;
    double sum = 0, square = 0;
    for (int i = 0; i < pixels; i++) {
        sum += picture[i];
    }
    for (int i = 0; i < pixels; i++) {
        square += (picture[i] - sum / pixels) * (picture[i] - sum / pixels);
    }
    const double scale = square > 0 ? 1 / sqrt(square) : 0;
    double *plane = s->fft.plane;
    memset(plane, 0, (size_t)s->width * (size_t)s->height * sizeof *plane);
    for (int i = 0; i < pixels; i++) {
        plane[i / s->side_px * s->width + i % s->side_px] = scale * (picture[i] - sum / pixels);
    }
    nm_fft_to(&s->fft, spectrum);
}

int nm_searcher_open(struct nm_searcher *s, const struct nm_library *library, int width, int height)
{
    *s = (struct nm_searcher){
        .width = width, .height = height, .views = library->views, .side_px = library->side_px};
    if (width < s->side_px || height < s->side_px) {
        return hs_error("search", "give fewer --cells",
                        "chips of %d x %d pixels are smaller than the simulated ones", width,
                        height);
    }
    if (nm_fft_open(&s->fft, height, width, "search") != 0) {
        return -1;
    }
    const size_t integrals = (size_t)(width + 1) * (size_t)(height + 1);
    s->chip = nm_fft_spectrum_new(&s->fft);
    s->library = fftw_alloc_complex(s->fft.spectrum_size * (size_t)s->views);
    s->sums = calloc(integrals, sizeof *s->sums);
    s->squares = calloc(integrals, sizeof *s->squares);
    if (!s->chip || !s->library || !s->sums || !s->squares) {
        nm_searcher_close(s);
        return hs_error("search", "take fewer views", "out of memory");
    }
    for (int v = 0; v < s->views; v++) {
        take_view(s, library->pictures + (size_t)v * (size_t)(s->side_px * s->side_px),
                  s->library + (size_t)v * s->fft.spectrum_size);
    }
    return 0;
}

void nm_searcher_close(struct nm_searcher *s)
{
    nm_fft_close(&s->fft);
    fftw_free(s->chip);
    fftw_free(s->library);
    free(s->sums);
    free(s->squares);
    *s = (struct nm_searcher){0};
}

/* sums[y][x] is the sum of all pixels above y and left of x. */
static void integrate(struct nm_searcher *s, const struct nm_picture *chip)
{
    const int stride = s->width + 1;
    for (int y = 0; y < s->height; y++) {
        double row = 0, row_square = 0;
        for (int x = 0; x < s->width; x++) {
            const double p = chip->pixels[y * s->width + x];
            row += p;
            row_square += p * p;
            const int at = (y + 1) * stride + x + 1;
            s->sums[at] = s->sums[at - stride] + row;
            s->squares[at] = s->squares[at - stride] + row_square;
        }
    }
}

static double square_of(const struct nm_searcher *s, const double *integral, int x, int y)
{
    const int stride = s->width + 1, n = s->side_px;
    return integral[(y + n) * stride + x + n] - integral[y * stride + x + n] -
           integral[(y + n) * stride + x] + integral[y * stride + x];
}

/* Length of the chip's part under a picture at (x, y), its mean taken off. */
static double length_at(const struct nm_searcher *s, int x, int y)
{
    const double sum = square_of(s, s->sums, x, y), pixels = (double)s->side_px * s->side_px;
    return sqrt(fmax(square_of(s, s->squares, x, y) - sum * sum / pixels, 0));
}

static void search_view(struct nm_searcher *s, int view, int reach, double *score,
                        struct nm_origin *origin)
{
    const fftw_complex *v = s->library + (size_t)view * s->fft.spectrum_size;
    fftw_complex *product = s->fft.spectrum;
    for (size_t i = 0; i < s->fft.spectrum_size; i++) {
        nm_fft_correlate(s->chip[i], v[i], product[i]);
    }
    nm_fft_back(&s->fft);
    const int mx = (s->width - s->side_px) / 2, my = (s->height - s->side_px) / 2;
    *score = -1;
    *origin = (struct nm_origin){mx, my};
    for (int y = my - reach > 0 ? my - reach : 0; y <= my + reach && y <= 2 * my; y++) {
        for (int x = mx - reach > 0 ? mx - reach : 0; x <= mx + reach && x <= 2 * mx; x++) {
            const double length = length_at(s, x, y) * s->width * s->height;
            const double fit = length > 0 ? s->fft.plane[y * s->width + x] / length : 0;
            if (fit > *score) {
                *score = fit;
                *origin = (struct nm_origin){x, y};
            }
        }
    }
}

void nm_search(struct nm_searcher *s, const struct nm_picture *chip, int reach,
               struct nm_match *match)
{
    integrate(s, chip);
    memcpy(s->fft.plane, chip->pixels, (size_t)s->width * (size_t)s->height * sizeof *chip->pixels);
    nm_fft_to(&s->fft, s->chip);
    for (int v = 0; v < s->views; v++) {
        search_view(s, v, reach, &match->scores[v], &match->origins[v]);
    }
}

void nm_choose_alone(const struct nm_match *matches, int count, int views, int *chosen)
{
    for (int i = 0; i < count; i++) {
        chosen[i] = 0;
        for (int v = 1; v < views; v++) {
            chosen[i] = matches[i].scores[v] > matches[i].scores[chosen[i]] ? v : chosen[i];
        }
    }
}

/* Between -180 and 180. */
static double turned(double degrees)
{
    return remainder(degrees, 360);
}

static double step_cost(double degrees, double steady_deg)
{
    const double off = fabs(turned(degrees - steady_deg)) - 4;
    return off > 0 ? fmin(0.003 * off, 0.4) : 0;
}

/* Scratch of the choice in order, for `views` views. */
struct chooser {
    int views;
    double *costs;        /* of a turn by so many views, under the steady step in question */
    double *total, *next; /* the best sums that end in each view */
    int *from;            /* for each chip and view: by which view of the chip before */
};

static int chooser_open(struct chooser *c, int count, int views)
{
    const size_t n = (size_t)views;
    c->views = views;
    c->costs = malloc(3 * n * sizeof *c->costs);
    c->total = c->costs ? c->costs + n : NULL;
    c->next = c->costs ? c->costs + 2 * n : NULL;
    c->from = calloc((size_t)count * n, sizeof *c->from);
    return c->costs && c->from ? 0 : hs_error("search", "take fewer views", "out of memory");
}

/* The best way to reach view v from the views of the chip before. */
static double best_before(const struct chooser *c, int v, int *from)
{
    double most = -INFINITY;
    int best = 0;
    for (int u = 0; u < c->views; u++) {
        const double sum = c->total[u] - c->costs[v >= u ? v - u : v - u + c->views];
        best = sum > most ? u : best;
        most = fmax(sum, most);
    }
    *from = best;
    return most;
}

/* The best total under one steady step, and the views that make it. */
static double choose_with_step(struct chooser *c, const struct nm_match *matches, int count,
                               double steady_deg, int *chosen)
{
    const int views = c->views;
    const size_t bytes = (size_t)views * sizeof *c->total;
    for (int k = 0; k < views; k++) {
        c->costs[k] = step_cost(k * 360.0 / views, steady_deg);
    }
    memcpy(c->total, matches[0].scores, bytes);
    for (int i = 1; i < count; i++) {
        for (int v = 0; v < views; v++) {
            c->next[v] = best_before(c, v, &c->from[i * views + v]) + matches[i].scores[v];
        }
        memcpy(c->total, c->next, bytes);
    }
    int v = 0;
    for (int u = 1; u < views; u++) {
        v = c->total[u] > c->total[v] ? u : v;
    }
    const double sum = c->total[v];
    for (int i = count - 1; i >= 0; i--) {
        chosen[i] = v;
        v = i > 0 ? c->from[i * views + v] : 0;
    }
    return sum;
}

int nm_choose_in_order(const struct nm_match *matches, int count, int views, int *chosen,
                       double *step_deg)
{
    struct chooser c;
    double best = -INFINITY;
    int *tried = malloc((size_t)count * sizeof *tried);
    const int result = chooser_open(&c, count, views) == 0 && tried ? 0 : -1;
    for (int steady = -12; result == 0 && steady <= 12; steady++) {
        const double sum = choose_with_step(&c, matches, count, steady, tried);
        if (sum > best) {
            best = sum;
            *step_deg = steady;
            memcpy(chosen, tried, (size_t)count * sizeof *tried);
        }
    }
    free(tried);
    free(c.costs);
    free(c.from);
    return result;
}

double nm_search_margin(const struct nm_match *match, int views, int chosen)
{
    double other = -1;
    for (int v = 0; v < views; v++) {
        if (fabs(turned((v - chosen) * 360.0 / views)) > 30) {
            other = fmax(other, match->scores[v]);
        }
    }
    return match->scores[chosen] - other;
}
