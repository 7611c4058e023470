/* landmass-scene: the built-in scene, so that everything can be tried without anybody's data. */
#include "hs/atomic_file.h"
#include "hs/error.h"
#include "hs/options.h"
#include "hs/report.h"
#include "scene/exemplars.h"
#include "scene/output.h"

#include <errno.h>
#include <gdal.h>
#include <stdbool.h>
#include <stdio.h>
#include <string.h>
#include <sys/stat.h>

static const struct hs_usage usage = {
    "", "invent a piece of country and write it as a database builder gets it",
    "The country is a multispectral image, terrain, and exemplars picked by a photo-analyst. It is "
    "designed for 12.8 km (size times cell): coast with a bay and a harbour, town, airfield, river "
    "with bridges, lake, farmland, woods, hills of 500 m. Less shows its middle, more shows what "
    "lies around. The CRS is UTM 26N, in the open Atlantic."};

static const char files_help[] =
    "  image.tif          6 bands like Landsat TM 1-5 and 7, uint16 reflectance times 10000\n"
    "  terrain.tif        metres above the sea, float, posts 25 m apart\n"
    "  exemplars.geojson  polygons with the property class: soil, asphalt, concrete,\n"
    "                     structure, vegetation or water\n"
    "  truth.tif          the true class of every pixel, 0..5 in that order\n"
    "  heights.tif        metres that structures and trees stand above the terrain, float\n"
    "  detail.txt         footprints of buildings, fences, wires, masts (landmass-db build\n"
    "                     --detail)\n"
    "  scene.txt          what it is, and where its places are\n";

struct command {
    const char *folder;
    long seed, size;
    double cell_m;
    bool has_preview, has_shares;
};

static bool parse_command(struct command *c, int argc, char **argv, int *exit_code)
{
    *c = (struct command){.seed = 1, .size = 2560, .cell_m = 5};
    const struct hs_option options[] = {
        {"out", HS_FOLDER, &c->folder, 0, 0, "DIR", "folder for the files, made if it is not there",
         true},
        {"seed", HS_INTEGER, &c->seed, 0, 9007199254740991.0, "N",
         "another country; the same seed gives the same pixels anywhere", false},
        {"size", HS_INTEGER, &c->size, 64, 8192, "N", "pixels on a side", false},
        {"cell", HS_REAL, &c->cell_m, 1, 50, "M", "size of a pixel in metres", false},
        {"preview", HS_FLAG, &c->has_preview, 0, 0, NULL,
         "also write preview.png (colours), truth.png (classes), terrain.png (relief)", false},
        {"shares", HS_FLAG, &c->has_shares, 0, 0, NULL,
         "also write shares.tif: how many of the four parts of a pixel belong to each class",
         false},
        {"Files", HS_HEADING, NULL, 0, 0, NULL, files_help, false},
    };
    return hs_options_read(&usage, options, sizeof options / sizeof options[0], argc, argv,
                           exit_code);
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

static int write_shares(const struct scene *s, const struct picture *p, const char *path)
{
    (void)p;
    return output_shares(s, path);
}

static int write_files(const struct command *c, const struct scene *s, const struct picture *p)
{
    const struct {
        const char *name;
        picture_writer *write;
        bool is_wanted;
    } files[] = {
        {"image.tif", output_image, true},
        {"terrain.tif", write_terrain, true},
        {"truth.tif", output_truth, true},
        {"heights.tif", output_heights, true},
        {"exemplars.geojson", exemplars_write, true},
        {"detail.txt", write_detail, true},
        {"preview.png", output_preview_image, c->has_preview},
        {"truth.png", output_preview_truth, c->has_preview},
        {"terrain.png", write_preview_terrain, c->has_preview},
        {"shares.tif", write_shares, c->has_shares},
        {"scene.txt", write_description, true},
    };
    for (size_t i = 0; i < sizeof files / sizeof *files; i++) {
        char path[4096];
        if (snprintf(path, sizeof path, "%s/%s", c->folder, files[i].name) >= (int)sizeof path) {
            return hs_error("--out", "choose a shorter one", "the name of the folder is too long");
        }
        if (files[i].is_wanted && files[i].write(s, p, path) != 0) {
            return -1;
        }
    }
    return 0;
}

static int run(const struct command *c)
{
    struct scene s = {.seed = (uint64_t)c->seed, .size = (int)c->size, .cell_m = c->cell_m};
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
    hs_outputs_together();
    struct command c;
    int exit_code;
    if (parse_command(&c, argc, argv, &exit_code)) {
        GDALAllRegister();
        exit_code = run(&c) == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
    }
    return hs_report_end(exit_code);
}
