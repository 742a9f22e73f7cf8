#!/bin/bash
# check_compile.sh - the header compiles without a warning: compilers, language standards, switches, targets.
. "$(dirname "$0")/checks.sh"

flags='-Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wcast-qual -Wvla -Wundef -Werror'
seconds() { # seconds LABEL COMMAND...: measures, and prints for people to see
    local start=$EPOCHREALTIME label=$1
    shift
    "$@" >/dev/null 2>&1
    start=$(((${EPOCHREALTIME/[.,]/} - ${start/[.,]/}) / 10000))
    printf '%s compiles in %d.%02d s\n' "$label" $((start / 100)) $((start % 100))
    if [ $start -le 2000 ]; then pass; else fail "$label takes more than 20 s to compile"; fi
}

# All combinations of the switches.
switches=('')
for switch in GUIDEDPROJ_IMPLEMENTATION GPROJ_STATIC GPROJ_NO_STDIO GPROJ_NO_SIMD GPROJ_USE_CBLAS; do
    if [ $switch = GPROJ_USE_CBLAS ] && ! have_cblas; then
        skip 'GPROJ_USE_CBLAS: no cblas.h'
        continue
    fi
    for combination in "${switches[@]}"; do switches+=("$combination -D$switch"); done
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

# Some warnings come from the optimiser only.
for compiler in gcc clang g++ clang++ tcc i686-linux-gnu-gcc i686-linux-gnu-g++ \
    x86_64-w64-mingw32-gcc x86_64-w64-mingw32-g++; do
    if ! have $compiler; then skip "$compiler -O2: not installed"; continue; fi
    language='-std=c99 whole.c' strict=$flags syntax=-fsyntax-only
    case $compiler in
    *++) language='-std=c++11 whole.cpp' ;;
    tcc) strict='-Wall -Werror' language=whole.c syntax='-o syntax.o -c' ;;
    esac
    job "$compiler -O2" "$compiler -O2 $strict -I'$root' -c $language -o $compiler.o"
    case $compiler in
    tcc | *-*)
        for combination in "${switches[@]}"; do
            case $combination in *CBLAS*) continue ;; esac
            job "$compiler$combination" "$compiler $strict$combination -I'$root' $syntax ${language/whole/header}"
        done
        ;;
    esac
done
for compiler in gcc clang; do
    have $compiler || continue
    for more in -DGPROJ_STATIC -DGPROJ_NO_SIMD -O3 '-mavx2 -mfma' -mavx512f; do
        case "$more $(uname -m)" in *x86_64) ;; -mavx*) continue ;; esac
        case "$compiler $more" in 'clang -O3' | 'clang -mavx2 -mfma' | 'clang -DGPROJ_NO_SIMD') continue ;; esac
        job "$compiler -O2 $more" "$compiler -O2 $more $flags -std=c99 -I'$root' -c whole.c -o $compiler${more// /}.o"
    done
done
wasm='clang --target=wasm32-wasi'
if echo '#include <stdlib.h>' | $wasm -E -x c - >/dev/null 2>&1; then
    job 'clang -O2 to wasm32' "$wasm -O2 $flags -std=c99 -I'$root' -c whole.c -o wasm.o"
    job 'clang -O2 to wasm32, SIMD' "$wasm -msimd128 -O2 $flags -std=c99 -I'$root' -c whole.c -o wasm_simd.o"
    job 'clang -O2 to wasm32, no stdio' "$wasm -O2 $flags -std=c99 -DGPROJ_NO_STDIO -I'$root' -c whole.c -o wasm_no_stdio.o"
else
    skip 'clang to wasm32: no clang or no wasi-libc'
fi
run_jobs

for compiler in gcc clang; do
    have $compiler && seconds "$compiler -O2" $compiler -O2 -I"$root" -c "$work/whole.c" -o "$work/time.o"
done
report
