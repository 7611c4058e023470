#include "hs/network_options.h"

#include <arpa/inet.h>
#include <string.h>

const char *hs_take_interface(void *context, const char *text)
{
    const char **name = context;
    const size_t length = strlen(text);
    if (length < 1 || length > 15 || strpbrk(text, " \t\n/")) {
        return "needs a name of 1 to 15 characters without blanks";
    }
    *name = text;
    return NULL;
}

const char *hs_take_address(void *context, const char *text)
{
    const char **address = context;
    struct in_addr parsed;
    if (inet_pton(AF_INET, text, &parsed) != 1) {
        return "needs an IPv4 address such as 192.168.1.5";
    }
    *address = text;
    return NULL;
}
