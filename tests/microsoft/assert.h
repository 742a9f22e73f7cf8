/* assert.h - as Microsoft's declares it, as far as tests and library use it. */
#include <stdlib.h>
#undef assert
#define assert(condition) ((void)((condition) || (abort(), 0)))
