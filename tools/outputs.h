/* outputs.h - writes a run's outputs so that all of them come to their places, or none, for the command lines.

       gprojx_watch_signals(list, count);
       gprojx_output_prepare(&list[i], &error)        each one with a path, before the work starts
       file = gprojx_output_open(&list[i], &error)    a new file in the folder of the output
       gprojx_output_close(&list[i], file, code, &error)
       gprojx_outputs_place(list, count, &error)      once all are complete on the disk
       gprojx_outputs_discard(list, count, "tool")    at the end, whatever happened

   A function that fails says why in `error`, in words that follow the name of the output. Include guidedproj.h before this
   file, and define _XOPEN_SOURCE 700 before everything. */
#ifndef GPROJX_OUTPUTS_H
#define GPROJX_OUTPUTS_H

#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <sys/stat.h>
#include <unistd.h>

#include "readers.h"

typedef struct gprojx_output {
    const char *path; /* NULL: this output is not asked for */
    char *target;     /* the path without symbolic links */
    char *temporary;  /* in the target's folder; NULL before it is written, and for devices and pipes */
    char *kept;       /* the old file's second name, until all outputs are in their places */
    bool fresh;       /* in its place, where no file was, while others are not in theirs */
    bool device;      /* exists and is no regular file: written directly */
} gprojx_output;

/* ---- signals ---- */

static gprojx_output *gprojx_watched; /* for the signals */
static int32_t gprojx_watched_count;

/* Takes away the files that no one is to see, and lets the signal do what it would have done. */
static void gprojx_end_by_signal(int number) {
    int32_t i;
    for (i = 0; i < gprojx_watched_count; ++i)
        if (gprojx_watched[i].temporary) unlink(gprojx_watched[i].temporary);
    signal(number, SIG_DFL);
    raise(number);
}

static const int gprojx_ending_signals[] = {SIGHUP, SIGINT, SIGTERM};
enum {
    GPROJX_ENDING_SIGNALS = sizeof gprojx_ending_signals / sizeof gprojx_ending_signals[0]
};

static void gprojx_watch_signals(gprojx_output *list, int32_t count) {
    int i;
    gprojx_watched = list, gprojx_watched_count = count;
    signal(SIGXFSZ, SIG_IGN); /* a file that grows too large is an error of fwrite */
    for (i = 0; i < GPROJX_ENDING_SIGNALS; ++i)
        if (signal(gprojx_ending_signals[i], SIG_IGN) != SIG_IGN)
            signal(gprojx_ending_signals[i], gprojx_end_by_signal);
}

/* Holds the signals back while files and their names in the outputs differ, or lets them come. */
static void gprojx_hold_signals(bool hold) {
    sigset_t set;
    int i;
    sigemptyset(&set);
    for (i = 0; i < GPROJX_ENDING_SIGNALS; ++i) sigaddset(&set, gprojx_ending_signals[i]);
    pthread_sigmask(hold ? SIG_BLOCK : SIG_UNBLOCK, &set, NULL);
}

/* ---- where outputs go ---- */

/* Returns the folder of a path, by malloc; NULL: out of memory. */
static char *gprojx_folder_of(const char *path) {
    const char *slash = strrchr(path, '/');
    size_t size = slash && slash != path ? (size_t)(slash - path) : 1;
    char *folder = (char *)malloc(size + 1);
    if (!folder) return NULL;
    memcpy(folder, slash ? path : ".", size);
    folder[size] = 0;
    return folder;
}

/* Sets the target of an output that does not exist, in a folder that does. */
static bool gprojx_output_resolve(gprojx_output *output, gproj_error *error) {
    const char *slash = strrchr(output->path, '/'), *name = slash ? slash + 1 : output->path;
    struct stat info;
    char *folder, *real;
    errno = 0;
    if (lstat(output->path, &info) == 0 && S_ISLNK(info.st_mode))
        return gprojx_refuse(error, GPROJ_ERROR_FILE, "is a symbolic link that leads nowhere: remove it, or mend it");
    if (errno != 0 && errno != ENOENT) /* a name that is too long, or a file where the path has a folder */
        return gprojx_refuse(error, GPROJ_ERROR_FILE, "cannot be written: %s", strerror(errno));
    folder = gprojx_folder_of(output->path);
    if (!folder) return gprojx_refuse(error, GPROJ_ERROR_MEMORY, "out of memory");
    real = realpath(folder, NULL);
    if (!real) gprojx_refuse(error, GPROJ_ERROR_FILE, "cannot be written: there is no folder '%s'", folder);
    free(folder);
    if (!real) return false;
    output->target = (char *)malloc(strlen(real) + strlen(name) + 2);
    if (output->target) strcat(strcat(strcpy(output->target, real), strcmp(real, "/") == 0 ? "" : "/"), name);
    free(real);
    return output->target || gprojx_refuse(error, GPROJ_ERROR_MEMORY, "out of memory");
}

