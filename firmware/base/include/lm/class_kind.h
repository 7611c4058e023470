/* Kinds of land cover: what a class of the map is to the radar, apart from how bright it is. */
#ifndef LM_CLASS_KIND_H
#define LM_CLASS_KIND_H

enum lm_class_kind {
    LM_KIND_GROUND = 0,
    LM_KIND_WATER = 1,
    LM_KIND_STRUCTURE = 2,
    LM_KIND_TREES = 3,
    LM_KINDS
};

#endif
