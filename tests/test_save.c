/* test_save.c - >>file: what is saved is whole or not there, whatever fails, whoever else saves, wherever the machine
   stops. The header's calls of the system go through hooks here, which count, fail, stop and record them;
   test_save_plain.c tests the same with the calls of the C library alone. */
#if !defined(_WIN32) && !defined(_XOPEN_SOURCE)
#define _XOPEN_SOURCE 700
#endif
#define GPROJ_STATIC
#define GPROJI_TEXT_MAX ((size_t)100000)
#include <stdarg.h>
#include <stdbool.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#ifdef _WIN32
#include "gprojt.h"
int main(void) {
    printf("skip: no fork here\n0 passed, 0 failed, 1 skipped\n");
    return 0;
}
#else

#include <dirent.h>
#include <fcntl.h>
#include <pthread.h>
#include <signal.h>
#include <sys/stat.h>
#include <sys/types.h>
#include <sys/wait.h>
#include <unistd.h>

/* -- hooks -- */

#ifndef GPROJI_FILES
#define GPROJI_FILES 1
#endif

/* The disk of a machine whose power may fail after each call: of a file it holds what was flushed, under the name that
   it has, or had before the last flush of the folder. */
typedef struct gprojt_disk {
    char made[4096];         /* the new file's first name */
    long flushed;            /* its bytes at the last flush */
    bool renamed, permanent; /* its name is the target's; and so on the disk */
    bool torn;               /* some moment's power failure loses both files */
} gprojt_disk;

static bool gprojt_armed;
static int gprojt_calls;   /* since armed */
static int gprojt_fail_at; /* the call that fails; 0: none */
static int gprojt_stop_at; /* the call before which the process stops */
static bool gprojt_lost;   /* the call that failed is one that puts the new file on the disk */
static int gprojt_links;   /* so many next temporary names are taken by symbolic links to "victim" */
static gprojt_disk gprojt_power;

/* True: this call is to fail. */
static bool gprojt_hook(void) {
    if (!gprojt_armed) return false;
    if (++gprojt_calls == gprojt_stop_at) _exit(9);
    return gprojt_calls == gprojt_fail_at;
}

/* The same for a call on which the new file depends, until it has the target's name. */
static bool gprojt_lose(void) {
    bool fails = gprojt_hook();
    if (fails && !gprojt_power.renamed) gprojt_lost = true;
    return fails;
}

static void gprojt_arm(int fail_at, int stop_at) {
    gprojt_armed = true, gprojt_lost = false;
    gprojt_calls = 0, gprojt_fail_at = fail_at, gprojt_stop_at = stop_at;
    memset(&gprojt_power, 0, sizeof gprojt_power);
}

static int gprojt_disarm(void) {
    gprojt_armed = false;
    return gprojt_calls;
}

static void gprojt_take_name(const char *path) {
    if (!gprojt_armed) return;
    if (gprojt_links > 0 && gprojt_links-- && symlink("victim", path) != 0) abort();
    snprintf(gprojt_power.made, sizeof gprojt_power.made, "%s", path);
}

static long gprojt_size(const char *path) {
    struct stat info;
    return stat(path, &info) == 0 ? (long)info.st_size : -1;
}

static int gprojt_rename(const char *from, const char *to) {
    if (gprojt_lose()) return -1;
    if (gprojt_armed) {
        gprojt_power.renamed = true;
        if (gprojt_power.flushed != gprojt_size(from)) gprojt_power.torn = true;
    }
    return rename(from, to);
}

