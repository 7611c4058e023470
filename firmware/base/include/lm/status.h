/* Status: result of the firmware's functions that can fail.
 *
 * Zero is success and failures are small negative numbers, so one int carries a count or a failure.
 * A caller's mistake has no status: contracts exclude it. */
#ifndef LM_STATUS_H
#define LM_STATUS_H

enum lm_status {
    LM_OK = 0,
    LM_BUSY = 1,           /* not an error: not done yet, ask again later */
    LM_ERR_IO = -1,        /* the device failed */
    LM_ERR_CORRUPT = -2,   /* a checksum or a bound does not hold */
    LM_ERR_VERSION = -3,   /* a format that this firmware does not know */
    LM_ERR_RANGE = -4,     /* a number outside the range that the header states */
    LM_ERR_NO_MEMORY = -5, /* the board lent too little memory */
    LM_ERR_TABLE = -6,     /* the radar table breaks its contract: lm_radar_check names the field */
    LM_ERR_SENSOR = -7     /* the image is of another band than the radar */
};

#endif
