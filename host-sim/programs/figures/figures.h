/* The figures of landmass-figures. Each writes a PNG file and returns 0, or -1 with the error
 * reported.
 */
#ifndef FIGURES_H
#define FIGURES_H

#define FIGURE_WAVELENGTH_M 0.031228 /* 9.6 GHz, X band */

/* [Heaton], Figure 1: the same corner reflectors by a high- and a low-resolution radar. */
int figure1_draw(const char *path);

/* [Heaton], Table 1: the lobes of flat plates, as printed and as they return. */
int table1_draw(const char *path);

#endif
