/* Palette: the colours of greys and symbols on the glass, by tint, day or night, and three
 * rockers. */
#ifndef LM_PALETTE_H
#define LM_PALETTE_H

#include <stdbool.h>
#include <stdint.h>

enum lm_tint { LM_TINT_GREY, LM_TINT_GREEN, LM_TINT_AMBER, LM_TINTS };

/* Steps of the rockers. Zero is the glass as it was delivered. */
enum { LM_ROCKER_STEPS = 8 };

struct lm_palette_config {
    uint8_t tint; /* enum lm_tint */
    bool is_night;
    int8_t brightness; /* -8..8, twelve greys a step */
    int8_t contrast;   /* -8..8, a factor of the eighth root of four a step */
    int8_t symbology;  /* -8..8, a tenth of the symbols' light a step; they never go out */
};

struct lm_palette {
    uint32_t picture[256]; /* colour of each grey, 0x00RRGGBB */
    uint32_t symbol;
    uint32_t faint;   /* of what may be overlooked: sweep, scales */
    uint32_t warning; /* not dimmed by the symbology rocker */
    uint32_t ink;     /* of text on a field of `symbol`, and of the ground behind text */
};

/* Values outside their range count as the nearest inside. Cost: about 10 k instructions; done when
 * a rocker moves. */
void lm_palette_set(struct lm_palette *p, const struct lm_palette_config *config);

#endif