/* Finds where an output really goes, and refuses before the work starts what could not be written after it. */
static bool gprojx_output_prepare(gprojx_output *output, gproj_error *error) {
    struct stat info;
    char *folder;
    bool writable;
    output->target = realpath(output->path, NULL);
    if (!output->target && !gprojx_output_resolve(output, error)) return false;
    if (stat(output->target, &info) == 0) {
        if (S_ISDIR(info.st_mode)) return gprojx_refuse(error, GPROJ_ERROR_FILE, "is a folder");
        output->device = !S_ISREG(info.st_mode);
    }
    folder = gprojx_folder_of(output->target);
    if (!folder) return gprojx_refuse(error, GPROJ_ERROR_MEMORY, "out of memory");
    writable = output->device ? access(output->target, W_OK) == 0 : access(folder, W_OK | X_OK) == 0;
    if (!writable) gprojx_refuse(error, GPROJ_ERROR_FILE, "cannot be written: %s", strerror(errno));
    free(folder);
    return writable;
}

/* Returns a name in the target's folder, by malloc; `number` tells those of one process apart. NULL: out of memory. */
static char *gprojx_name_beside(const char *target, int number) {
    size_t folder = (size_t)(strrchr(target, '/') - target) + 1;
    char name[48], *path;
    snprintf(name, sizeof name, "gproj-%ld-%d.tmp", (long)getpid(), number);
    path = (char *)malloc(folder + strlen(name) + 1);
    if (path) strcpy((char *)memcpy(path, target, folder) + folder, name);
    return path;
}

/* ---- writing ---- */

enum {
    GPROJX_MOST_NAMES = 1000 /* tried: crashed processes of the same number may have left some */
};

/* Opens a new file in the folder of the target, which follows no link and opens no file that is there. Returns the
   descriptor, or -1 with the reason in errno. */
static int gprojx_open_temporary(gprojx_output *output, mode_t mode) {
    int descriptor = -1, number;
    gprojx_hold_signals(true);
    for (number = 0; descriptor < 0 && number < GPROJX_MOST_NAMES; ++number) {
        char *name = gprojx_name_beside(output->target, number);
        if (!name) break;
        descriptor = open(name, O_WRONLY | O_CREAT | O_EXCL | O_CLOEXEC, mode);
        if (descriptor >= 0)
            output->temporary = name;
        else {
            free(name);
            if (errno != EEXIST) break;
        }
    }
    gprojx_hold_signals(false);
    return descriptor;
}

/* Opens the file that an output is written to, with the permissions of the old one. NULL: it cannot be. */
static FILE *gprojx_output_open(gprojx_output *output, gproj_error *error) {
    struct stat info;
    bool old = stat(output->target, &info) == 0;
    int descriptor;
    FILE *file = NULL;
    errno = 0;
    descriptor = output->device ? -1 : gprojx_open_temporary(output, old ? 0600 : 0666);
    if (descriptor >= 0 && old) {
        /* Only root gives files away, others choose among their groups. A group that is not kept gets no rights. */
        mode_t mode = info.st_mode & 0777;
        if (fchown(descriptor, info.st_uid, info.st_gid) != 0 && fchown(descriptor, (uid_t)-1, info.st_gid) != 0)
            mode &= 0707;
        fchmod(descriptor, mode);
        errno = 0;
    }
    if (output->device)
        file = fopen(output->target, "w");
    else if (descriptor >= 0)
        file = fdopen(descriptor, "w");
    if (!file)
        gprojx_refuse(error, errno == ENOMEM ? GPROJ_ERROR_MEMORY : GPROJ_ERROR_FILE, "cannot be written: %s",
                      strerror(errno));
    return file;
}

