/* landmass-scene: the built-in scene, so that everything can be tried without anybody's data. */
#include "hs/error.h"
#include "scene/exemplars.h"
#include "scene/output.h"

#include <errno.h>
#include <gdal.h>
#include <getopt.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>

static const char help_text[] =
    "usage: landmass-scene --out DIR [OPTIONS]\n"
    "Invent a piece of country and write it as a database builder gets it: a multispectral\n"
    "image, terrain, and exemplars picked by a photo-analyst.\n"
    "\n"
    "  --out DIR     folder for the files, made if it is not there\n"
    "  --seed N      another country (1); the same seed gives the same pixels anywhere\n"
    "  --size N      pixels on a side, 64..8192 (2560)\n"
    "  --cell M      size of a pixel in metres, 1..50 (5)\n"
    "  --preview     also write preview.png (colours), truth.png (classes), terrain.png (relief)\n"
    "  -h, --help    print this\n"
    "\n"
    "Files:\n"
    "  image.tif          6 bands like Landsat TM 1-5 and 7, uint16 reflectance times 10000\n"
    "  terrain.tif        metres above the sea, float, posts 25 m apart\n"
    "  exemplars.geojson  polygons with the property class: soil, asphalt, concrete,\n"
    "                     structure, vegetation or water\n"
    "  truth.tif          the true class of every pixel, 0..5 in that order\n"
    "  heights.tif        metres that structures and trees stand above the terrain, float\n"
    "  detail.txt         footprints of buildings, fences, wires, masts (landmass-db build "
    "--detail)\n"
    "  scene.txt          what it is, and where its places are\n"
    "The country is designed for 12.8 km (size times cell): coast with a bay and a harbour,\n"
    "town, airfield, river with bridges, lake, farmland, woods, hills of 500 m. Less shows its\n"
    "middle, more shows what lies around. The CRS is UTM 26N, in the open Atlantic.\n"
    "Exit status: 0 done, 1 the work failed, 2 the command line makes no sense.\n";

struct command {
    const char *folder;
    uint64_t seed;
    int size;
    double cell_m;
    bool has_preview;
};

/* The whole of `text` as a number within the limits. */
static int take_number(const char *option, const char *text, double low, double high, double *value)
{
    char *end;
    *value = strtod(text, &end);
    if (end != text && *end == '\0' && *value >= low && *value <= high) {
        return 0;
    }
    return hs_error(option, "see landmass-scene --help", "takes a number from %g to %g, not '%s'",
                    low, high, text);
}

static int take_option(struct command *c, int option, const char *text)
{
    double value;
    switch (option) {
    case 'o':
        c->folder = text;
        return 0;
    case 's':
        if (take_number("--seed", text, 0, 9007199254740991.0, &value) != 0) {
            return -1;
        }
        c->seed = (uint64_t)value;
        return 0;
    case 'n':
        if (take_number("--size", text, 64, 8192, &value) != 0) {
            return -1;
        }
        c->size = (int)value;
        return 0;
    case 'm':
        return take_number("--cell", text, 1, 50, &c->cell_m);
    case 'p':
        c->has_preview = true;
        return 0;
    default:
        return hs_error("command line", "see landmass-scene --help",
                        "has an unknown option, or one without its value");
    }
}

/* Returns 0, or -1 when the command line makes no sense (reported), or 1 after --help. */
static int parse_command(struct command *c, int argc, char **argv)
{
    static const struct option options[] = {
        {"out", required_argument, NULL, 'o'},
        {"seed", required_argument, NULL, 's'},
        {"size", required_argument, NULL, 'n'},
        {"cell", required_argument, NULL, 'm'},
        {"preview", no_argument, NULL, 'p'},
        {"help", no_argument, NULL, 'h'},
        {NULL, 0, NULL, 0},
    };
    *c = (struct command){.seed = 1, .size = 2560, .cell_m = 5};
    opterr = 0;
    for (int option; (option = getopt_long(argc, argv, "h", options, NULL)) != -1;) {
        if (option == 'h') {
            fputs(help_text, stdout);
            return 1;
        }
        if (take_option(c, option, optarg) != 0) {
            return -1;
        }
    }
    if (!c->folder || optind != argc) {
        return hs_error("command line", "see landmass-scene --help",
                        "must name a folder with --out and nothing else");
    }
    return 0;
}

typedef int picture_writer(const struct scene *s, const struct picture *p, const char *path);

static int write_terrain(const struct scene *s, const struct picture *p, const char *path)
{
    (void)p;
    return output_terrain(s, path);
}

static int write_description(const struct scene *s, const struct picture *p, const char *path)
{
    (void)p;
    return output_description(s, path);
}

static int write_detail(const struct scene *s, const struct picture *p, const char *path)
{
    (void)p;
    return output_detail(s, path);
}

static int write_preview_terrain(const struct scene *s, const struct picture *p, const char *path)
{
    (void)p;
    return output_preview_terrain(s, path);
}

static int write_files(const struct command *c, const struct scene *s, const struct picture *p)
{
    static const struct {
        const char *name;
        picture_writer *write;
        bool is_preview;
    } files[] = {
        {"image.tif", output_image, false},
        {"terrain.tif", write_terrain, false},
        {"truth.tif", output_truth, false},
        {"heights.tif", output_heights, false},
        {"exemplars.geojson", exemplars_write, false},
        {"detail.txt", write_detail, false},
        {"preview.png", output_preview_image, true},
        {"truth.png", output_preview_truth, true},
        {"terrain.png", write_preview_terrain, true},
        {"scene.txt", write_description, false},
    };
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        char path[4096];
        if (snprintf(path, sizeof path, "%s/%s", c->folder, files[i].name) >= (int)sizeof path) {
            return hs_error("--out", "choose a shorter one", "the name of the folder is too long");
        }
        if ((c->has_preview || !files[i].is_preview) && files[i].write(s, p, path) != 0) {
            return -1;
        }
    }
    return 0;
}

static int run(const struct command *c)
{
    struct scene s = {.seed = c->seed, .size = c->size, .cell_m = c->cell_m};
    struct picture p = {0};
    if (mkdir(c->folder, 0777) != 0 && errno != EEXIST) {
        return hs_error(c->folder, "choose another folder for --out", "cannot be made: %s",
                        strerror(errno));
    }
    if (scene_make(&s) != 0) {
        return -1;
    }
    int result = render_picture(&s, &p);
    if (result == 0) {
        result = write_files(c, &s, &p);
    }
    render_free(&p);
    scene_free(&s);
    return result;
}

int main(int argc, char **argv)
{
    hs_set_program("landmass-scene");
    struct command c;
    const int parsed = parse_command(&c, argc, argv);
    if (parsed != 0) {
        return parsed > 0 ? HS_EXIT_OK : HS_EXIT_USAGE;
    }
    GDALAllRegister();
    return run(&c) == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
}
