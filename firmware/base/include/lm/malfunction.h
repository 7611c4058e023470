/* Malfunctions: what an exercise breaks in the radar, one amount for each kind. Nothing here is a
 * true fault, and no true fault is hidden by one. Laws: docs/EQUATIONS.md, "Malfunctions". */
#ifndef LM_MALFUNCTION_H
#define LM_MALFUNCTION_H

#include <stdbool.h>
#include <stddef.h>
#include <stdint.h>

/* Kinds, in the order of the bus's numbers, with what the amount is and its range. */
enum lm_malfunction {
    LM_MALFUNCTION_NO_TRANSMIT,   /* - */
    LM_MALFUNCTION_WEAK_TRANSMIT, /* loss of the signal, 0..60 dB */
    LM_MALFUNCTION_NOISE,         /* rise of the receiver's noise, 0..60 dB */
    LM_MALFUNCTION_STUCK,     /* azimuth at which the antenna stands, from the nose, +-180 deg */
    LM_MALFUNCTION_DRIFT,     /* angle by which azimuths are shown too far right, +-180 deg */
    LM_MALFUNCTION_LOST_FROM, /* left edge of a lost sector, from the nose, +-180 deg */
    LM_MALFUNCTION_LOST_TO,   /* its right edge */
    LM_MALFUNCTION_FROZEN,    /* - */
    LM_MALFUNCTION_TILT,      /* angle by which the beam is too high, +-30 deg */
    LM_MALFUNCTION_KEY,       /* button that is dead, 1..LM_BUTTONS */
    LM_MALFUNCTIONS
};

/* The malfunctions in force. Zeros: none. */
struct lm_malfunctions {
    uint32_t set; /* bit n: kind n is in force */
    int32_t amount_q8[LM_MALFUNCTIONS];
};

/* Loss of the signal without a transmitter: nothing of it is left above the noise. */
enum { LM_NO_TRANSMIT_DB_Q8 = 96 * 256 };

static inline bool lm_malfunction_is(const struct lm_malfunctions *m, enum lm_malfunction kind)
{
    return m != NULL && (m->set >> kind & 1) != 0;
}

/* The amount of a kind, 0 if it is not in force. `m` may be NULL: none is. */
static inline int32_t lm_malfunction_q8(const struct lm_malfunctions *m, enum lm_malfunction kind)
{
    return lm_malfunction_is(m, kind) ? m->amount_q8[kind] : 0;
}

/* The same of a kind in degrees: signed BAM, of which 2^24 / 360 are 1/256 degree. */
static inline int32_t lm_malfunction_bam(const struct lm_malfunctions *m, enum lm_malfunction kind)
{
    return (int32_t)((int64_t)lm_malfunction_q8(m, kind) * (1 << 24) / 360);
}

/* Loss of the signal, 0 or more. */
static inline int32_t lm_malfunction_loss_db_q8(const struct lm_malfunctions *m)
{
    return lm_malfunction_is(m, LM_MALFUNCTION_NO_TRANSMIT)
               ? LM_NO_TRANSMIT_DB_Q8
               : lm_malfunction_q8(m, LM_MALFUNCTION_WEAK_TRANSMIT);
}

#endif
