/* Which firmware this is, as the BIT page says it. */
#ifndef LM_VERSION_H
#define LM_VERSION_H

#define LM_VERSION        "0.2"
#define LM_VERSION_NUMBER 0x02 /* the same as major * 16 + minor, as the bus is told it */

#endif