#if GPROJI_FILES
static int gprojt_open(const char *path, int flags, ...) {
    va_list list;
    mode_t mode;
    va_start(list, flags);
    mode = flags & O_CREAT ? (mode_t)va_arg(list, unsigned) : 0;
    va_end(list);
    if (gprojt_hook()) return -1;
    if (flags & O_CREAT) gprojt_take_name(path);
    return open(path, flags, mode);
}
static size_t gprojt_pieces; /* > 0: no write takes more bytes */
static int gprojt_idle;      /* > 0: the write with this number, from now on, takes none */
static ssize_t gprojt_write(int descriptor, const void *text, size_t size) {
    if (gprojt_lose()) return -1;
    if (gprojt_idle > 0 && --gprojt_idle == 0) return 0;
    return write(descriptor, text, gprojt_pieces && size > gprojt_pieces ? gprojt_pieces : size);
}
static int gprojt_close(int descriptor) {
    int code = close(descriptor);
    return gprojt_lose() ? -1 : code;
}
static int gprojt_fsync(int descriptor) {
    struct stat info;
    if (gprojt_lose()) return -1;
    if (gprojt_armed && fstat(descriptor, &info) == 0) {
        if (S_ISDIR(info.st_mode))
            gprojt_power.permanent = gprojt_power.renamed;
        else
            gprojt_power.flushed = (long)info.st_size;
    }
    return fsync(descriptor);
}
static int gprojt_fchmod(int descriptor, mode_t mode) { return gprojt_hook() ? -1 : fchmod(descriptor, mode); }
static bool gprojt_owned; /* neither the owner nor the group can be given */
static int gprojt_fchown(int descriptor, uid_t user, gid_t group) {
    return gprojt_hook() || gprojt_owned ? -1 : fchown(descriptor, user, group);
}
static ssize_t gprojt_readlink(const char *path, char *target, size_t size) {
    return gprojt_hook() ? -1 : readlink(path, target, size);
}
#define open gprojt_open
#define write gprojt_write
#define close gprojt_close
#define fsync gprojt_fsync
#define fchmod gprojt_fchmod
#define fchown gprojt_fchown
#define readlink gprojt_readlink
#else
static FILE *gprojt_fopen(const char *path, const char *mode) {
    if (gprojt_hook()) return NULL;
    if (mode[0] == 'w') gprojt_take_name(path);
    return fopen(path, mode);
}
static size_t gprojt_fwrite(const void *text, size_t size, size_t count, FILE *file) {
    return gprojt_lose() ? 0 : fwrite(text, size, count, file);
}
static int gprojt_fflush(FILE *file) { return gprojt_lose() ? EOF : fflush(file); }
static int gprojt_fclose(FILE *file) {
    int code = fclose(file);
    return gprojt_lose() ? EOF : code;
}
#define fopen gprojt_fopen
#define fwrite gprojt_fwrite
#define fflush gprojt_fflush
#define fclose gprojt_fclose
#endif
#define rename gprojt_rename

#include "gprojt_mesh.h"

/* -- meshes and folders -- */

enum {
    GPROJT_MESHES = 20
};
static gproj_mesh *gprojt_mesh[GPROJT_MESHES];
static struct {
    char *text;
    size_t size;
} gprojt_want[GPROJT_MESHES];

static bool gprojt_store(void *user, const char *text, size_t size) {
    int i = *(int *)user;
    gprojt_want[i].text = (char *)realloc(gprojt_want[i].text, gprojt_want[i].size + size);
    memcpy(gprojt_want[i].text + gprojt_want[i].size, text, size);
    gprojt_want[i].size += size;
    return true;
}

static void gprojt_make_meshes(void) {
    int i;
    for (i = 0; i < GPROJT_MESHES; ++i) {
        gprojt_soup s = gprojt_quad_grid(2 + 2 * i, 9);
        gprojt_mesh[i] = gprojt_soup_mesh(&s, NULL, NULL);
        gproj_mesh_write(gprojt_mesh[i], GPROJ_FORMAT_OBJ, gprojt_store, &i, NULL);
        gprojt_soup_free(&s);
    }
}

static void gprojt_destroy_meshes(void) {
    int i;
    for (i = 0; i < GPROJT_MESHES; ++i) gproj_mesh_destroy(gprojt_mesh[i]), free(gprojt_want[i].text);
}

/* Which mesh the file holds, whole; -1: none. */
static int gprojt_which(const char *path) {
    size_t room = 1 << 20, size;
    char *text = (char *)malloc(room);
    FILE *file = fopen(path, "rb");
    int i, found = -1;
    size = file ? fread(text, 1, room, file) : 0;
    if (file) fclose(file);
    for (i = 0; i < GPROJT_MESHES; ++i)
        if (size == gprojt_want[i].size && !memcmp(text, gprojt_want[i].text, size)) found = i;
    free(text);
    return found;
}

/* Files in this folder whose names begin so. */
static int gprojt_count_files(const char *begin) {
    DIR *folder = opendir(".");
    struct dirent *entry;
    int count = 0;
    while (folder && (entry = readdir(folder)) != NULL) count += !strncmp(entry->d_name, begin, strlen(begin));
    if (folder) closedir(folder);
    return count;
}

static int gprojt_leftovers(void) { return gprojt_count_files("gproj-") + gprojt_count_files("roof.obj."); }

