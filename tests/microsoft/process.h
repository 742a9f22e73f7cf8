/* process.h - as Microsoft's declares it, as far as tests and library use it. */
#pragma once
#include <stdint.h>
#ifdef __cplusplus
extern "C" {
#endif
int _getpid(void);
uintptr_t _beginthread(void(__cdecl *)(void *), unsigned, void *);
void _endthread(void);
#ifdef __cplusplus
}
#endif
