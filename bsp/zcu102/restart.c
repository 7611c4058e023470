#include "restart.h"

#include "fx/crc32c.h"
#include "psci.h"
#include "sections.h"

#include <stddef.h>

struct kept {
    struct zcu102_restart record;
    uint32_t magic, checksum; /* magic: chance alone must not make a record of what power-on left */
};

enum { MAGIC = 0x4C4D5253 };

static ZCU102_KEPT struct kept kept;

static uint32_t checksum(void)
{
    return fx_crc32c(0, &kept, offsetof(struct kept, checksum));
}

struct zcu102_restart zcu102_last_restart(void)
{
    const bool is_kept =
        kept.magic == MAGIC && kept.checksum == checksum() && kept.record.cause < ZCU102_CAUSES;
    return is_kept ? kept.record : (struct zcu102_restart){.cause = ZCU102_POWER_ON};
}

_Noreturn void zcu102_restart(enum zcu102_cause cause, uint64_t pc, uint64_t syndrome,
                              uint64_t address)
{
    const uint32_t count = zcu102_last_restart().count + 1;
    kept.record = (struct zcu102_restart){cause, count, pc, syndrome, address};
    kept.magic = MAGIC;
    kept.checksum = checksum();
    /* Out of the cache, which the reset empties. The record is smaller than its alignment. */
    __asm__ volatile("dc cvac, %0\n\tdsb sy" : : "r"(&kept) : "memory");
    zcu102_reset();
}

const char *zcu102_cause_words(uint32_t cause)
{
    static const char *const words[ZCU102_CAUSES] = {
        [ZCU102_POWER_ON] = "POWER ON", [ZCU102_EXCEPTION] = "EXCEPTION",
        [ZCU102_NO_STEP] = "HUNG STEP", [ZCU102_NO_FRAME] = "NO FRAME",
        [ZCU102_NO_BUS] = "NO BUS",
    };
    return words[cause < ZCU102_CAUSES ? cause : ZCU102_POWER_ON];
}