static bool gprojt_save(int mesh, const char *path, const char *piece) {
    gproj_error error;
    gproj_code code = gproj_mesh_save(gprojt_mesh[mesh], path, &error);
    gprojt_disarm();
    GPROJT_CHECK(code == error.code && (code == GPROJ_OK || code == GPROJ_ERROR_FILE));
    GPROJT_CHECK(code == GPROJ_OK || (strstr(error.message, "' cannot be saved: ") != NULL));
    if (piece && (code == GPROJ_OK || !strstr(error.message, piece))) {
        printf("  %s: no '%s' in '%s'\n", path, piece, error.message);
        gprojt_failed_checks++;
    }
    return code == GPROJ_OK;
}

/* -- what fails -- */

GPROJT_TEST(each_call_fails_once) { /* the old file stays, or the new one is there; nothing else is left */
    int old, call, calls, failures = 0;
    for (old = 0; old < 2; ++old) {
        call = 0;
        do {
            bool saved;
            remove("roof.obj");
            if (old) gprojt_save(0, "roof.obj", NULL);
            gprojt_arm(++call, 0);
            saved = gprojt_save(19, "roof.obj", NULL);
            calls = gprojt_calls;
            GPROJT_CHECK(gprojt_which("roof.obj") == (saved ? 19 : old ? 0 : -1));
            GPROJT_CHECK(saved || old || gprojt_size("roof.obj") < 0);
            GPROJT_CHECK(!saved || !gprojt_lost);
            GPROJT_CHECK(gprojt_leftovers() == 0);
            failures += !saved;
        } while (calls >= call);
        GPROJT_CHECK(gprojt_which("roof.obj") == 19 && call > 10);
    }
    GPROJT_CHECK(failures > 10);
    remove("roof.obj");
}

GPROJT_TEST(stopped_before_each_call) { /* kill -9 */
    int call = 0, status;
    gprojt_save(0, "roof.obj", NULL);
    do {
        pid_t child;
        int which;
        ++call;
        fflush(stdout);
        child = fork();
        if (child == 0) {
            gprojt_arm(0, call);
            _exit(gproj_mesh_save(gprojt_mesh[19], "roof.obj", NULL) == GPROJ_OK ? 0 : 1);
        }
        GPROJT_REQUIRE(child > 0 && waitpid(child, &status, 0) == child && WIFEXITED(status));
        which = gprojt_which("roof.obj");
        GPROJT_CHECK(WEXITSTATUS(status) == 0 ? which == 19 : which == 0 || which == 19);
        GPROJT_REQUIRE(WEXITSTATUS(status) == 0 || WEXITSTATUS(status) == 9);
        GPROJT_CHECK(system("rm -f gproj-*.tmp") == 0);
    } while (WEXITSTATUS(status) != 0);
    GPROJT_CHECK(call > 8);
    remove("roof.obj");
}

#if GPROJI_FILES
GPROJT_TEST(power_fails_at_any_moment) {
    gprojt_save(0, "roof.obj", NULL);
    gprojt_arm(0, 0);
    GPROJT_CHECK(gprojt_save(19, "roof.obj", NULL));
    GPROJT_CHECK(gprojt_power.flushed == (long)gprojt_want[19].size && !gprojt_power.torn);
    GPROJT_CHECK(gprojt_power.renamed && gprojt_power.permanent); /* before the call returns */
    remove("roof.obj");
}

GPROJT_TEST(writes_in_pieces) {
    gprojt_pieces = 1000;
    GPROJT_CHECK(gprojt_save(19, "roof.obj", NULL) && gprojt_which("roof.obj") == 19);
    gprojt_idle = 3;
    GPROJT_CHECK(!gprojt_save(18, "roof.obj", "cannot be saved") && gprojt_idle == 0 && gprojt_which("roof.obj") == 19);
    gprojt_pieces = 0;
    remove("roof.obj");
}
#endif

