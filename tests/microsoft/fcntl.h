/* fcntl.h - as Microsoft's declares it, as far as tests and library use it. */
#pragma once
#define _O_RDONLY 0x0000
#define _O_WRONLY 0x0001
#define _O_CREAT 0x0100
#define _O_EXCL 0x0400
#define _O_BINARY 0x8000
#define _O_NOINHERIT 0x0080
