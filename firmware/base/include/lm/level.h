/* Levels: what a radar cell returns, as reflectivity in 1/256 dB of gamma (`level_db_q8`). */
#ifndef LM_LEVEL_H
#define LM_LEVEL_H

/* The level of a cell that nothing lights: -128 dB. */
enum { LM_LEVEL_SHADOW = -0x8000 };

#endif
