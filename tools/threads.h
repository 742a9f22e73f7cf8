/* threads.h - a small pool of POSIX threads for gproj_host.parallel, for the command line and the examples.

       gprojx_threads *threads = gprojx_threads_create(4);   NULL: no memory, or the system gave no threads
       host.parallel = gprojx_threads_hook(threads);         NULL is allowed: then a plain loop
       ...
       gprojx_threads_destroy(threads);

   The pool has count - 1 threads, because the calling thread works too. Each begins with a part of its own of every loop,
   the same one if the loop comes again, because that is what its cache still holds; then it helps the others. To wake a
   sleeping thread takes longer than many loops do, and the next loop is near: threads without work stay awake for a while.
   Include guidedproj.h before this file. */
#ifndef GPROJX_THREADS_H
#define GPROJX_THREADS_H

#include <pthread.h>
#include <stdatomic.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdlib.h>
#include <time.h>

/* Nanoseconds for which a thread stays awake without work. */
enum {
    GPROJX_AWAKE = 200000
};

typedef struct gprojx_worker {
    struct gprojx_threads *threads;
    pthread_t thread;
    int32_t next, end; /* what is left of its part: [next, end) */
} gprojx_worker;

typedef struct gprojx_threads {
    pthread_mutex_t lock;
    pthread_cond_t wake;  /* there is work, or the end */
    pthread_cond_t ready; /* the last index is done */
    gproj_task task;      /* the loop that runs now: task(data, 0 .. count - 1); NULL between loops */
    void *data;
    int32_t left; /* indices that no thread has got yet */
    int32_t open; /* indices whose call has not returned */
    bool quit;
    int32_t asleep;        /* threads that wait for `wake` */
    atomic_int begun;      /* loops so far, and the end; these two are read without the lock, too */
    atomic_int ended;      /* loops all of whose indices are done */
    int32_t count;         /* threads */
    gprojx_worker *worker; /* count; the first one is the thread that runs the loop */
} gprojx_threads;

/* Waits until a number is no longer what it was, but not for long. The lock is held on entry and on return, not in
   between. */
static void gprojx_threads_linger(gprojx_threads *threads, atomic_int *number, int before) {
    struct timespec start, now;
    int i;
    if (atomic_load(number) != before) return;
    pthread_mutex_unlock(&threads->lock);
    clock_gettime(CLOCK_MONOTONIC, &start);
    do {
        for (i = 0; i < 16 && atomic_load(number) == before; ++i) {
#if defined(__x86_64__) || defined(__i386__)
            __builtin_ia32_pause();
#endif
        }
        clock_gettime(CLOCK_MONOTONIC, &now);
    } while (atomic_load(number) == before &&
             (now.tv_sec - start.tv_sec) * 1000000000LL + now.tv_nsec - start.tv_nsec < GPROJX_AWAKE);
    pthread_mutex_lock(&threads->lock);
}

/* The next index of its own part, or else the last one of the largest that is left; there is one. With the lock. */
static int32_t gprojx_threads_take(gprojx_threads *threads, gprojx_worker *own) {
    gprojx_worker *most = own, *other = threads->worker, *end = other + threads->count;
    threads->left--;
    if (own->next < own->end) return own->next++;
    for (; other < end; ++other)
        if (other->end - other->next > most->end - most->next) most = other;
    return --most->end;
}

/* Works on the present loop until all its indices are taken. The lock is held on entry and on return. */
static void gprojx_threads_work(gprojx_threads *threads, gprojx_worker *own) {
    while (threads->task && threads->left > 0) {
        gproj_task task = threads->task;
        void *data = threads->data;
        int32_t index = gprojx_threads_take(threads, own);
        pthread_mutex_unlock(&threads->lock);
        task(data, index);
        pthread_mutex_lock(&threads->lock);
        if (--threads->open > 0) continue;
        atomic_fetch_add(&threads->ended, 1);
        pthread_cond_broadcast(&threads->ready);
    }
}

