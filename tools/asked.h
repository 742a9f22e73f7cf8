/* asked.h - what a run was asked for, as a list of texts that a state file keeps: a later run may go on from there only if
   it is asked for the same, and is told what differs.

       if (!gprojx_asked_add(&asked, "--fairness 0.3", NULL)) ...
       if (!gprojx_asked_write(&asked, file)) ...
       start = gprojx_asked_compare(&asked, bytes, size, words, sizeof words); ...

   Lists are sorted: the order in which things are asked for does not matter. In a file: the line GPROJX_ASKED_MARK, the
   texts, each with a NUL behind it, and one more NUL. */
#ifndef GPROJX_ASKED_H
#define GPROJX_ASKED_H

#include <stdbool.h>
#include <stdint.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>

#define GPROJX_ASKED_MARK "guidedproj state 3\n"

typedef struct gprojx_asked_item {
    char *text; /* an option as it was given; of a file, a hash of what is in it */
    char *file; /* its name, which does not count; NULL: an option */
} gprojx_asked_item;

/* Begins as zeros; gprojx_asked_free ends it. */
typedef struct gprojx_asked {
    gprojx_asked_item *item; /* sorted by text */
    size_t count;
} gprojx_asked;

/* Adds a text, copied; `file`: see gprojx_asked_item. False without memory. */
static bool gprojx_asked_add(gprojx_asked *asked, const char *text, const char *file) {
    gprojx_asked_item *item = (gprojx_asked_item *)realloc(asked->item, (asked->count + 1) * sizeof *item), added;
    size_t at = asked->count, size = strlen(text) + 1, file_size = file ? strlen(file) + 1 : 0;
    if (!item) return false;
    asked->item = item;
    added.text = (char *)malloc(size + file_size); /* for both */
    if (!added.text) return false;
    added.file = file ? added.text + size : NULL;
    memcpy(added.text, text, size);
    if (file) memcpy(added.file, file, file_size);
    for (; at > 0 && strcmp(item[at - 1].text, text) > 0; --at) item[at] = item[at - 1];
    item[at] = added;
    ++asked->count;
    return true;
}

/* Adds a file by the hash of its bytes (Fowler, Noll, Vo). False without memory. */
static bool gprojx_asked_add_file(gprojx_asked *asked, const char *file, const void *bytes, size_t size) {
    uint64_t hash = 0xcbf29ce484222325u;
    char text[32];
    size_t i;
    for (i = 0; i < size; ++i) hash = (hash ^ ((const uint8_t *)bytes)[i]) * 0x100000001b3u;
    snprintf(text, sizeof text, "file %016llx", (unsigned long long)hash);
    return gprojx_asked_add(asked, text, file);
}

static void gprojx_asked_free(gprojx_asked *asked) {
    size_t i;
    for (i = 0; i < asked->count; ++i) free(asked->item[i].text);
    free(asked->item);
    memset(asked, 0, sizeof *asked);
}

/* Writes the list at the beginning of a state file. */
static bool gprojx_asked_write(const gprojx_asked *asked, FILE *file) {
    bool good = fputs(GPROJX_ASKED_MARK, file) >= 0;
    size_t i;
    for (i = 0; good && i < asked->count; ++i) {
        size_t size = strlen(asked->item[i].text) + 1;
        good = fwrite(asked->item[i].text, 1, size, file) == size;
    }
    return good && fputc(0, file) == 0;
}

/* Tells two lists apart in words that follow "was written": by `now`, the first item that only this one has, and `then`,
   the first that only the other one has; NULL: there is none. Options come before files. */
static void gprojx_asked_tell(const gprojx_asked_item *now, const char *then, char *words, size_t room) {
    bool option_now = now && !now->file, option_then = then && then[0] == '-';
    size_t name = option_then ? strcspn(then, " =") : 0;
    if (option_now && option_then && strncmp(now->text, then, name) == 0 && strcspn(now->text, " =") == name)
        snprintf(words, room, "with %s, not %s", then, now->text);
    else if (option_then)
        snprintf(words, room, "with %s", then);
    else if (option_now)
        snprintf(words, room, "without %s", now->text);
    else if (now)
        snprintf(words, room, "before %s was changed", now->file);
    else
        snprintf(words, room, "%s", then ? "with a further file" : "");
}

/* Compares the list with that in the `size` bytes of a state file, and tells in `words` how they differ, see
   gprojx_asked_tell; "": not at all. Returns the length of the list in the file; 0: these are no such bytes. */
static size_t gprojx_asked_compare(const gprojx_asked *asked, const void *bytes, size_t size, char *words,
                                   size_t room) {
    const char *at = (const char *)bytes, *end = at + size, *then = NULL;
    const gprojx_asked_item *now = NULL;
    size_t i = 0, mark = strlen(GPROJX_ASKED_MARK);
    if (size < mark || memcmp(at, GPROJX_ASKED_MARK, mark) != 0) return 0;
    for (at += mark; at < end && memchr(at, 0, (size_t)(end - at));) {
        int order = i == asked->count ? 1 : *at == 0 ? -1 : strcmp(asked->item[i].text, at);
        if (*at == 0 && i == asked->count) {
            gprojx_asked_tell(now, then, words, room);
            return (size_t)(at + 1 - (const char *)bytes);
        }
        if (order < 0 && !now) now = &asked->item[i];
        if (order > 0 && !then) then = at;
        i += order <= 0;
        if (order >= 0) at += strlen(at) + 1;
    }
    return 0;
}

#endif
