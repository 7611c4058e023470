/* The product: the unit on the board, for ever. */
#include "board.h"
#include "console.h"

int main(void);

int main(void)
{
    static struct zcu102 board; /* large, and there is only one */
    zcu102_open(&board);
    if (zcu102_start(&board) != LM_OK) {
        zcu102_say(&board.console, "the database's coarsest level does not fit the tile memory\n");
        return 1;
    }
    zcu102_say(&board.console, board.unit.has_db ? "flying\n" : "no usable database\n");
    for (;;) {
        zcu102_step(&board);
    }
}
