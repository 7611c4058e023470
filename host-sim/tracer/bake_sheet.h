/* Sheet of a signature: its chips as a picture to look at. */
#ifndef TRACER_BAKE_SHEET_H
#define TRACER_BAKE_SHEET_H

#include "hs/signature_file.h"

/* Draw up to eight aspects, evenly around, of each depression: the far row on top, grey by level,
 * 50 dB from the brightest pixel of the signature down; shadow blue, other ground green. Returns 0,
 * or -1 with the error reported. */
int bake_sheet(const struct db_signature *s, const char *path);

#endif
