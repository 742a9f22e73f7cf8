/* gprojt_threads.h - ways of running tasks: in other orders, on threads. */
#ifndef GPROJT_THREADS_H
#define GPROJT_THREADS_H

#include <pthread.h>

#include "gprojt.h"

/* The tasks in reverse order, in leaps, or on `user` threads. */

static inline void gprojt_run_reverse(void *user, int32_t count, gproj_task task, void *data) {
    (void)user;
    while (count-- > 0) task(data, count);
}

static inline void gprojt_run_leaps(void *user, int32_t count, gproj_task task, void *data) {
    int32_t leap, i;
    (void)user;
    for (leap = 0; leap < 3; ++leap)
        for (i = leap; i < count; i += 3) task(data, i);
}

typedef struct gprojt_team {
    int32_t next, count;
    gproj_task task;
    void *data;
    pthread_mutex_t lock;
} gprojt_team;

static inline void *gprojt_team_work(void *user) {
    gprojt_team *team = (gprojt_team *)user;
    for (;;) {
        int32_t mine;
        pthread_mutex_lock(&team->lock);
        mine = team->next++;
        pthread_mutex_unlock(&team->lock);
        if (mine >= team->count) return NULL;
        team->task(team->data, mine);
    }
}

/* `user`: an int, how many threads. */
static inline void gprojt_run_threads(void *user, int32_t count, gproj_task task, void *data) {
    pthread_t thread[8];
    int threads = *(const int *)user, i, started = 0;
    gprojt_team team;
    team.next = 0, team.count = count, team.task = task, team.data = data;
    pthread_mutex_init(&team.lock, NULL);
    for (i = 1; i < threads && i < 8 && i < count; ++i)
        if (pthread_create(&thread[started], NULL, gprojt_team_work, &team) == 0) ++started;
    gprojt_team_work(&team);
    for (i = 0; i < started; ++i) pthread_join(thread[i], NULL);
    pthread_mutex_destroy(&team.lock);
}

/* One worker, two orders of one worker, 2 and 5 workers. */
enum {
    GPROJT_CREWS = 5
};
static inline gproj_host gprojt_crew(int index) {
    static int two = 2, five = 5;
    gproj_host host;
    memset(&host, 0, sizeof host);
    if (index == 1) host.parallel.run = gprojt_run_reverse;
    if (index == 2) host.parallel.run = gprojt_run_leaps;
    if (index >= 3) host.parallel.run = gprojt_run_threads, host.parallel.user = index == 3 ? &two : &five;
    return host;
}

#endif
