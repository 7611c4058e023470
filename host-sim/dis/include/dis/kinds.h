/* Kinds: which live target an entity of a DIS type becomes. One is built in; another is a text, a
 * rule a line:
 *
 *     # kind.domain.country.category.subcategory.specific.extra
 *     1.1.222.6     kind car rcs 9 signature 2
 *     1.1.*.24-26   kind train
 *     1.2           kind fighter height
 *     4             skip
 *
 * A field is a number, a range or *; what is left out behind is any. The first rule that fits an
 * entity decides. Words: `kind NAME`; `rcs DBSM` (-40..60) in place of the kind's; `signature N`,
 * the N-th of the display's image (1..255), or the reply of a beacon; `ground` or `height`, whether
 * the target stands on the map's surface or at the height that the entity tells; `skip`: no target.
 * Without a word for it, entities of domain 1 and 3, land and surface, stand on the ground. */
#ifndef DIS_KINDS_H
#define DIS_KINDS_H

#include "dis/pdu.h"

#include <math.h>
#include <stdio.h>

enum { DIS_RULES_MAX = 1024, DIS_RULE_FIELDS = 7, DIS_TARGET_KINDS = 18 };

/* What an entity becomes. */
struct dis_kind {
    uint8_t kind;      /* number of the bus, 0..17: dis_kind_name */
    uint8_t signature; /* 0: none */
    double rcs_dbsm;   /* NAN: that of the kind */
    bool is_skipped, is_on_ground;
};

struct dis_rule {
    uint16_t low[DIS_RULE_FIELDS], high[DIS_RULE_FIELDS];
    struct dis_kind kind;
    bool has_surface;  /* `ground` or `height` was said */
    int line;          /* of the text */
    uint64_t entities; /* that it decided about; counted by who uses the table */
};

struct dis_kinds {
    struct dis_rule rule[DIS_RULES_MAX];
    int count;
};

/* Read a table from a file, or the one that is built in. Returns 0, or -1 with the error reported:
 * a line is wrong, is one too many, or can never decide because one before it fits whatever it
 * fits. */
int dis_kinds_read(struct dis_kinds *kinds, const char *path);
int dis_kinds_read_builtin(struct dis_kinds *kinds);

/* The same from a stream, which stays the caller's; `path` is for messages. */
int dis_kinds_read_stream(struct dis_kinds *kinds, FILE *in, const char *path);

/* The text of the table that is built in. */
const char *dis_kinds_builtin(void);

/* The rule that decides about a type; NULL: none fits. *kind is written if there is one. */
struct dis_rule *dis_kinds_find(struct dis_kinds *kinds, const struct dis_type *type,
                                struct dis_kind *kind);

/* "tracked-armour"; `kind` below DIS_TARGET_KINDS. */
const char *dis_kind_name(uint8_t kind);

#endif
