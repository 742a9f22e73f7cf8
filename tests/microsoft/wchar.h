/* wchar.h - as Microsoft's declares it, as far as tests and library use it. */
#pragma once
#include <stddef.h>
wchar_t *wcscpy(wchar_t *, const wchar_t *);
