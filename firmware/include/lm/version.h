/* Which firmware this is, as the BIT page says it. */
#ifndef LM_VERSION_H
#define LM_VERSION_H

#define LM_VERSION "0.1"

#endif
