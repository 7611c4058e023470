/* Power State Coordination Interface (PSCI, Arm DEN0022): services of the boot firmware at EL3. */
#ifndef ZCU102_PSCI_H
#define ZCU102_PSCI_H

#include <stdint.h>

_Noreturn void zcu102_power_off(void);
_Noreturn void zcu102_reset(void);

/* Start another core at `entry`, with the MMU off and `context` in x0. Returns 0 or a negative
 * error. */
int64_t zcu102_core_on(uint64_t core, uint64_t entry, uint64_t context);

#endif
