/* Level: power of a radar cell's echo in decibels of gamma, `level_db_q8`. Flat ground at the
 * reference elevation has the level of its gamma at any range: docs/EQUATIONS.md, "Level". */
#ifndef LM_LEVEL_H
#define LM_LEVEL_H

#include <stdint.h>

/* Level of a cell in shadow, which has no echo: -128 dB. Lines of levels are held in 16 bits, of
 * which this is the lowest number: what is darker counts as shadow, what is above 128 dB as that.
 */
enum { LM_LEVEL_SHADOW = INT16_MIN };

#endif
