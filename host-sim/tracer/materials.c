#include "tracer/materials.h"

#include "hs/error.h"
#include "hs/input_file.h"
#include "tracer/surfaces.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <string.h>

static const double pi = 3.14159265358979323846;

enum { FILE_MAX = 256 };

struct table {
    struct reflect_material rows[FILE_MAX];
    int count;
};

static const struct reflect_material *find(const struct table *table, const char *name)
{
    for (int i = 0; i < table->count; i++) {
        if (strcmp(table->rows[i].name, name) == 0) {
            return &table->rows[i];
        }
    }
    return NULL;
}

static const char *row_fault(const struct reflect_material *m)
{
    if (!(m->permittivity >= 1 && m->permittivity <= 1e9 && m->loss >= 0 && m->loss <= 1e9)) {
        return "a permittivity is at least 1 and a loss not negative";
    }
    if (!(m->rms_height_m >= 0 && m->rms_height_m <= 1 && m->correlation_m >= 0 &&
          m->correlation_m <= 100)) {
        return "heights are 0..1 m and correlation lengths 0..100 m";
    }
    if (!(m->specular >= 0 && m->specular <= 1 && m->diffuse >= 0 && m->diffuse <= 1 &&
          m->brilliance >= 0 && m->brilliance <= 1 && m->roughness > 0 && m->roughness <= 1)) {
        return "F_s, F_d and F_b are 0..1 and F_r is above 0 and at most 1";
    }
    if (!(m->coat_m >= 0 && m->coat_m <= 1)) {
        return "a coat is 0..1 m thick";
    }
    return NULL;
}

/* The last two words may be missing, as they were before: Gaussian, no coat. */
static const char *read_spectrum(const char *word, struct reflect_material *m)
{
    for (int i = 0; i < REFLECT_SPECTRA; i++) {
        if (strcmp(word, reflect_spectrum_names[i]) == 0) {
            m->spectrum = (enum reflect_spectrum)i;
            return NULL;
        }
    }
    return "a spectrum is gaussian or exponential";
}

static const char *read_row(const char *line, struct reflect_material *m)
{
    char extra, word[16] = "gaussian";
    const int read =
        sscanf(line, "%31s %lf %lf %lf %lf %lf %lf %lf %lf %15s %lf %c", m->name, &m->permittivity,
               &m->loss, &m->rms_height_m, &m->correlation_m, &m->specular, &m->roughness,
               &m->diffuse, &m->brilliance, word, &m->coat_m, &extra);
    if (read < 9 || read > 11) {
        return "expected a name, eight numbers, a spectrum and the thickness of a coat";
    }
    const char *fault = read_spectrum(word, m);
    return fault ? fault : row_fault(m);
}

static int read_rows(struct table *table, FILE *in, const char *path)
{
    char line[512];
    for (int number = 1; fgets(line, sizeof line, in); number++) {
        line[strcspn(line, "#\r\n")] = '\0';
        if (line[strspn(line, " \t")] == '\0') {
            continue;
        }
        const char *fault = table->count < FILE_MAX ? read_row(line, &table->rows[table->count])
                                                    : "more than 256 surfaces";
        if (fault) {
            char place[512];
            snprintf(place, sizeof place, "%s line %d", path, number);
            return hs_error(place, "landmass-target materials prints a good file", "%s", fault);
        }
        table->count++;
    }
    return ferror(in) ? hs_error(path, NULL, "cannot be read to its end") : 0;
}

static int read_table(struct table *table, const char *path)
{
    FILE *in = hs_input_open(path, "r");
    if (!in) {
        return hs_error(path, "check the name", "cannot be opened: %s", strerror(errno));
    }
    const int result = read_rows(table, in, path);
    fclose(in);
    return result;
}

static int look_up(const struct table *table, const char *name, double wavelength_m,
                   struct reflect_material *m)
{
    char base[TRACE_NAME_SIZE];
    const struct reflect_material *row = find(table, name);
    const struct surface *surface = row ? NULL : surface_find(name);
    if (!row && !surface) {
        snprintf(base, sizeof base, "%.*s", (int)strcspn(name, "."), name);
        row = find(table, base);
        surface = row ? NULL : surface_find(base);
    }
    if (!row && !surface) {
        return hs_error(
            name,
            "add it to the file of --materials, or rename it: landmass-target materials "
            "lists those built in",
            "a material that no table has");
    }
    if (surface) {
        surface_doubt(surface, wavelength_m);
    }
    *m = row ? *row : surface_at(surface, wavelength_m);
    return 0;
}

/* Small perturbation wants heights well below a wavelength (Ulaby, Moore, Fung, II, 12-5). */
static void doubt_roughness(const struct reflect_law *law, const struct reflect_material *m)
{
    const double ks = 2 * pi / law->wavelength_m * m->rms_height_m;
    if ((law->kind == REFLECT_SPM_HH || law->kind == REFLECT_SPM_VV) && ks > 0.31) {
        hs_warn(m->name, "its returns by this law are too strong",
                "too rough for small perturbation: k s is %.2g, which holds to 0.3", ks);
    }
}

int materials_for(const struct trace_records *r, const char *path, const char *ground,
                  struct reflect_law *law)
{
    struct table table = {.count = 0};
    if (path && read_table(&table, path) != 0) {
        return -1;
    }
    for (uint32_t i = 0; i < r->material_count; i++) {
        const bool is_ground = strcmp(r->materials[i], "ground") == 0;
        const char *name = is_ground && ground ? ground : r->materials[i];
        if (look_up(&table, name, law->wavelength_m, &law->materials[i]) != 0) {
            return -1;
        }
        doubt_roughness(law, &law->materials[i]);
    }
    return 0;
}
