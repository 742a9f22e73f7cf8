#!/bin/bash
# check_compile.sh - the header compiles without a warning: compilers, language standards, switches. No function takes more
# than 32 KB of stack, and none a size known only at run time. Other targets and options: platform_compile.sh, which
# platforms.sh runs.
. "$(dirname "$0")/checks.sh"
. ./compile.sh

for compiler in gcc clang; do
    syntax $compiler c99 "${modes[@]}" "${without[@]}" "${cblas[@]}" "${vectors[@]/%/$implement}"
    have $compiler || continue # the time that it takes is looked at below
    job "$compiler -O2" "exec 3>&2; TIMEFORMAT=%U; { time $compiler -O2 $fixed $strict $(stack $compiler) -I'$root' -std=c99 -c whole.c -o $compiler.o 2>&3; } 2>$compiler.seconds"
done
for compiler in g++ clang++; do
    syntax $compiler c++11 "${modes[@]}" "${cblas[@]}"
done
for compiler in 'x86_64-w64-mingw32-gcc -std=c99 header.c' 'x86_64-w64-mingw32-g++ -std=c++11 header.cpp'; do
    have ${compiler%% *} || continue # windows.h has macros for near, far, small, min, ...
    job "${compiler%% *}, after windows.h" \
        "${compiler% *} -Wall -Wextra -Werror -include windows.h$implement -I'$root' -fsyntax-only ${compiler##* }"
done
if have tcc; then # what it compiles also runs
    for combination in "${modes[@]}" "${without[@]}"; do
        job "tcc$combination" "tcc -Wall -Werror$combination -I'$root' -o syntax.o -c header.c"
    done
    job 'tcc -O2' "tcc -O2 -Wall -Werror -I'$root' -c whole.c -o tcc.o"
    job 'tcc, running' "tcc -I'$root' -I'$root/tests' '$root/tests/test_dense.c' -o tcc.dense -lm && ./tcc.dense >tcc.dense.log || cat tcc.dense.log"
else
    skip 'tcc: not installed'
fi
run_jobs

for object in gcc clang; do
    [ ! -f "$work/$object.o" ] || symbols "$object" "$work/$object.o"
done

# How long gcc and clang take; machines have slow spells, so in the best of three attempts, the others with nothing beside.
TIMEFORMAT=%U
for compiler in gcc clang; do
    have $compiler || continue
    seconds=$(cat "$work/$compiler.seconds")
    for attempt in 2 3; do
        [ "${seconds%[.,]*}" -lt 20 ] && break
        seconds=$({ time $compiler -O2 -std=c99 -I"$root" -c "$work/whole.c" -o "$work/timed.o"; } 2>&1)
    done
    echo "$compiler -O2 compiles in $seconds s"
    if [ "${seconds%[.,]*}" -lt 20 ]; then pass; else fail "$compiler -O2 takes more than 20 s to compile"; fi
done
report
