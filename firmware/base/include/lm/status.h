/* What a function of the firmware answers. Zero is success, failures are small negative numbers, so
 * that one int can carry a count or a failure. A caller's mistake is not a status: it is excluded
 * by contract. */
#ifndef LM_STATUS_H
#define LM_STATUS_H

enum lm_status {
    LM_OK = 0,
    LM_BUSY = 1,           /* not an error: asked again later, it will be done */
    LM_ERR_IO = -1,        /* the device failed */
    LM_ERR_CORRUPT = -2,   /* a checksum or a bound does not hold */
    LM_ERR_VERSION = -3,   /* a format newer than this firmware */
    LM_ERR_RANGE = -4,     /* a number outside what the header promises to take */
    LM_ERR_NO_MEMORY = -5, /* the board lent too little */
    LM_ERR_TABLE = -6      /* the radar table breaks its contract: lm_radar_check names the field */
};

#endif
