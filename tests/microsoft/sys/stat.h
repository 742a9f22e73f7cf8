/* stat.h - as Microsoft's declares it, as far as tests and library use it. */
#pragma once
#define _S_IREAD 0x0100
#define _S_IWRITE 0x0080
