/* gprojt_whole.h - the whole header for programs that are linked with the library and test internal functions, too: included
   ahead of everything by the compiler's option -include. build/whole.h is a copy of the header in which GPROJT_INTERNAL
   declares internal functions, and public ones in static mode. */
#ifdef GUIDEDPROJ_IMPLEMENTATION /* the library exports all functions */
#define GPROJT_INTERNAL __attribute__((unused, noinline)) extern
#else /* a program reads the functions' bodies, but has no code of them */
#define GPROJ_STATIC
#define GPROJT_INTERNAL __attribute__((unused, gnu_inline)) extern inline
#endif
#include "build/whole.h"
