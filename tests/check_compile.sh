#!/bin/bash
# check_compile.sh - the header compiles without a warning: compilers, language standards, switches, targets. No function
# takes more than 32 KB of stack, and none a size known only at run time.
. "$(dirname "$0")/checks.sh"

flags='-Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wcast-qual -Wvla -Wundef -Werror'
limit=32768
stack() { # stack COMPILER: its option that warns of large frames; gcc's also of those of no fixed size
    case $1 in clang*) echo -Wframe-larger-than=$limit ;; *) echo -Wstack-usage=$limit ;; esac
}

# All combinations of the switches; static mode implements by itself.
switches=('')
for switch in GUIDEDPROJ_IMPLEMENTATION GPROJ_STATIC GPROJ_NO_STDIO GPROJ_NO_SIMD GPROJ_USE_CBLAS; do
    if [ $switch = GPROJ_USE_CBLAS ] && ! have_cblas; then
        skip 'GPROJ_USE_CBLAS: no cblas.h'
        continue
    fi
    for combination in "${switches[@]}"; do
        case $switch$combination in GPROJ_STATIC*IMPLEMENTATION*) continue ;; esac
        switches+=("$combination -D$switch")
    done
done

# syntax FILE STANDARD COMPILER: each combination (the later standards without CBLAS), and the vector units
syntax() {
    local file=$1 standard=$2 compiler combination vector
    shift 2
    for compiler; do
        if ! have "$compiler"; then skip "$compiler -std=$standard: not installed"; continue; fi
        for combination in "${switches[@]}"; do
            case $standard$combination in c11*CBLAS* | c++20*CBLAS*) continue ;; esac
            job "$compiler -std=$standard$combination" \
                "$compiler -std=$standard $flags$combination -I'$root' -fsyntax-only $file"
        done
        case $standard-$(uname -m) in
        c11-* | c++20-*) continue ;;
        *-x86_64) set -- '-march=native' '-mavx2 -mfma' '-mavx512f' ;;
        *) set -- '-march=native' ;;
        esac
        for vector; do
            job "$compiler -std=$standard $vector" \
                "$compiler -std=$standard $flags $vector -DGUIDEDPROJ_IMPLEMENTATION -I'$root' -fsyntax-only $file"
        done
    done
}
for standard in c99 c11; do
    syntax header.c $standard gcc
    syntax header.c $standard clang
done
for standard in c++11 c++20; do
    syntax header.cpp $standard g++
    syntax header.cpp $standard clang++
done

# Some warnings, and the stack, come from code generation only.
for compiler in gcc clang g++ clang++ tcc i686-linux-gnu-gcc i686-linux-gnu-g++ \
    x86_64-w64-mingw32-gcc x86_64-w64-mingw32-g++; do
    if ! have $compiler; then skip "$compiler -O2: not installed"; continue; fi
    language='-std=c99 whole.c' strict="$flags $(stack $compiler)" syntax=-fsyntax-only
    case $compiler in
    *++) language="-std=c++11 whole.cpp" ;;
    tcc) strict='-Wall -Werror' language=whole.c syntax='-o syntax.o -c' ;;
    esac
    case $compiler in
    gcc | clang) # the time that it takes is looked at below
        job "$compiler -O2" "exec 3>&2; TIMEFORMAT=%U; { time $compiler -O2 $fixed $strict -I'$root' -c $language -o $compiler.o 2>&3; } 2>$compiler.seconds" ;;
    g++ | clang++) job "$compiler -O2" "$compiler -O2 $fixed $strict -I'$root' -c $language -o $compiler.o" ;;
    *) job "$compiler -O2" "$compiler -O2 $strict -I'$root' -c $language -o $compiler.o" ;;
    esac
    case $compiler in
    tcc | *-*)
        for combination in "${switches[@]}"; do
            case $combination in *CBLAS*) continue ;; esac
            job "$compiler$combination" "$compiler $strict$combination -I'$root' $syntax ${language/whole/header}"
        done
        ;;
    esac
done
for compiler in 'x86_64-w64-mingw32-gcc -std=c99 header.c' 'x86_64-w64-mingw32-g++ -std=c++11 header.cpp'; do
    have ${compiler%% *} || continue # windows.h has macros for near, far, small, min, ...
    job "${compiler%% *}, after windows.h" \
        "${compiler% *} -Wall -Wextra -Werror -include windows.h -DGUIDEDPROJ_IMPLEMENTATION -I'$root' -fsyntax-only ${compiler##* }"
done
if have tcc; then # what it compiles also runs
    job 'tcc, running' "tcc -I'$root' -I'$root/tests' '$root/tests/test_dense.c' -o tcc.dense -lm && ./tcc.dense >tcc.dense.log || cat tcc.dense.log"
fi
case $(uname -m) in x86_64) vectors='-mavx2 -mfma' ;; *) vectors= ;; esac
for compiler in gcc clang; do
    have $compiler || continue
    for options in -O0 '-O2 -DGPROJ_STATIC' '-O2 -DGPROJ_NO_SIMD' "-O3 $vectors" '-O2 -mavx512f'; do
        case "$options $(uname -m)" in *x86_64) ;; *-mavx512f*) continue ;; esac
        case "$compiler $options" in 'clang -O2 -DGPROJ_NO_SIMD') continue ;; esac
        job "$compiler $options" \
            "$compiler $options $fixed $flags $(stack $compiler) -std=c99 -I'$root' -c whole.c -o $compiler${options// /}.o"
    done
done
wasm='clang --target=wasm32-wasi'
if echo '#include <stdlib.h>' | $wasm -E -x c - >/dev/null 2>&1; then
    job 'clang -O2 to wasm32' "$wasm -O2 $flags $(stack clang) -std=c99 -I'$root' -c whole.c -o wasm.o"
    job 'clang -O2 to wasm32, SIMD' "$wasm -msimd128 -O2 $flags $(stack clang) -std=c99 -I'$root' -c whole.c -o wasm_simd.o"
    job 'clang -O2 to wasm32, no stdio' "$wasm -O2 $flags $(stack clang) -std=c99 -DGPROJ_NO_STDIO -I'$root' -c whole.c -o wasm_no_stdio.o"
else
    skip 'clang to wasm32: no clang or no wasi-libc'
fi
run_jobs

for object in gcc clang g++ clang++ gcc-O2-DGPROJ_NO_SIMD "gcc-O3${vectors// /}" "clang-O3${vectors// /}"; do
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
