#!/bin/bash
# check_microsoft.sh - the header compiles in the dialect of Microsoft's compiler without a warning, as C and C++, with the
# switches, and with declarations of its C library in tests/microsoft. The compiler itself has never been asked.
# platforms.sh runs what comes out.
. "$(dirname "$0")/checks.sh"

if have clang; then
    flags='-Wall -Wextra -Wno-unused-function -Wconversion -Wshadow -Werror' # other compilers warn of unused ones
    for file in '-std=c11 whole.c' '-std=c17 whole.c' '-std=c++14 whole.cpp' '-std=c++20 whole.cpp'; do
        for switch in '' -DGPROJ_STATIC -DGPROJ_NO_STDIO; do
            job "$file $switch" "bash '$PWD/microsoft/cc.sh' $flags $switch -I'$root' -fsyntax-only $file"
        done
    done
    run_jobs
else
    skip 'the dialect of Microsoft: no clang'
fi
report
