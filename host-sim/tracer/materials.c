#include "tracer/materials.h"

#include "hs/error.h"
#include "hs/input_file.h"
#include "hs/report.h"

#include <errno.h>
#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

/* X band. None of it is measured: values to look at pictures with, to be learned or replaced.
 * Permittivity of moist soil about 6 - i, of rubber about 3 (usual handbook values). The ground's
 * roughness is as high as the small-perturbation method holds, k s = 0.3 (Ulaby, Moore, Fung,
 * volume II, 12-5), and its spectrum exponential, as bare soils mostly have it (Oh, Sarabandi,
 * Ulaby, IEEE Trans. Geoscience and Remote Sensing 30, 1992). */
static const struct reflect_material built_in[] = {
    {"metal", 1, 1e7, 0.0002, 0.02, 0.9, 0.005, 0.03, 1, REFLECT_GAUSSIAN},
    {"ground", 6, 1, 0.0015, 0.02, 0.3, 0.02, 0.03, 1, REFLECT_EXPONENTIAL},
    {"rubber", 3, 0.1, 0.001, 0.02, 0.2, 0.02, 0.03, 1, REFLECT_GAUSSIAN},
};
enum { BUILT_IN = sizeof built_in / sizeof built_in[0], FILE_MAX = 256 };

struct table {
    struct reflect_material rows[FILE_MAX];
    int count;
};

static const struct reflect_material *find(const struct reflect_material *rows, int count,
                                           const char *name)
{
    for (int i = 0; i < count; i++) {
        if (strcmp(rows[i].name, name) == 0) {
            return &rows[i];
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
    return NULL;
}

/* The last word may be missing: Gaussian, as files had it before. */
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
    const int read = sscanf(line, "%31s %lf %lf %lf %lf %lf %lf %lf %lf %15s %c", m->name,
                            &m->permittivity, &m->loss, &m->rms_height_m, &m->correlation_m,
                            &m->specular, &m->roughness, &m->diffuse, &m->brilliance, word, &extra);
    if (read != 9 && read != 10) {
        return "expected a name, eight numbers and a spectrum";
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

int materials_for(const struct trace_records *r, const char *path, struct reflect_law *law)
{
    struct table table = {.count = 0};
    if (path && read_table(&table, path) != 0) {
        return -1;
    }
    for (uint32_t i = 0; i < r->material_count; i++) {
        const char *name = r->materials[i];
        const struct reflect_material *m = find(table.rows, table.count, name);
        m = m ? m : find(built_in, BUILT_IN, name);
        if (!m) {
            return hs_error(name, "add it to the file of --materials",
                            "a material of the model that no table has");
        }
        law->materials[i] = *m;
    }
    return 0;
}

static void report_material(const struct reflect_material *m)
{
    hs_report_object(NULL);
    hs_report_put("name", m->name);
    hs_report_put("permittivity", m->permittivity);
    hs_report_put("loss", m->loss);
    hs_report_put("rms_height_m", m->rms_height_m);
    hs_report_put("correlation_m", m->correlation_m);
    hs_report_put("specular", m->specular);
    hs_report_put("roughness", m->roughness);
    hs_report_put("diffuse", m->diffuse);
    hs_report_put("brilliance", m->brilliance);
    hs_report_text("spectrum", reflect_spectrum_names[m->spectrum]);
    hs_report_close();
}

void materials_print(void)
{
    puts("# NAME PERMITTIVITY LOSS RMS_HEIGHT_M CORRELATION_M F_S F_R F_D F_B SPECTRUM");
    hs_report_array("materials");
    for (int i = 0; i < BUILT_IN; i++) {
        const struct reflect_material *m = &built_in[i];
        report_material(m);
        printf("%s %g %g %g %g %g %g %g %g %s\n", m->name, m->permittivity, m->loss,
               m->rms_height_m, m->correlation_m, m->specular, m->roughness, m->diffuse,
               m->brilliance, reflect_spectrum_names[m->spectrum]);
    }
    hs_report_close();
}
