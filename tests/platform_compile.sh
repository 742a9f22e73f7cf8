# platform_compile.sh - the header compiles without a warning, and with little stack: what check_compile.sh has no time for,
# other targets and levels of optimisation, and the other combinations of switches, standards and vector units. Sourced by
# platforms.sh.
. ./compile.sh

for compiler in gcc clang; do
    syntax $compiler c99 "${without_cblas[@]}"
    syntax $compiler c11 "${modes[@]}" "${without[@]}"
done
for compiler in g++ clang++; do
    syntax $compiler c++11 "${without[@]}" "${without_cblas[@]}" "${vectors[@]/%/$implement}"
    syntax $compiler c++20 "${modes[@]}" "${without[@]}"
    object $compiler $compiler "-O2 $fixed"
done
for compiler in i686-linux-gnu-gcc i686-linux-gnu-g++ x86_64-w64-mingw32-gcc x86_64-w64-mingw32-g++; do
    case $compiler in *++) standard=c++11 ;; *) standard=c99 ;; esac
    syntax $compiler $standard "${modes[@]}" "${without[@]}"
    object $compiler $compiler -O2
done
for compiler in gcc clang; do
    object $compiler-O0 $compiler "-O0 $fixed"
    object $compiler-static $compiler "-O2 -DGPROJ_STATIC $fixed"
    [ $compiler = clang ] || object $compiler-scalar $compiler "-O2 -DGPROJ_NO_SIMD $fixed"
    object $compiler-O3 $compiler "-O3 $fused $fixed"
    [ "$(uname -m)" != x86_64 ] || object $compiler-avx512 $compiler "-O2 -mavx512f $fixed"
done
wasm='clang --target=wasm32-wasi'
if echo '#include <stdlib.h>' | $wasm -E -x c - >/dev/null 2>&1; then
    object wasm "$wasm" -O2
    object wasm-simd "$wasm" '-msimd128 -O2'
    object wasm-no-stdio "$wasm" '-O2 -DGPROJ_NO_STDIO'
else
    skip 'clang to wasm32: no clang or no wasi-libc'
fi
run_jobs
for object in g++ clang++ gcc-scalar gcc-O3 clang-O3; do
    [ ! -f "$work/$object.o" ] || symbols "$object" "$work/$object.o"
done
