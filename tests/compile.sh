# compile.sh - what check_compile.sh and platform_compile.sh have in common; sourced after checks.sh.
strict='-Wall -Wextra -Wpedantic -Wconversion -Wshadow -Wcast-qual -Wvla -Wundef -Werror'
limit=32768
stack() { # stack COMPILER: its option that warns of large frames; gcc's also of those of no fixed size
    case $1 in clang*) echo -Wframe-larger-than=$limit ;; *) echo -Wstack-usage=$limit ;; esac
}

# All combinations of the switches, in four lists; static mode implements by itself.
modes=('' ' -DGUIDEDPROJ_IMPLEMENTATION' ' -DGPROJ_STATIC')
without=("${modes[@]/%/ -DGPROJ_NO_STDIO}" "${modes[@]/%/ -DGPROJ_NO_SIMD}" "${modes[@]/%/ -DGPROJ_NO_STDIO -DGPROJ_NO_SIMD}")
cblas=("${modes[@]/%/ -DGPROJ_USE_CBLAS}")
without_cblas=("${without[@]/%/ -DGPROJ_USE_CBLAS}")
if ! have_cblas; then
    skip 'GPROJ_USE_CBLAS: no cblas.h'
    cblas=() without_cblas=()
fi
implement=' -DGUIDEDPROJ_IMPLEMENTATION'
case $(uname -m) in
x86_64) vectors=(' -march=native' ' -mavx2 -mfma' ' -mavx512f') fused='-mavx2 -mfma' ;;
*) vectors=(' -march=native') fused= ;;
esac

# syntax COMPILER STANDARD OPTIONS...: a job for each of the options
syntax() {
    local compiler=$1 standard=$2 file=header.c warnings=$strict options
    shift 2
    have "$compiler" || { skip "$compiler -std=$standard: not installed"; return; }
    case $compiler in
    *++) file=header.cpp ;;
    *gcc) warnings+=' -Wno-misleading-indentation' ;; # three quarters of its time; g++ tells the same
    esac
    for options; do
        job "$compiler -std=$standard$options" "$compiler -std=$standard $warnings$options -I'$root' -fsyntax-only $file"
    done
}

# object NAME COMPILER OPTIONS: a job that compiles the implementation to NAME.o. Some warnings, and the stack, come from code
# generation only.
object() {
    local language='-std=c99 whole.c'
    have "${2%% *}" || { skip "$2 $3: not installed"; return; }
    case $2 in *++) language='-std=c++11 whole.cpp' ;; esac
    job "$2 $3" "$2 $3 $strict $(stack "$2") -I'$root' -c $language -o '$1.o'"
}
