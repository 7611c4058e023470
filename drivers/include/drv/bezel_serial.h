/* Serial bezel: a bezel behind a serial line, as struct lm_controls. Each action of the operator is
 * a line of text, framed like a sentence of NMEA 0183:
 *
 *   $D12*47        button 12 (1..LM_BUTTONS) goes down
 *   $U12*56        button 12 goes up
 *   $K-500*53      range knob, -1000..1000
 *   $S100,-20*61   cursor to the right and up, -1000..1000 each
 *   $T*54          designate
 *   $X*58          drop
 *
 * After '*' come two hexadecimal digits, the exclusive-or of the characters between '$' and '*';
 * then carriage return, line feed, or both. Anything else is counted and skipped up to the next
 * '$'. No good line is lost with it. */
#ifndef DRV_BEZEL_SERIAL_H
#define DRV_BEZEL_SERIAL_H

#include "lm/controls.h"
#include "lm/port.h"

enum { DRV_BEZEL_LINE = 16 }; /* most characters between '$' and '*' */

struct drv_bezel_serial {
    int (*get)(void *line); /* the next byte received, or -1 */
    void *line;             /* borrowed as long as the port is used */
    char text[DRV_BEZEL_LINE];
    uint8_t length, sum, digits, sum_told;
    uint8_t part; /* part of the sentence that is expected next: enum in the source */
    struct lm_controls
        port; /* hand this to the firmware; its ctx is this struct, which must not move */
    struct {
        uint32_t sentences, malformed;
    } count;
};

/* Begin between two sentences. `get` returns the next byte received on `line`, or -1, and must not
 * wait; `line` stays borrowed. */
void drv_bezel_serial_init(struct drv_bezel_serial *b, int (*get)(void *line), void *line);

/* Parse the `length` characters between '$' and '*'. False, and *control unspecified, if they are
 * no control. */
bool drv_bezel_parse(const char *text, uint32_t length, struct lm_control *control);

#endif
