/* Class kind: what a land cover class of the map is to the radar, apart from its brightness.
 *
 * The kind decides edges (lm/illumination.h) and gain (lm/class_gain.h). The numbers are those of
 * the image's class table: docs/FORMATS.md, 1.3. */
#ifndef LM_CLASS_KIND_H
#define LM_CLASS_KIND_H

enum lm_class_kind {
    LM_KIND_GROUND = 0,    /* no edges */
    LM_KIND_WATER = 1,     /* follows the sea state; ground behind it has a bright shore */
    LM_KIND_STRUCTURE = 2, /* leading edge */
    LM_KIND_TREES = 3,     /* leading edge */
    LM_KINDS
};

#endif
