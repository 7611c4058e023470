/* A bezel that speaks over a serial line, as struct lm_controls. A line of text for each thing that
 * the operator does, framed as NMEA 0183 frames sentences:
 *
 *   $D12*47        button 12 (1..LM_BUTTONS) goes down
 *   $U12*56        and up
 *   $K-500*53      range knob, -1000..1000
 *   $S100,-20*61   cursor to the right and up, -1000..1000 each
 *   $T*54          designate
 *   $X*58          drop
 *
 * after '*' the exclusive-or of the characters between '$' and '*', in two hexadecimal digits; then
 * carriage return, line feed, or both. What is not such a line is counted and skipped, up to the
 * next '$': it loses nothing but itself. */
#ifndef DRV_BEZEL_SERIAL_H
#define DRV_BEZEL_SERIAL_H

#include "lm/controls.h"
#include "lm/port.h"

enum { DRV_BEZEL_LINE = 16 }; /* characters between '$' and '*' */

struct drv_bezel_serial {
    int (*get)(void *line); /* the next byte received, or -1 */
    void *line;             /* borrowed */
    char text[DRV_BEZEL_LINE];
    uint8_t length, sum, digits, sum_told;
    uint8_t part; /* of the sentence: enum in the source */
    struct lm_controls
        port; /* hand this to the firmware; its ctx is this struct, which must not move */
    struct {
        uint32_t sentences, malformed;
    } count;
};

void drv_bezel_serial_init(struct drv_bezel_serial *b, int (*get)(void *line), void *line);

/* What `length` characters between '$' and '*' mean. False for what means nothing. */
bool drv_bezel_parse(const char *text, uint32_t length, struct lm_control *control);

#endif
