/* gprojt_fuzz.h - for the fuzz_*.c: bytes that choose, checks that abort, and a main for programs without libFuzzer: it
   replays kept inputs, the lines of corpus/NAME.hex in hexadecimal digits. fuzz_NAME.c defines GPROJT_FUZZ "NAME". */
#ifndef GPROJT_FUZZ_H
#define GPROJT_FUZZ_H

#include "gprojt_form.h"
#include "gprojt_inside.h"

int LLVMFuzzerTestOneInput(const uint8_t *data, size_t size);

#define GPROJT_MUST(condition)                                           \
    do {                                                                 \
        if (!(condition)) gprojt_broken(__FILE__, __LINE__, #condition); \
    } while (0)

static inline void gprojt_broken(const char *file, int line, const char *what) {
    fprintf(stderr, "%s:%d: %s\n", file, line, what);
    abort();
}

/* Any error: one sentence, and an index only with a place, or if it is what was wrong. */
static inline void gprojt_check_error(const gproj_error *error) {
    size_t length = strlen(error->message);
    GPROJT_MUST((error->code == GPROJ_OK) == (length == 0) && length < GPROJ_MESSAGE_SIZE);
    GPROJT_MUST(!strchr(error->message, '\n'));
    GPROJT_MUST(error->place != GPROJ_PLACE_NONE || error->index == -1 || error->code == GPROJ_OK ||
                error->code == GPROJ_ERROR_INDEX);
}

/* -- an input that is read byte by byte; behind its end are zeros -- */

typedef struct gprojt_input {
    const uint8_t *data;
    size_t size, at;
} gprojt_input;

static inline int gprojt_next(gprojt_input *in) { return in->at < in->size ? in->data[in->at++] : 0; }
static inline int32_t gprojt_next_of(gprojt_input *in, int32_t count) {
    return count > 0 ? (gprojt_next(in) + (count > 256 ? 256 * gprojt_next(in) : 0)) % count : 0;
}

/* Mostly numbers like those of models, seldom extreme ones, and with `wrong` those that are none. */
static inline double gprojt_next_number(gprojt_input *in, bool wrong) {
    static const double extreme[] = {0,    -0.0, 1e-300, 1e-20, 1e-9, 1e9,    1e20,    1e49,
                                     1e60, 1e69, 1e90,   1e300, -1,   -1e300, DBL_MIN, DBL_MAX};
    static const double none[] = {NAN, INFINITY, -INFINITY};
    int kind = gprojt_next(in);
    if (wrong && kind >= 250) return none[kind % 3];
    if (kind >= 224) return extreme[kind % 16];
    return ((kind & 1 ? 256.0 * gprojt_next(in) : 0) + gprojt_next(in) - 128) / (kind & 2 ? 16 : 1000);
}

static inline void gprojt_next_numbers(gprojt_input *in, double *numbers, int32_t count, bool wrong) {
    int32_t i;
    for (i = 0; i < count; ++i) numbers[i] = gprojt_next_number(in, wrong);
}

/* -- a main that replays files -- */

#ifndef GPROJT_LIBFUZZER
static int gprojt_digit(int c) {
    const char *digits = "0123456789abcdef", *found = c > 0 ? strchr(digits, c) : NULL;
    return found ? (int)(found - digits) : -1;
}

/* Runs each line of a file; returns their number. */
static long gprojt_replay(const char *path) {
    uint8_t *data = (uint8_t *)malloc(1 << 16), *exact;
    FILE *file = fopen(path, "r");
    size_t size = 0;
    long lines = 0;
    int c, high = -1;
    if (!file || !data) abort();
    while ((c = fgetc(file)) != EOF) {
        int digit = gprojt_digit(c);
        if (digit >= 0 && high < 0)
            high = digit;
        else if (digit >= 0 && size < 1 << 16)
            data[size++] = (uint8_t)(16 * high + digit), high = -1;
        if (c != '\n') continue;
        exact = (uint8_t *)malloc(size + 1); /* so that a sanitizer sees its end */
        if (!exact) abort();
        memcpy(exact, data, size);
        fprintf(stderr, "%s:%ld\n", path, ++lines); /* for who reads the log of a crash */
        LLVMFuzzerTestOneInput(exact, size);
        free(exact);
        size = 0, high = -1;
    }
    fclose(file);
    free(data);
    return lines;
}

/* Without arguments the kept inputs, else those in other files. */
int main(int argc, char **argv) {
    long lines = 0;
    int i;
    if (argc < 2) lines = gprojt_replay("corpus/" GPROJT_FUZZ ".hex");
    for (i = 1; i < argc; ++i) lines += gprojt_replay(argv[i]);
    printf("%ld passed, %d failed\n", lines, lines == 0);
    return lines == 0;
}
#endif

#endif