GPROJT_TEST(sentences) {
    char path[6000];
    size_t i;
    GPROJT_CHECK(!gprojt_save(0, "nowhere/roof.obj", "'nowhere/roof.obj' cannot be saved: no file can be made in"));
    memset(path, 'x', sizeof path);
    memcpy(path + 4096 - 4, ".obj", 5);
    GPROJT_CHECK(!gprojt_save(0, path, "too long a path"));
    memcpy(path + 4095 - 4, ".obj", 5);
    GPROJT_CHECK(!gprojt_save(0, path, "' cannot be saved: ")); /* no name may have 4,091 characters */
    for (i = 0; i < 4000; i += 2) memcpy(path + i, "./", 2);
    memcpy(path + 4000, "r.obj", 6);
    GPROJT_CHECK(gprojt_save(3, path, NULL) && gprojt_which("r.obj") == 3);
    remove("r.obj");
    for (i = 4000; i < 4080; i += 2) memcpy(path + i, "./", 2);
    path[4076] = '/', memcpy(path + 4077, "r.obj", 6); /* the new file's has 4095 characters */
    GPROJT_CHECK(gprojt_save(3, path, NULL) && gprojt_which("r.obj") == 3);
    remove("r.obj");
    memcpy(path + 4076, "./", 2);
    memcpy(path + 4080, "r.obj", 6); /* a path, but the new file's would be none */
    GPROJT_CHECK(!gprojt_save(3, path, "too long a path"));
    memset(path, 'n', 251);
    memcpy(path + 251, ".obj", 5); /* as long as a name may be, and not ASCII */
    memcpy(path, "\xc3\xa4\xe6\xb1\x89\xf0\x9f\x8f\xa0", 9);
    GPROJT_CHECK(gprojt_save(3, path, NULL) && gprojt_which(path) == 3);
    remove(path);
    GPROJT_CHECK(mkdir("roof.obj", 0777) == 0);
    GPROJT_CHECK(!gprojt_save(0, "roof.obj", "folder"));
    GPROJT_CHECK(rmdir("roof.obj") == 0 && gprojt_leftovers() == 0);
}

/* -- who else is there -- */

GPROJT_TEST(links_at_temporary_names) {
    int taken;
    char name[32];
    GPROJT_CHECK(gprojt_save(1, "roof.obj", NULL) && gprojt_save(2, "victim.obj", NULL));
    GPROJT_CHECK(rename("victim.obj", "victim") == 0 && symlink("victim", "roof.obj.gproj-new") == 0);
    for (taken = 0; taken < 4; ++taken) {
        gprojt_links = taken;
        gprojt_arm(0, 0);
        GPROJT_CHECK(gprojt_save(4, "roof.obj", NULL) && gprojt_which("roof.obj") == 4 && gprojt_which("victim") == 2);
        snprintf(name, sizeof name, "gproj-");
        GPROJT_CHECK(gprojt_count_files(name) == taken && system("rm -f gproj-*.tmp") == 0);
    }
    gprojt_links = 1000; /* all of them: nothing happens */
    gprojt_arm(0, 0);
    GPROJT_CHECK(!gprojt_save(5, "roof.obj", "no file can be made"));
    gprojt_links = 0;
    GPROJT_CHECK(gprojt_which("roof.obj") == 4 && gprojt_which("victim") == 2);
    GPROJT_CHECK(system("rm -f gproj-*.tmp roof.obj.gproj-new roof.obj victim") == 0);
}

GPROJT_TEST(savers_at_the_same_time) { /* 150 processes; a reader meets whole files only */
    enum {
        SAVERS = 150
    };
    int i, running = 0, status, torn = 0, failed = 0;
    gprojt_save(0, "roof.obj", NULL);
    fflush(stdout);
    for (i = 0; i < SAVERS; ++i) {
        pid_t child = fork();
        if (child == 0) _exit(gproj_mesh_save(gprojt_mesh[i % GPROJT_MESHES], "roof.obj", NULL) != GPROJ_OK);
        running += child > 0;
    }
    GPROJT_CHECK(running == SAVERS);
    while (running > 0) {
        torn += gprojt_which("roof.obj") < 0;
        while (running > 0 && waitpid(-1, &status, WNOHANG) > 0) --running, failed += status != 0;
    }
    torn += gprojt_which("roof.obj") < 0;
    if (torn || failed) printf("  %d torn files met, %d saves failed\n", torn, failed);
    GPROJT_CHECK(torn == 0 && failed == 0 && gprojt_leftovers() == 0);
    remove("roof.obj");
}

static void *gprojt_save_often(void *user) {
    size_t i, failed = 0;
    for (i = 0; i < 20; ++i) failed += gproj_mesh_save(*(gproj_mesh **)user, "roof.obj", NULL) != GPROJ_OK;
    return failed ? user : NULL;
}

