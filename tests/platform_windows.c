/* platform_windows.c - >>file on Windows, where test_save.c cannot go: paths in UTF-8, long ones, and old files that are
   replaced whole or stay; platforms.sh runs it. Works in a new folder inside of the present one. */
#include <process.h>
#include <stdint.h>
#include <wchar.h>

#include "gprojt_form.h"

__declspec(dllimport) unsigned long __stdcall GetFileAttributesW(const wchar_t *path);
__declspec(dllimport) unsigned long __stdcall GetCurrentDirectoryW(unsigned long size, wchar_t *folder);
__declspec(dllimport) int __stdcall CreateDirectoryW(const wchar_t *path, void *security);
__declspec(dllimport) int __stdcall SetCurrentDirectoryW(const wchar_t *path);
__declspec(dllimport) void *__stdcall CreateFileW(const wchar_t *path, unsigned long access, unsigned long share,
                                                  void *security, unsigned long disposition, unsigned long flags,
                                                  void *model);
__declspec(dllimport) int __stdcall ReadFile(void *file, void *buffer, unsigned long size, unsigned long *got,
                                             void *later);
__declspec(dllimport) int __stdcall WriteFile(void *file, const void *buffer, unsigned long size, unsigned long *put,
                                              void *later);
__declspec(dllimport) int __stdcall CloseHandle(void *handle);
__declspec(dllimport) unsigned long __stdcall WaitForSingleObject(void *handle, unsigned long milliseconds);
/* `found` takes 592 bytes. */
__declspec(dllimport) void *__stdcall FindFirstFileW(const wchar_t *pattern, void *found);
__declspec(dllimport) int __stdcall FindClose(void *search);

static const unsigned long gprojt_reading = 0x80000000, gprojt_writing = 0x40000000; /* access */
static const unsigned long gprojt_new = 2, gprojt_existing = 3;                      /* disposition */
#define GPROJT_INVALID ((void *)(intptr_t)-1)

static bool gprojt_exists(const wchar_t *path) { return GetFileAttributesW(path) != 0xffffffff; }

/* A file's bytes, at most 99,999, and a NUL; NULL: it cannot be opened. In one buffer. */
static const char *gprojt_bytes(const wchar_t *path) {
    static char text[100000];
    unsigned long got = 0;
    void *file = CreateFileW(path, gprojt_reading, 7, NULL, gprojt_existing, 0, NULL);
    if (file == GPROJT_INVALID) return NULL;
    ReadFile(file, text, sizeof text - 1, &got, NULL);
    CloseHandle(file);
    text[got] = 0;
    return text;
}

static bool gprojt_put(const wchar_t *path, const char *text) {
    unsigned long put = 0;
    void *file = CreateFileW(path, gprojt_writing, 7, NULL, gprojt_new, 0, NULL);
    if (file == GPROJT_INVALID) return false;
    WriteFile(file, text, (unsigned long)strlen(text), &put, NULL);
    CloseHandle(file);
    return put == strlen(text);
}

/* No temporary file is left in the present folder. */
static bool gprojt_tidy(void) {
    uint64_t found[128];
    void *search = FindFirstFileW(L"gproj-*.tmp", found);
    if (search == GPROJT_INVALID) return true;
    FindClose(search);
    return false;
}

/* A mesh that says by its size which one it is, and its text. */
static gproj_mesh *gprojt_small(int32_t n) { return gprojt_mesh_of(gprojt_quad_grid(n, n)); }
static bool gprojt_is(const wchar_t *path, int32_t n) {
    const char *text = gprojt_bytes(path), *at;
    int32_t vertices = 0, faces = 0;
    for (at = text; at && *at; at = strchr(at, '\n') + 1) {
        vertices += at[0] == 'v', faces += at[0] == 'f';
        if (!strchr(at, '\n')) return false;
    }
    return text && !strchr(text, '\r') && vertices == (n + 1) * (n + 1) && faces == n * n;
}

/* Saves and loads by one path, whose file is seen under the other. */
static void gprojt_there_and_back(const char *path, const wchar_t *wide) {
    int32_t n;
    for (n = 2; n < 5; ++n) { /* a new file, then one that is replaced */
        gproj_mesh *mesh = gprojt_small(n), *again;
        gproj_error error;
        memset(&error, 0, sizeof error);
        if (gproj_mesh_save(mesh, path, &error) != GPROJ_OK) printf("  %s\n", error.message);
        GPROJT_CHECK(gprojt_is(wide, n));
        again = gproj_mesh_load(path, NULL, &error);
        GPROJT_CHECK(again && again->vertex_count == mesh->vertex_count);
        gproj_mesh_destroy(mesh), gproj_mesh_destroy(again);
    }
    GPROJT_CHECK(gprojt_tidy());
}

static bool gprojt_refused(const char *path, const char *part) {
    gproj_mesh *mesh = gprojt_small(2);
    gproj_error error;
    bool refused;
    memset(&error, 0, sizeof error);
    refused = gproj_mesh_save(mesh, path, &error) == GPROJ_ERROR_FILE && strstr(error.message, part);
    if (!refused) printf("  '%s': %s\n", path, error.message);
    gproj_mesh_destroy(mesh);
    return refused && gprojt_tidy();
}

