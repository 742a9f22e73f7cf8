/* share.h - as Microsoft's declares it, as far as tests and library use it. */
#pragma once
#define _SH_DENYNO 0x40