GPROJT_TEST(threads_at_the_same_time) {
    pthread_t thread[8];
    void *failed;
    int i;
    for (i = 0; i < 8; ++i) GPROJT_REQUIRE(!pthread_create(&thread[i], NULL, gprojt_save_often, &gprojt_mesh[i]));
    for (i = 0; i < 8; ++i) GPROJT_CHECK(!pthread_join(thread[i], &failed) && !failed);
    GPROJT_CHECK(gprojt_which("roof.obj") >= 0 && gprojt_leftovers() == 0);
    remove("roof.obj");
}

/* -- what is there before -- */

#if GPROJI_FILES
static int gprojt_mode(const char *path) {
    struct stat info;
    return stat(path, &info) == 0 ? (int)(info.st_mode & 07777) : -1;
}

GPROJT_TEST(permissions) {
    static const mode_t modes[] = {0600, 0640, 0666, 0444, 0755};
    mode_t mask = umask(022);
    size_t i;
    remove("roof.obj");
    GPROJT_CHECK(gprojt_save(0, "roof.obj", NULL) && gprojt_mode("roof.obj") == 0644);
    for (i = 0; i < sizeof modes / sizeof modes[0]; ++i) {
        GPROJT_CHECK(chmod("roof.obj", modes[i]) == 0);
        GPROJT_CHECK(gprojt_save(1, "roof.obj", NULL) && gprojt_mode("roof.obj") == (int)modes[i]);
    }
    gprojt_owned = true; /* what the group may do, ours may not */
    for (i = 0; i < sizeof modes / sizeof modes[0]; ++i) {
        GPROJT_CHECK(chmod("roof.obj", modes[i]) == 0);
        GPROJT_CHECK(gprojt_save(1, "roof.obj", NULL) && gprojt_mode("roof.obj") == (int)(modes[i] & 0707));
    }
    gprojt_owned = false;
    umask(mask);
    if (geteuid() == 0) { /* root saves for others */
        struct stat info;
        GPROJT_CHECK(chown("roof.obj", 1234, 4321) == 0 && gprojt_save(2, "roof.obj", NULL));
        GPROJT_CHECK(stat("roof.obj", &info) == 0 && info.st_uid == 1234 && info.st_gid == 4321);
    }
    remove("roof.obj");
}

static bool gprojt_is_link(const char *path) {
    struct stat info;
    return lstat(path, &info) == 0 && S_ISLNK(info.st_mode);
}

GPROJT_TEST(symbolic_links) {
    char target[4200];
    GPROJT_CHECK(getcwd(target, 4096) && mkdir("there", 0777) == 0 && mkdir("back", 0777) == 0);
    GPROJT_CHECK(symlink("there/link.obj", "roof.obj") == 0 && symlink("../back/link.obj", "there/link.obj") == 0);
    strcat(target, "/real.obj");
    GPROJT_CHECK(symlink(target, "back/link.obj") == 0); /* relative, up, absolute */
    GPROJT_CHECK(gprojt_save(5, "roof.obj", NULL));      /* leads to nothing yet */
    GPROJT_CHECK(gprojt_which("real.obj") == 5);
    GPROJT_CHECK(gprojt_save(6, "roof.obj", NULL) && gprojt_which("real.obj") == 6 && gprojt_which("roof.obj") == 6);
    GPROJT_CHECK(gprojt_is_link("roof.obj") && gprojt_is_link("there/link.obj") && gprojt_is_link("back/link.obj"));
    GPROJT_CHECK(unlink("roof.obj") == 0 && symlink("r", "roof.obj") == 0); /* to the shortest name */
    GPROJT_CHECK(gprojt_save(8, "roof.obj", NULL) && gprojt_which("r") == 8 && gprojt_is_link("roof.obj"));
    GPROJT_CHECK(unlink("roof.obj") == 0 && symlink("roof.obj", "roof.obj") == 0);
    GPROJT_CHECK(!gprojt_save(7, "roof.obj", "circle"));
    memset(target, '/', 4090);
    memcpy(target, "..", 2), memcpy(target + 4085, "r.obj", 6);
    GPROJT_CHECK(symlink(target, "there/far.obj") == 0); /* with the folder before it, longer than a path may be */
    GPROJT_CHECK(!gprojt_save(7, "there/far.obj", "in a circle, or too far"));
    GPROJT_CHECK(unlink("roof.obj") == 0 && symlink("there", "roof.obj") == 0);
    GPROJT_CHECK(!gprojt_save(7, "roof.obj", "it is a folder, a device or a pipe"));
    /* A device in a folder where nothing can be put in its place: a wrong header must not replace /dev/null. */
    GPROJT_CHECK(unlink("roof.obj") == 0 && symlink("/dev/pts/ptmx", "roof.obj") == 0);
    GPROJT_CHECK(access("/dev/pts/ptmx", F_OK) || !gprojt_save(7, "roof.obj", "it is a folder, a device or a pipe"));
    GPROJT_CHECK(unlink("roof.obj") == 0 && mkfifo("roof.obj", 0600) == 0);
    GPROJT_CHECK(!gprojt_save(7, "roof.obj", "it is a folder, a device or a pipe"));
    GPROJT_CHECK(system("rm -r there back real.obj roof.obj r") == 0 && gprojt_leftovers() == 0);
}
#endif