GPROJT_TEST(plain_paths) {
    gprojt_there_and_back("plain.obj", L"plain.obj");
    GPROJT_REQUIRE(CreateDirectoryW(L"folder", NULL));
    gprojt_there_and_back("folder\\back.obj", L"folder\\back.obj");
    gprojt_there_and_back("folder/forward.obj", L"folder\\forward.obj");
    gprojt_there_and_back("folder\\..\\folder/.\\mixed.obj", L"folder\\mixed.obj");
    GPROJT_REQUIRE(CreateDirectoryW(L"folder.obj", NULL));
    GPROJT_CHECK(gprojt_refused("folder.obj", "it is a folder"));
    GPROJT_CHECK(gprojt_refused("nowhere\\x.obj", "does that exist"));
}

/* Latin, Chinese, and a character beyond 16 bits; a folder and a file. */
GPROJT_TEST(paths_in_utf8) {
    GPROJT_REQUIRE(CreateDirectoryW(L"d\u00e9p\u00f4t", NULL));
    gprojt_there_and_back("d\xc3\xa9p\xc3\xb4t/\xe5\xb1\x8b\xe6\xa0\xb9-\xf0\x9f\x8f\xa0.obj",
                          L"d\u00e9p\u00f4t\\\u5c4b\u6839-\xd83c\xdfe0.obj");
    GPROJT_CHECK(gprojt_refused("d\xe9p\xf4t.obj", "")); /* Latin-1 is no UTF-8 */
    GPROJT_CHECK(!gprojt_exists(L"dpt.obj"));
}

GPROJT_TEST(long_paths) {
    static char path[2000];
    static wchar_t wide[2000] = L"\\\\?\\";
    size_t length, i, level;
    unsigned long full;
    full = GetCurrentDirectoryW(400, wide + 4);
    GPROJT_REQUIRE(full > 0 && full < 400);
    length = 4 + full;
    for (level = 0; level < 12; ++level) {
        wide[length++] = '\\';
        for (i = 0; i < 80; ++i) wide[length++] = (wchar_t)('a' + level);
        GPROJT_REQUIRE(CreateDirectoryW(wide, NULL));
    }
    wcscpy(wide + length, L"\\x.obj");
    for (i = 0; wide[4 + i]; ++i) path[i] = (char)wide[4 + i];
    gprojt_there_and_back(path, wide);                 /* C:\... */
    gprojt_there_and_back(path + full + 1, wide);      /* relative */
    for (i = 0; wide[i]; ++i) path[i] = (char)wide[i]; /* \\?\C:\... */
    gprojt_there_and_back(path, wide);
    GPROJT_CHECK(!gprojt_exists(L"x.obj"));
    memset(path, 'x', sizeof path - 5); /* a name that no system can have */
    memcpy(path + sizeof path - 5, ".obj", 5);
    GPROJT_CHECK(gprojt_refused(path, "no file can be made") || gprojt_refused(path, "cannot be replaced"));
}

GPROJT_TEST(old_files_stay_where_they_cannot_be_replaced) {
    void *open;
    GPROJT_REQUIRE(gprojt_put(L"old.obj", "old\n"));
    open = CreateFileW(L"old.obj", gprojt_reading, 1, NULL, gprojt_existing, 0, NULL); /* nobody else may delete */
    GPROJT_REQUIRE(open != GPROJT_INVALID);
    GPROJT_CHECK(gprojt_refused("old.obj", "cannot be replaced"));
    GPROJT_CHECK(strcmp(gprojt_bytes(L"old.obj"), "old\n") == 0);
    CloseHandle(open);
    gprojt_there_and_back("old.obj", L"old.obj");
}

/* Several threads save different meshes to one path, each often. */
static void gprojt_often(void *user) {
    int i;
    for (i = 0; i < 20; ++i) gproj_mesh_save((const gproj_mesh *)user, "many.obj", NULL);
    _endthread();
}
GPROJT_TEST(many_at_the_same_time) {
    gproj_mesh *mesh[4];
    uintptr_t thread[4];
    int i;
    bool whole = false;
    for (i = 0; i < 4; ++i) mesh[i] = gprojt_small(5 + i);
    for (i = 0; i < 4; ++i) thread[i] = _beginthread(gprojt_often, 0, mesh[i]);
    for (i = 0; i < 4; ++i) WaitForSingleObject((void *)thread[i], 60000);
    for (i = 0; i < 4; ++i) whole = whole || gprojt_is(L"many.obj", 5 + i);
    GPROJT_CHECK(whole && gprojt_tidy());
    for (i = 0; i < 4; ++i) gproj_mesh_destroy(mesh[i]);
}

int main(void) {
    wchar_t folder[] = L"windows-00000000";
    int k, number = _getpid();
    for (k = 15; k >= 8; --k, number /= 10) folder[k] = (wchar_t)('0' + number % 10);
    if (!CreateDirectoryW(folder, NULL) || !SetCurrentDirectoryW(folder)) return printf("no folder can be made\n"), 1;
    GPROJT_RUN(plain_paths);
    GPROJT_RUN(paths_in_utf8);
    GPROJT_RUN(long_paths);
    GPROJT_RUN(old_files_stay_where_they_cannot_be_replaced);
    GPROJT_RUN(many_at_the_same_time);
    return gprojt_report();
}
