#include "recording.h"

#include "console.h"
#include "fx/mem.h"

static uint8_t ring[ZCU102_RECORDING_RING];

/* A line fits as a whole, or is lost with all that come after it. */
static void put_line(void *ctx, const char *line, size_t bytes)
{
    struct zcu102_recording *r = ctx;
    if (!r->is_over && (r->lines_lost > 0 || !drv_uart_queue(r->line, line, (uint32_t)bytes))) {
        r->lines_lost++;
    }
}

void zcu102_recording_begin(struct zcu102_recording *r, struct drv_uart *line,
                            struct drv_uart *console, struct lm_board *board)
{
    static const struct record_options options = {
        .check_every = 1, .is_check_of_one_row = true, .has_sums = true};
    struct record_head head;
    memset(r, 0, sizeof *r);
    r->line = line;
    r->console = console;
    r->is_on = true;
    drv_uart_lend(line, ring, sizeof ring);
    if (board->restart) {
        (void)drv_uart_queue(line, "\n", 1); /* of a line that the restart cut */
    }
    record_describe_plain(&head, board, 0);
    record_begin_as(&r->recorder, &(struct record_sink){r, put_line}, board, &head, &options);
}

/* After a loss the lines that wait go first; then there is room for the word that ends it. */
static void end_after_loss(struct zcu102_recording *r)
{
    const uint32_t lost = r->lines_lost;
    r->lines_lost = 0;
    record_cease(&r->recorder, RECORD_BEHIND, lost);
    r->lines_lost = lost;
    r->is_over = true;
    zcu102_print_value(r->console, "recording ended: the line is too slow; lines lost", lost);
}

void zcu102_recording_step(struct zcu102_recording *r, uint64_t now_us)
{
    if (!r->is_on || r->is_over) {
        return;
    }
    if (r->lines_lost > 0 && drv_uart_room(r->line) >= 4 * RECORD_LINE_MAX) {
        end_after_loss(r);
    } else {
        record_step(&r->recorder, now_us);
    }
}
