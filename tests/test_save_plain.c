/* test_save_plain.c - >>file with the calls of the C library alone. */
#define GPROJI_FILES 0
#include "test_save.c"
