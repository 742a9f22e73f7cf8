/* pthread.h - mingw's threads, which Microsoft has not: for tests that share work. */
#pragma once
#include <stdint.h>
typedef uintptr_t pthread_t;
typedef intptr_t pthread_mutex_t;
int pthread_create(pthread_t *, const void *, void *(*)(void *), void *), pthread_join(pthread_t, void **);
int pthread_mutex_init(pthread_mutex_t *, const void *), pthread_mutex_destroy(pthread_mutex_t *);
int pthread_mutex_lock(pthread_mutex_t *), pthread_mutex_unlock(pthread_mutex_t *);
