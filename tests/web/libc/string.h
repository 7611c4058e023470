/* The part of <string.h> that the golden flights use, where there is no C library. */
#include "fx/mem.h"
