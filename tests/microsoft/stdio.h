/* stdio.h - as Microsoft's declares it, as far as tests and library use it. */
#pragma once
#include <stdarg.h>
#include <stddef.h>
typedef struct _iobuf {
    void *_Placeholder;
} FILE;
#define EOF (-1)
#define SEEK_SET 0
#define SEEK_END 2
#define stdin (__acrt_iob_func(0))
#define stdout (__acrt_iob_func(1))
#define stderr (__acrt_iob_func(2))
#ifdef __cplusplus
extern "C" {
#endif
FILE *__acrt_iob_func(unsigned), *fopen(const char *, const char *), *tmpfile(void);
int fclose(FILE *), fflush(FILE *), ferror(FILE *), feof(FILE *), fgetc(FILE *), fputc(int, FILE *),
    fputs(const char *, FILE *);
int puts(const char *), printf(const char *, ...), fprintf(FILE *, const char *, ...), remove(const char *);
int rename(const char *, const char *), fseek(FILE *, long, int), snprintf(char *, size_t, const char *, ...);
int vsnprintf(char *, size_t, const char *, va_list), sprintf(char *, const char *, ...),
    sscanf(const char *, const char *, ...);
long ftell(FILE *);
size_t fread(void *, size_t, size_t, FILE *), fwrite(const void *, size_t, size_t, FILE *);
char *fgets(char *, int, FILE *);
#ifdef __cplusplus
}
#endif
