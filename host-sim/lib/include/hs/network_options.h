/* Values of options that name a network's parts, as `take` of a struct hs_taker (hs/options.h). The
 * context is a `const char *` that gets the text, borrowed. */
#ifndef HS_NETWORK_OPTIONS_H
#define HS_NETWORK_OPTIONS_H

/* A CAN interface, or the name of one in a log: 1 to 15 characters without blanks. */
const char *hs_take_interface(void *context, const char *text);

/* An IPv4 address in dots. */
const char *hs_take_address(void *context, const char *text);

#endif
