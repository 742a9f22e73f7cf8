/* bench_machine.h - what tools/bench does about the machine before it measures: OpenBLAS on one thread with the fastest
   of its kernels, and the process on one core. Define _GNU_SOURCE before all includes. */
#ifndef BENCH_MACHINE_H
#define BENCH_MACHINE_H

#include "bench.h"
#include <sched.h>
#include <sys/wait.h>
#include <unistd.h>

static const char bench_stage[] = "GPROJ_BENCH_STAGE", bench_coretype[] = "OPENBLAS_CORETYPE";

static void bench_set_coretype(const char *coretype) {
    if (coretype)
        setenv(bench_coretype, coretype, 1);
    else
        unsetenv(bench_coretype);
}

/* dgemm's peak with these kernels (NULL: OpenBLAS's own choice), which are chosen while the library is loaded: in
   another process. 0 where that fails: kernels that this processor cannot run. */
static double bench_probe(const char *coretype) {
    double peak = 0;
    int ends[2];
    pid_t child;
    if (pipe(ends) != 0) return 0;
    child = fork();
    if (child == 0) {
        char *const arguments[] = {(char *)"bench", NULL};
        bench_set_coretype(coretype);
        setenv(bench_stage, "probe", 1);
        dup2(ends[1], STDOUT_FILENO);
        execv("/proc/self/exe", arguments);
        _exit(1);
    }
    close(ends[1]);
    if (child > 0) {
        if (read(ends[0], &peak, sizeof peak) != (ssize_t)sizeof peak) peak = 0;
        waitpid(child, NULL, 0);
    }
    close(ends[0]);
    return peak;
}

/* Starts the program again with OpenBLAS's fastest kernels and on one thread; returns when that is done. OpenBLAS 0.3.21,
   for one, does not know newer processors and falls back to slow kernels; and what the environment names may be slow as
   well. Its own choice, or else the user's, wins where others are not clearly faster. */
static void bench_prepare(char **arguments) {
    const char *stage = getenv(bench_stage), *users = getenv(bench_coretype);
    const char *choice[4] = {NULL, users, "SkylakeX", "Haswell"};
    double peak[4], best = 0;
    int i;
    if (stage && strcmp(stage, "probe") == 0) {
        double own = bench_dgemm_peak();
        exit(write(STDOUT_FILENO, &own, sizeof own) == (ssize_t)sizeof own ? 0 : 1);
    }
    if (stage) return;
    setenv("OMP_NUM_THREADS", "1", 1);
    setenv("OMP_THREAD_LIMIT", "1", 1);
    setenv("OPENBLAS_NUM_THREADS", "1", 1);
    for (i = 0; i < 4; ++i) peak[i] = i == 1 && !users ? 0 : bench_probe(choice[i]);
    for (i = 0; i < 4; ++i) best = peak[i] > best ? peak[i] : best;
    for (i = 0; i < 3 && peak[i] < 0.97 * best; ++i) continue;
    if (users && i != 1)
        fprintf(stderr, "bench: OPENBLAS_CORETYPE=%s is slower than %s: %.1f and %.1f GFlop/s in dgemm\n", users,
                choice[i] ? choice[i] : "OpenBLAS's own choice", 1e-9 * peak[1], 1e-9 * peak[i]);
    bench_set_coretype(choice[i]);
    setenv(bench_stage, "run", 1);
    execv("/proc/self/exe", arguments);
    perror("bench: /proc/self/exe");
    exit(2);
}

/* Keeps the process on the core where it is, or lets it go to those where it may be. */
static void bench_pin(bool pinned) {
    static cpu_set_t allowed;
    static bool known = false;
    cpu_set_t one;
    if (!known) known = sched_getaffinity(0, sizeof allowed, &allowed) == 0;
    CPU_ZERO(&one);
    CPU_SET(sched_getcpu(), &one);
    if (known) sched_setaffinity(0, sizeof one, pinned ? &one : &allowed);
}

#endif