/* -- reading -- */

static gproj_code gprojt_load(const char *path, size_t limit, const char *piece) {
    gproj_error error;
    gproj_host host;
    gproj_mesh *mesh;
    memset(&host, 0, sizeof host);
    host.allocator.limit = limit;
    mesh = gproj_mesh_load(path, &host, &error);
    GPROJT_CHECK(mesh ? error.code == GPROJ_OK : strstr(error.message, piece) != NULL);
    if (!mesh && !strstr(error.message, piece)) printf("  %s\n", error.message);
    gproj_mesh_destroy(mesh);
    return error.code;
}

GPROJT_TEST(files_without_end) {
    pid_t child;
    FILE *file;
    int i;
    GPROJT_CHECK(symlink("/dev/zero", "zero.obj") == 0 && symlink("/dev/full", "full.off") == 0);
    GPROJT_CHECK(gprojt_load("zero.obj", 0, "line 1: a zero byte; this is a binary file") == GPROJ_ERROR_SYNTAX);
    GPROJT_CHECK(gprojt_load("full.off", 0, "line 1: a zero byte") == GPROJ_ERROR_SYNTAX);
    GPROJT_CHECK(mkdir("folder.obj", 0777) == 0);
    GPROJT_CHECK(gprojt_load("folder.obj", 0, "'folder.obj' cannot be read; is it a folder") == GPROJ_ERROR_FILE);
    GPROJT_CHECK(rmdir("folder.obj") == 0 && mkfifo("pipe.obj", 0600) == 0);
    fflush(stdout);
    child = fork();
    if (child == 0) {
        signal(SIGPIPE, SIG_DFL);
        file = fopen("pipe.obj", "w");
        while (file && fputs("v 0 0 0\n", file) >= 0) continue;
        _exit(1);
    }
    GPROJT_CHECK(gprojt_load("pipe.obj", 0, "'pipe.obj' has more than 100000 bytes, or no end") == GPROJ_ERROR_SIZE);
    GPROJT_CHECK(child > 0 && waitpid(child, NULL, 0) == child);
    file = fopen("long.obj", "w"); /* long, but with an end */
    for (i = 0; file && i < 20000; ++i) fputs("v 0 0 0\n", file);
    if (file) fclose(file);
    GPROJT_CHECK(gprojt_load("long.obj", 0, "'long.obj' has more than 100000 bytes") == GPROJ_ERROR_SIZE);
    GPROJT_CHECK(gprojt_load("long.obj", 90000, "too large for the memory") == GPROJ_ERROR_MEMORY);
    GPROJT_CHECK(gprojt_load("long.obj", 10000000, "") == GPROJ_OK);
    GPROJT_CHECK(system("rm zero.obj full.off pipe.obj long.obj") == 0);
}

int main(void) {
    char folder[] = "/tmp/gprojt_save.XXXXXX";
    if (!mkdtemp(folder) || chdir(folder) != 0) return 2;
    gprojt_make_meshes();
    GPROJT_RUN(each_call_fails_once);
    GPROJT_RUN(stopped_before_each_call);
    GPROJT_RUN(sentences);
    GPROJT_RUN(links_at_temporary_names);
    GPROJT_RUN(savers_at_the_same_time);
    GPROJT_RUN(threads_at_the_same_time);
    GPROJT_RUN(files_without_end);
#if GPROJI_FILES
    GPROJT_RUN(power_fails_at_any_moment);
    GPROJT_RUN(writes_in_pieces);
    GPROJT_RUN(permissions);
    GPROJT_RUN(symbolic_links);
#endif
    gprojt_destroy_meshes();
    if (chdir("/") == 0 && rmdir(folder) != 0) printf("  %s is not empty\n", folder);
    return gprojt_report();
}
#endif