/* Flushes an output to the disk and closes it. code: how writing went. */
static bool gprojx_output_close(const gprojx_output *output, FILE *file, gproj_code code, gproj_error *error) {
    bool flushed = fflush(file) == 0 && !ferror(file) && (output->device || fsync(fileno(file)) == 0);
    int cause = errno;
    if (fclose(file) != 0 && flushed) flushed = false, cause = errno;
    if (code == GPROJ_OK && flushed) return true;
    return gprojx_refuse(error, code == GPROJ_ERROR_MEMORY ? code : GPROJ_ERROR_FILE, "cannot be written: %s",
                         cause ? strerror(cause) : gproj_code_string(code));
}

/* ---- outputs in their places: all of them, or none ---- */

/* Gives the old file, where there is one, a second name; where the file system has no such links, another name. */
static bool gprojx_keep_old(gprojx_output *output, gproj_error *error) {
    int number;
    bool kept = access(output->target, F_OK) != 0;
    for (number = 0; !kept && number < GPROJX_MOST_NAMES; ++number) {
        free(output->kept);
        output->kept = gprojx_name_beside(output->target, number);
        if (!output->kept) return gprojx_refuse(error, GPROJ_ERROR_MEMORY, "out of memory");
        kept = link(output->target, output->kept) == 0;
        if (!kept && errno != EEXIST)
            kept = access(output->kept, F_OK) != 0 && rename(output->target, output->kept) == 0;
    }
    if (kept) return true;
    free(output->kept);
    output->kept = NULL;
    return gprojx_refuse(error, GPROJ_ERROR_FILE, "cannot be written: the old file cannot be moved: %s",
                         strerror(errno));
}

/* Flushes the names in the folder of an output to the disk. */
static void gprojx_write_folder_through(const char *target) {
    char *folder = gprojx_folder_of(target);
    int descriptor = folder ? open(folder, O_RDONLY | O_CLOEXEC) : -1;
    if (descriptor >= 0) fsync(descriptor), close(descriptor); /* some file systems refuse */
    free(folder);
}

/* Renames all new files to their places. Where one cannot be, error->index names the output, and signals stay held back
   until gprojx_outputs_discard has put back the old files. */
static bool gprojx_outputs_place(gprojx_output *list, int32_t count, gproj_error *error) {
    int32_t i;
    gprojx_hold_signals(true);
    for (i = 0; i < count; ++i) {
        gprojx_output *output = &list[i];
        bool good;
        if (!output->temporary) continue;
        good = gprojx_keep_old(output, error);
        if (good && rename(output->temporary, output->target) != 0)
            good = gprojx_refuse(error, GPROJ_ERROR_FILE, "cannot be written: %s", strerror(errno));
        if (!good) {
            error->index = i;
            return false;
        }
        output->fresh = !output->kept;
        free(output->temporary);
        output->temporary = NULL;
    }
    for (i = 0; i < count; ++i) {
        if (!list[i].path || list[i].device) continue;
        if (list[i].kept) unlink(list[i].kept);
        free(list[i].kept);
        list[i].kept = NULL, list[i].fresh = false;
        gprojx_write_folder_through(list[i].target);
    }
    gprojx_hold_signals(false);
    return true;
}

/* Takes away what is not in its place, puts back the old files if not all new ones are in theirs, and frees the names.
   program: for the sentence about an old file that cannot be put back. */
static void gprojx_outputs_discard(gprojx_output *list, int32_t count, const char *program) {
    int32_t i;
    gprojx_hold_signals(true);
    for (i = 0; i < count; ++i) {
        gprojx_output *output = &list[i];
        if (output->kept && rename(output->kept, output->target) != 0) {
            fprintf(stderr, "%s: the old file is now ", program);
            gprojx_print_plain(stderr, output->kept);
            fputc('\n', stderr);
        } else if (output->kept)
            unlink(output->kept); /* renaming does nothing where both are names of one file */
        else if (output->fresh)
            unlink(output->target);
        if (output->temporary) unlink(output->temporary);
        free(output->temporary), free(output->kept), free(output->target);
    }
    gprojx_watched = NULL, gprojx_watched_count = 0;
    gprojx_hold_signals(false);
}

#endif
