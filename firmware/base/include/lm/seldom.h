/* Seldom: what is called when a picture begins, and not for its lines. Compilers make it for size,
 * whatever they make of the rest of its file, and out of the way of that. */
#ifndef LM_SELDOM_H
#define LM_SELDOM_H

#define LM_SELDOM __attribute__((noinline, cold))

#endif
