/* stdlib.h - as Microsoft's declares it, as far as tests and library use it. */
#pragma once
#include <stddef.h>
#define RAND_MAX 0x7fff
#ifdef __cplusplus
extern "C" {
#endif
void *malloc(size_t), *calloc(size_t, size_t), *realloc(void *, size_t);
void free(void *), qsort(void *, size_t, size_t, int (*)(const void *, const void *));
__declspec(noreturn) void abort(void);
__declspec(noreturn) void exit(int);
int abs(int), atoi(const char *);
long strtol(const char *, char **, int);
double strtod(const char *, char **);
char *getenv(const char *);
#ifdef __cplusplus
}
#endif
