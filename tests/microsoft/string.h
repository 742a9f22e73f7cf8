/* string.h - as Microsoft's declares it, as far as tests and library use it. */
#pragma once
#include <stddef.h>
#ifdef __cplusplus
extern "C" {
#endif
void *memcpy(void *, const void *, size_t), *memmove(void *, const void *, size_t), *memset(void *, int, size_t);
int memcmp(const void *, const void *, size_t), strcmp(const char *, const char *),
    strncmp(const char *, const char *, size_t);
size_t strlen(const char *), strspn(const char *, const char *), strcspn(const char *, const char *);
char *strcpy(char *, const char *), *strcat(char *, const char *);
#ifdef __cplusplus
const void *memchr(const void *, int, size_t);
const char *strchr(const char *, int), *strrchr(const char *, int), *strstr(const char *, const char *);
}
#else
void *memchr(const void *, int, size_t);
char *strchr(const char *, int), *strrchr(const char *, int), *strstr(const char *, const char *);
#endif
