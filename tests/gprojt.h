/* gprojt.h - the tests' own small harness: every test file defines tests and lists them in a main. */
#ifndef GPROJT_H
#define GPROJT_H

#include <float.h>
#include <math.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#include "../guidedproj.h"

/* One test program is one translation unit, so these may be plain statics. */
static int gprojt_failed_checks;
static int gprojt_passed_tests, gprojt_failed_tests, gprojt_skipped_tests;
static const char *gprojt_skip_reason;

/* GPROJT_TEST(name) { ... } defines a test; GPROJT_RUN(name) in main runs it and prints a line. With GPROJT_ONLY in the
   environment it runs only if its name begins so, with GPROJT_EXCEPT, names between spaces, only if it is none of them. */
#define GPROJT_TEST(name) static void gprojt_test_##name(void)
#define GPROJT_RUN(name) gprojt_run(#name, gprojt_test_##name)

/* A failed check is printed and counted; the test goes on. */
#define GPROJT_CHECK(condition)                                        \
    do {                                                               \
        if (!(condition)) gprojt_fail(__FILE__, __LINE__, #condition); \
    } while (0)
/* |a - b| <= bound */
#define GPROJT_NEAR(a, b, bound)                                            \
    do {                                                                    \
        double gprojt_a = (a), gprojt_b = (b);                              \
        if (!(fabs(gprojt_a - gprojt_b) <= (bound))) {                      \
            gprojt_fail(__FILE__, __LINE__, #a " = " #b " within " #bound); \
            printf("    %.17g and %.17g\n", gprojt_a, gprojt_b);            \
        }                                                                   \
    } while (0)
/* Leaves the test at once when the condition fails: for what the rest depends on. */
#define GPROJT_REQUIRE(condition)                        \
    do {                                                 \
        if (!(condition)) {                              \
            gprojt_fail(__FILE__, __LINE__, #condition); \
            return;                                      \
        }                                                \
    } while (0)
/* Ends a test that cannot run here; the reason is printed. */
#define GPROJT_SKIP(reason)            \
    do {                               \
        gprojt_skip_reason = (reason); \
        return;                        \
    } while (0)

static void gprojt_fail(const char *file, int line, const char *what) {
    if (gprojt_failed_checks++ < 20) printf("  %s:%d: %s\n", file, line, what);
}

static int gprojt_is_excepted(const char *name) {
    const char *list = getenv("GPROJT_EXCEPT"), *at = list;
    size_t length = strlen(name);
    while (at && (at = strstr(at, name)) != NULL) {
        if ((at == list || at[-1] == ' ') && (at[length] == ' ' || !at[length])) return 1;
        at += length;
    }
    return 0;
}

static void gprojt_run(const char *name, void (*test)(void)) {
    const char *only = getenv("GPROJT_ONLY");
    if (only && strncmp(name, only, strlen(only)) != 0) return;
    if (gprojt_is_excepted(name)) return;
    gprojt_failed_checks = 0;
    gprojt_skip_reason = NULL;
    test();
    if (gprojt_failed_checks) {
        gprojt_failed_tests++;
        printf("FAIL %s (%d checks)\n", name, gprojt_failed_checks);
    } else if (gprojt_skip_reason) {
        gprojt_skipped_tests++;
        printf("skip %s: %s\n", name, gprojt_skip_reason);
    } else {
        gprojt_passed_tests++;
        printf("ok   %s\n", name);
    }
    fflush(stdout);
}

/* The end of main: one line that the Makefile's runner adds up, and the exit code. */
static int gprojt_report(void) {
    printf("%d passed, %d failed, %d skipped\n", gprojt_passed_tests, gprojt_failed_tests, gprojt_skipped_tests);
    return gprojt_failed_tests != 0;
}

/* A small random generator (splitmix64, Steele, Lea, Flood 2014), the same everywhere. */
static inline uint64_t gprojt_random(uint64_t *state) {
    uint64_t z = (*state += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
}
/* uniform in [0, 1) */
static inline double gprojt_uniform(uint64_t *state) { return (double)(gprojt_random(state) >> 11) * 0x1p-53; }
/* uniform in 0..n-1 */
static inline int32_t gprojt_below(uint64_t *state, int32_t n) { return (int32_t)(gprojt_random(state) % (uint64_t)n); }

/* -- vectors -- */

static inline double gprojt_dot3(const double a[3], const double b[3]) {
    return a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
}
static inline double gprojt_length3(const double a[3]) { return sqrt(gprojt_dot3(a, a)); }
static inline void gprojt_sub3(const double a[3], const double b[3], double out[3]) {
    int k;
    for (k = 0; k < 3; ++k) out[k] = a[k] - b[k];
}
static inline void gprojt_cross3(const double a[3], const double b[3], double out[3]) {
    out[0] = a[1] * b[2] - a[2] * b[1];
    out[1] = a[2] * b[0] - a[0] * b[2];
    out[2] = a[0] * b[1] - a[1] * b[0];
}
static inline double gprojt_far(const double a[3], const double b[3]) {
    double d[3];
    gprojt_sub3(a, b, d);
    return gprojt_length3(d);
}

/* -- memory -- */

/* A host whose allocator counts what is held and fails at one chosen allocation (0: never). */
typedef struct gprojt_failing {
    long held;  /* blocks not yet given back */
    long calls; /* allocations and reallocations so far */
    long fail_at;
    size_t bytes;    /* held, */
    size_t peak;     /* and the most that were */
    int wrong_sizes; /* releases with another size than the block was taken with */
} gprojt_failing;

static inline void *gprojt_failing_allocate(void *user, size_t size) {
    gprojt_failing *f = (gprojt_failing *)user;
    size_t *block;
    if (++f->calls == f->fail_at) return NULL;
    block = (size_t *)malloc(size + 16);
    if (!block) return NULL;
    block[0] = size;
    f->held++;
    f->bytes += size;
    if (f->bytes > f->peak) f->peak = f->bytes;
    return (char *)block + 16;
}
static inline void gprojt_failing_release(void *user, void *block, size_t size) {
    gprojt_failing *f = (gprojt_failing *)user;
    size_t *start = (size_t *)(void *)((char *)block - 16);
    if (start[0] != size) f->wrong_sizes++;
    f->held--;
    f->bytes -= start[0];
    free(start);
}
static inline void *gprojt_failing_reallocate(void *user, void *block, size_t old_size, size_t new_size) {
    void *moved = gprojt_failing_allocate(user, new_size);
    if (!moved) return NULL;
    memcpy(moved, block, old_size < new_size ? old_size : new_size);
    gprojt_failing_release(user, block, old_size);
    return moved;
}
static inline gproj_host gprojt_failing_host(gprojt_failing *f) {
    gproj_host host;
    memset(&host, 0, sizeof host);
    host.allocator.allocate = gprojt_failing_allocate;
    host.allocator.reallocate = gprojt_failing_reallocate;
    host.allocator.release = gprojt_failing_release;
    host.allocator.user = f;
    return host;
}

/* What has come of the allocations of a host from gprojt_failing_host. */
static inline const gprojt_failing *gprojt_failing_of(const gproj_host *host) {
    return (const gprojt_failing *)host->allocator.user;
}

/* Calls `run` until it went well (true): first without its first allocation, then without its second, and so on. It must
   go well iff no allocation failed, and give everything back. Returns how many allocations a whole run takes. */
static inline long gprojt_fail_every_allocation(bool (*run)(const gproj_host *host, void *user), void *user) {
    gprojt_failing failing;
    long fail_at = 0;
    do {
        gproj_host host;
        bool whole;
        memset(&failing, 0, sizeof failing);
        failing.fail_at = ++fail_at;
        host = gprojt_failing_host(&failing);
        whole = run(&host, user);
        GPROJT_CHECK(whole == (failing.calls < fail_at));
        GPROJT_CHECK(failing.held == 0 && failing.bytes == 0 && failing.wrong_sizes == 0);
    } while (failing.calls >= fail_at);
    return failing.calls;
}

/* The folder of real meshes: GPROJ_DATA, or beside the project; they are not part of it. */
static inline const char *gprojt_data_folder(void) {
    const char *folder = getenv("GPROJ_DATA");
    return folder ? folder : "../../shared/data";
}

#endif
