/* The product: the unit on the board, for ever. */
#include "board.h"
#include "console.h"
#include "lm/radar_check.h"

int main(void);

static void report_refusal(struct zcu102 *z, int status)
{
    struct lm_radar_fault fault;
    if (status == LM_ERR_TABLE && lm_radar_check(z->lent.radar, &fault) != LM_OK) {
        zcu102_print(&z->console, "the radar table breaks its contract\n");
        zcu102_print_value(&z->console, fault.field, fault.index);
        zcu102_print(&z->console, fault.needs ? fault.needs : "outside its range");
        zcu102_print(&z->console, "\n");
    } else {
        zcu102_print(&z->console, "the tile memory is too small\n");
    }
}

int main(void)
{
    static struct zcu102 board; /* large, and there is only one */
    zcu102_open(&board);
    const int status = zcu102_start(&board);
    if (status != LM_OK) {
        report_refusal(&board, status);
        return 1;
    }
    zcu102_print(&board.console, board.unit.map.is_usable ? "flying\n" : "no usable database\n");
    for (;;) {
        zcu102_step(&board);
    }
}
