/* utf8.h - the characters of UTF-8 in texts from outside, which may hold any bytes. */
#ifndef GPROJX_UTF8_H
#define GPROJX_UTF8_H

#include <stddef.h>

/* The bytes of the UTF-8 character that begins here (Unicode, table 3-7: neither longer than needed, nor a surrogate, nor
   beyond U+10FFFF); 0: it is none. */
static size_t gprojx_utf8_size(const char *text) {
    unsigned char c = (unsigned char)text[0], low = 0x80, high = 0xbf; /* bounds of the second byte */
    size_t size = c < 0x80                ? 1
                  : c >= 0xc2 && c < 0xe0 ? 2
                  : c >= 0xe0 && c < 0xf0 ? 3
                  : c >= 0xf0 && c < 0xf5 ? 4
                                          : 0,
           k;
    if (c == 0xe0) low = 0xa0;
    if (c == 0xed) high = 0x9f;
    if (c == 0xf0) low = 0x90;
    if (c == 0xf4) high = 0x8f;
    for (k = 1; k < size; ++k, low = 0x80, high = 0xbf)
        if ((unsigned char)text[k] < low || (unsigned char)text[k] > high) return 0;
    return size;
}

#endif
