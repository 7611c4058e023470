/* Palette: colours of greys and symbols on the glass, set by tint, day or night, and three
 * rockers. */
#ifndef LM_PALETTE_H
#define LM_PALETTE_H

#include <stdbool.h>
#include <stdint.h>

enum lm_tint { LM_TINT_GREY, LM_TINT_GREEN, LM_TINT_AMBER, LM_TINTS };

/* Steps of a rocker up and down from 0, its delivered setting. */
enum { LM_ROCKER_STEPS = 8 };

struct lm_palette_config {
    uint8_t tint; /* enum lm_tint */
    bool is_night;
    int8_t brightness; /* -8..8, of twelve greys */
    int8_t contrast;   /* -8..8, each a factor of the eighth root of four */
    int8_t symbology;  /* -8..8, of a tenth of the symbols' light; they never go dark */
};

struct lm_palette {
    uint32_t picture[256]; /* colour of each grey, 0x00RRGGBB */
    uint32_t symbol;       /* of symbols and text */
    uint32_t faint;        /* of unimportant symbols: sweep, scales */
    uint32_t warning;      /* of warnings; the symbology rocker does not dim it */
    uint32_t ink;          /* of inverse text, and of the ground behind text */
};

/* Compute the palette. Values outside their range count as the nearest inside. Cost: about 10,000
 * instructions; called when a rocker moves. */
void lm_palette_set(struct lm_palette *p, const struct lm_palette_config *config);

#endif
