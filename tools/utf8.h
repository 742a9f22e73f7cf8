/* utf8.h - the characters of UTF-8 in texts from outside, which may hold any bytes. */
#ifndef GPROJX_UTF8_H
#define GPROJX_UTF8_H

#include <stddef.h>

/* The bytes of the UTF-8 character that begins here (Unicode 3.9, without the finer bounds); 0: it is none. */
static size_t gprojx_utf8_size(const char *text) {
    unsigned char c = (unsigned char)text[0];
    size_t size = c < 0x80                ? 1
                  : c >= 0xc2 && c < 0xe0 ? 2
                  : c >= 0xe0 && c < 0xf0 ? 3
                  : c >= 0xf0 && c < 0xf5 ? 4
                                          : 0,
           k;
    for (k = 1; k < size; ++k)
        if (((unsigned char)text[k] & 0xc0) != 0x80) return 0;
    return size;
}

#endif
