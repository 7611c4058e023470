/* Taylor weighting of an aperture or a band. */
#ifndef HS_TAYLOR_H
#define HS_TAYLOR_H

/* Weights for `count` values, the middle ones largest (T. T. Taylor, "Design of line-source
 * antennas for narrow beamwidth and low side lobes", IRE Trans. AP-3, 1955; the cosine series as in
 * Carrara, Spotlight Synthetic Aperture Radar, appendix D). `sidelobe_db` > 0; 0 gives ones. */
void hs_taylor(double *weight, int count, double sidelobe_db, int n_bar);

#endif
