/* io.h - as Microsoft's declares it, as far as tests and library use it. */
#pragma once
#include <stddef.h>
#ifdef __cplusplus
extern "C" {
#endif
int _wsopen_s(int *, const wchar_t *, int, int, int);
int _read(int, void *, unsigned), _write(int, const void *, unsigned), _close(int), _commit(int);
#ifdef __cplusplus
}
#endif
