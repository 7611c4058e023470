#include "area_option.h"
#include "commands.h"

#include "hs/error.h"
#include "hs/options.h"
#include "hs/png.h"
#include "hs/report.h"
#include "image/picture.h"

#include <math.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

static const struct hs_usage usage = {"picture", "draw a plane of a database image",
                                      "North is up, and a metre is as long eastward as northward "
                                      "in the middle of the picture. Where a level has no tile\n"
                                      "the next coarser one shows through; no data is black. What "
                                      "the greys or colours mean is printed."};

struct settings {
    const char *plane, *area, *out;
    long level, max_size;
    double black, white;
};

static bool read_settings(struct settings *s, int argc, char **argv, const char **path,
                          int *exit_code)
{
    const struct hs_option options[] = {
        {"FILE", HS_INPUT_ARGUMENT, path, 0, 0, NULL, "the database image", true},
        {"plane", HS_WORD, &s->plane, 0, 0, "reflectivity|class|elevation|height|shade",
         "height: of structures and trees; shade: hills lit from the north-west", true},
        {"out", HS_OUTPUT, &s->out, 0, 0, "P.png", "the picture", true},
        {"level", HS_INTEGER, &s->level, -1, LM_DB_LODS_MAX - 1, "L",
         "level of detail; -1: the finest that fits the picture", false},
        {"area", HS_TEXT, &s->area, 0, 0, "LATS,LONW,LATN,LONE",
         "degrees; left out: all of that level", false},
        {"max-size", HS_INTEGER, &s->max_size, 16, 16384, "PIXELS", "of the longer side", false},
        {"black", HS_REAL, &s->black, -10000, 10000, "VALUE",
         "dB or metres that are drawn black; equal to --white: from the picture itself", false},
        {"white", HS_REAL, &s->white, -10000, 10000, "VALUE", "likewise white", false},
        HS_NEEDS_ROW("black", "white"),
        HS_NEEDS_ROW("white", "black"),
        HS_CLASHES_ROW("black", "plane=class|plane=shade"),
    };
    return hs_options_read(&usage, options, sizeof options / sizeof options[0], argc, argv,
                           exit_code);
}

static int parse_plane(const char *name)
{
    for (int i = 0; i < IMAGE_PLANES; i++) {
        if (strcmp(name, image_plane_names[i]) == 0) {
            return i;
        }
    }
    return hs_error("--plane", "see landmass-db picture --help", "there is no plane \"%s\"", name);
}

static int draw(const struct image *image, const struct settings *s, struct image_view *view)
{
    if (s->level >= image->header.lod_count) {
        return hs_error("--level", "see `landmass-db inspect`", "the image ends at level %u",
                        image->header.lod_count - 1u);
    }
    if (image_view_fit(image, view, (int)s->level, (int)s->max_size) != 0) {
        return -1;
    }
    uint8_t *pixels = malloc(3 * (size_t)view->width * (size_t)view->height);
    if (!pixels) {
        return hs_error(s->out, "choose a smaller --max-size", "out of memory");
    }
    int result = image_view_draw(image, view, pixels);
    if (result == 0 && !view->has_data) {
        result = db_area_is_empty(s->out, view->level);
    }
    if (result == 0) {
        result =
            hs_png_write_rgb(s->out, pixels, view->width, view->height, 3 * (size_t)view->width);
    }
    free(pixels);
    return result;
}

static void print_legend(const struct image *image, const struct image_view *v)
{
    static const char *const units[IMAGE_PLANES] = {"dB", "", "m", "m", ""};
    printf("%s: %d x %d pixels of %.2f m, level %d (cell %.2f m)\n", image_plane_names[v->plane],
           v->width, v->height, v->pixel_m, v->level,
           ldexp(IMAGE_METRES_PER_BAM, image->header.shift0 + v->level));
    printf("area: %.6f,%.6f,%.6f,%.6f\n", image_degrees(v->area.south),
           image_longitude_degrees(v->area.west), image_degrees(v->area.north),
           image_longitude_degrees(v->area.west + (uint32_t)v->area.width));
    if (v->plane == IMAGE_PLANE_CLASS) {
        for (int i = 0; i < LM_DB_CLASS_NONE; i++) {
            const struct lm_class *c = &image->db.classes.entry[i];
            if (c->name[0]) {
                printf("scale: %02x%02x%02x %.16s\n", c->colour[0], c->colour[1], c->colour[2],
                       c->name);
            }
        }
    } else if (v->plane == IMAGE_PLANE_SHADE) {
        printf("scale: flat ground %d, steeper toward the sun lighter, away from it darker\n",
               IMAGE_SHADE_FLAT);
    } else {
        printf("scale: black %.2f %s, white %.2f %s\n", v->black, units[v->plane], v->white,
               units[v->plane]);
    }
}

static void report_picture(const struct image *image, const struct image_view *v)
{
    hs_report_put("plane", image_plane_names[v->plane]);
    hs_report_put("width_px", v->width);
    hs_report_put("height_px", v->height);
    hs_report_put("pixel_m", v->pixel_m);
    hs_report_put("level", v->level);
    hs_report_put("cell_m", ldexp(IMAGE_METRES_PER_BAM, image->header.shift0 + v->level));
    hs_report_object("area");
    hs_report_put("south_deg", image_degrees(v->area.south));
    hs_report_put("west_deg", image_longitude_degrees(v->area.west));
    hs_report_put("north_deg", image_degrees(v->area.north));
    hs_report_put("east_deg", image_longitude_degrees(v->area.west + (uint32_t)v->area.width));
    hs_report_close();
    if (v->plane != IMAGE_PLANE_CLASS && v->plane != IMAGE_PLANE_SHADE) {
        hs_report_put("black", v->black);
        hs_report_put("white", v->white);
    }
    hs_report_put("damaged_tiles", v->damaged_tiles);
}

static int run(const char *path, const struct settings *s)
{
    struct image_view view = {.black = s->black, .white = s->white};
    const int plane = parse_plane(s->plane);
    if (plane < 0 || (s->area && db_area_read(&view.area, s->area) != 0)) {
        return HS_EXIT_USAGE;
    }
    view.plane = (enum image_plane)plane;
    struct image image;
    if (image_open(&image, path) != 0) {
        return HS_EXIT_FAILED;
    }
    const int result = draw(&image, s, &view);
    if (result == 0) {
        print_legend(&image, &view);
        report_picture(&image, &view);
    }
    if (view.damaged_tiles > 0) {
        hs_warn(path, "`landmass-db verify` says more", "%u damaged tiles were left out",
                view.damaged_tiles);
    }
    image_close(&image);
    return result == 0 ? HS_EXIT_OK : HS_EXIT_FAILED;
}

int db_cmd_picture(int argc, char **argv)
{
    struct settings s = {.level = -1, .max_size = 2048};
    const char *path = NULL;
    int exit_code;
    return read_settings(&s, argc, argv, &path, &exit_code) ? run(path, &s) : exit_code;
}
