/* Level: power of a radar cell's echo in decibels of gamma, `level_db_q8`. Flat ground at the
 * reference elevation has the level of its gamma at any range: docs/EQUATIONS.md, "Level". */
#ifndef LM_LEVEL_H
#define LM_LEVEL_H

/* Level of a cell in shadow, which has no echo: -128 dB. */
enum { LM_LEVEL_SHADOW = -0x8000 };

#endif
