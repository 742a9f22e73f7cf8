/* guidedproj.c - the library as one translation unit, for packages. */
#define GUIDEDPROJ_IMPLEMENTATION
#include "guidedproj.h"
