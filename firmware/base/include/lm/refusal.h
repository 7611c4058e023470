/* Refusal: why the unit does not do what a control asks for. */
#ifndef LM_REFUSAL_H
#define LM_REFUSAL_H

enum lm_refusal {
    LM_REFUSED_NOT,    /* the control was carried out */
    LM_REFUSED_VALUE,  /* a number is outside its range, or mode and field of view lack it */
    LM_REFUSED_PAGE,   /* the page that is shown has no cursor */
    LM_REFUSED_CURSOR, /* the cursor is not placed yet */
    LM_REFUSED_SILENT, /* the operator silences the radar */
    LM_REFUSED_MAP,    /* there is no usable map */
    LM_REFUSED_NAV,    /* position, height, heading or velocity is not good */
    LM_REFUSED_CELL,   /* the table's patches have no such cells */
    LM_REFUSED_NEAR,   /* the patch is too near, or would reach too near */
    LM_REFUSED_FAR,    /* the patch is too far */
    LM_REFUSED_HEIGHT, /* the commanded antenna is too high or too low */
    LM_REFUSED_SQUINT, /* the line of sight is too near to the track, ahead or astern */
    LM_REFUSED_GIMBAL, /* the patch is farther off the nose than the antenna turns */
    LM_REFUSED_DWELL,  /* the dwell would be too long */
    LM_REFUSED_SWAP,   /* there is no other display, it is silent, or it refuses */
    LM_REFUSED_POLE,   /* the patch is too near to a pole */
    LM_REFUSALS
};

/* The word for a reason, at most eight characters, in static memory; "" for LM_REFUSED_NOT and for
 * numbers that are no reason. */
const char *lm_refusal_word(enum lm_refusal reason);

#endif