static void *gprojx_threads_main(void *user) {
    gprojx_worker *own = (gprojx_worker *)user;
    gprojx_threads *threads = own->threads;
    pthread_mutex_lock(&threads->lock);
    while (!threads->quit) {
        int begun = atomic_load(&threads->begun);
        gprojx_threads_work(threads, own);
        gprojx_threads_linger(threads, &threads->begun, begun);
        threads->asleep++;
        while (atomic_load(&threads->begun) == begun) pthread_cond_wait(&threads->wake, &threads->lock);
        threads->asleep--;
    }
    pthread_mutex_unlock(&threads->lock);
    return NULL;
}

/* gproj_parallel.run. A loop that is begun inside a task of another one runs on its own thread alone, and so does one that
   is a single call. */
static void gprojx_threads_run(void *user, int32_t count, gproj_task task, void *data) {
    gprojx_threads *threads = (gprojx_threads *)user;
    int32_t i;
    int ended;
    pthread_mutex_lock(&threads->lock);
    if (threads->task || count < 2) {
        pthread_mutex_unlock(&threads->lock);
        for (i = 0; i < count; ++i) task(data, i);
        return;
    }
    threads->task = task;
    threads->data = data;
    threads->left = threads->open = count;
    for (i = 0; i < threads->count; ++i) {
        threads->worker[i].next = (int32_t)((int64_t)count * i / threads->count);
        threads->worker[i].end = (int32_t)((int64_t)count * (i + 1) / threads->count);
    }
    ended = atomic_load(&threads->ended);
    atomic_fetch_add(&threads->begun, 1);
    if (threads->asleep > 0) pthread_cond_broadcast(&threads->wake);
    gprojx_threads_work(threads, threads->worker);
    gprojx_threads_linger(threads, &threads->ended, ended);
    while (atomic_load(&threads->ended) == ended) pthread_cond_wait(&threads->ready, &threads->lock);
    threads->task = NULL;
    pthread_mutex_unlock(&threads->lock);
}

static void gprojx_threads_destroy(gprojx_threads *threads) {
    int32_t i;
    if (!threads) return;
    pthread_mutex_lock(&threads->lock);
    threads->quit = true;
    atomic_fetch_add(&threads->begun, 1);
    pthread_cond_broadcast(&threads->wake);
    pthread_mutex_unlock(&threads->lock);
    for (i = 1; i < threads->count; ++i) pthread_join(threads->worker[i].thread, NULL);
    pthread_cond_destroy(&threads->ready);
    pthread_cond_destroy(&threads->wake);
    pthread_mutex_destroy(&threads->lock);
    free(threads->worker);
    free(threads);
}

/* A pool that works with `count` >= 1 threads, the caller's included. */
static gprojx_threads *gprojx_threads_create(int32_t count) {
    gprojx_threads *threads = (gprojx_threads *)calloc(1, sizeof *threads);
    if (!threads) return NULL;
    threads->worker = (gprojx_worker *)calloc((size_t)count, sizeof *threads->worker);
    if (!threads->worker) {
        free(threads);
        return NULL;
    }
    pthread_mutex_init(&threads->lock, NULL);
    pthread_cond_init(&threads->wake, NULL);
    pthread_cond_init(&threads->ready, NULL);
    for (threads->count = 1; threads->count < count; threads->count++) {
        gprojx_worker *worker = &threads->worker[threads->count];
        worker->threads = threads;
        if (pthread_create(&worker->thread, NULL, gprojx_threads_main, worker) != 0) {
            gprojx_threads_destroy(threads);
            return NULL;
        }
    }
    return threads;
}

static gproj_parallel gprojx_threads_hook(gprojx_threads *threads) {
    gproj_parallel parallel = {NULL, NULL};
    if (threads && threads->count > 1) {
        parallel.run = gprojx_threads_run;
        parallel.user = threads;
    }
    return parallel;
}

#endif
