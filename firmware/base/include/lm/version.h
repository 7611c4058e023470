/* Version of the firmware, as the BIT page and the bus state it. */
#ifndef LM_VERSION_H
#define LM_VERSION_H

#define LM_VERSION        "0.2" /* major.minor, on the BIT page */
#define LM_VERSION_NUMBER 0x02  /* major * 16 + minor, in the answer to a bus query */

#endif
