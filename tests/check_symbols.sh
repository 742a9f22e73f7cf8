#!/bin/bash
# check_symbols.sh - what the object file shows: names with the prefix only, no mutable data, nothing in static mode;
# the header in several files of one program, of one and of both languages.
. "$(dirname "$0")/checks.sh"

have nm || { skip 'nm: not installed'; report; }
# Programs of two files.
printf '#include "guidedproj.h"\n#ifdef __cplusplus\nextern "C"\n#endif\nint other(void);\nint main(void) { return other() + !gproj_code_string(GPROJ_OK); }\n' >"$work/main.c"
printf '#include "guidedproj.h"\n#ifdef __cplusplus\nextern "C"\n#endif\nint other(void);\nint other(void) { return !gproj_code_string(GPROJ_OK); }\n' >"$work/other.c"
cp "$work/main.c" "$work/main.cpp"
implement=-DGUIDEDPROJ_IMPLEMENTATION
# Without optimisation, the calls are those of the source; check_compile.sh and platform_compile.sh look at optimised objects of
# all compilers. The file implements once and includes twice more.
sed '1i #include "guidedproj.h"' "$work/whole.c" >"$work/twice.c"
echo '#include "guidedproj.h"' >>"$work/twice.c"
for switch in '' -DGPROJ_NO_STDIO; do
    have gcc || break
    job "gcc $switch" "gcc $fixed -I'$root' $switch -c twice.c -o 'symbols$switch.o'"
done
for compiler in gcc g++ clang clang++ 'gcc -DGPROJ_NO_SIMD -DGPROJ_NO_STDIO'; do
    have ${compiler%% *} || { skip "$compiler: not installed"; continue; }
    case $compiler in *++) file=whole.cpp ;; *) file=whole.c ;; esac
    job "$compiler in static mode" "$compiler $fixed -I'$root' -DGPROJ_STATIC -c $file -o 'static.$compiler.o'"
done
run_jobs
# -O1 leaves out what a program in static mode does not call.
if have gcc; then
    job 'static mode in two C files' \
        "gcc -O1 -I'$root' -DGPROJ_STATIC $implement main.c other.c -lm -o two_static && ./two_static"
    job 'implementation in one C file, use from others' "gcc $fixed -no-pie -I'$root' main.c other.c symbols.o -lm -o two && ./two"
fi
if have gcc && have g++; then
    job 'implementation in one C file, use from others, in C and C++' \
        "gcc -I'$root' -c other.c -o b.o && g++ $fixed -no-pie -I'$root' main.cpp b.o symbols.o -lm -o mixed && ./mixed"
    job 'implementation in C++, use from C' \
        "g++ -I'$root' $implement -c main.cpp -o c.o && gcc -I'$root' -c other.c -o d.o && g++ c.o d.o -lm -o mixed2 && ./mixed2"
    job 'static mode in a C and a C++ file' \
        "gcc -O1 -I'$root' -DGPROJ_STATIC $implement -c other.c -o e.o && g++ -O1 -I'$root' -DGPROJ_STATIC $implement main.cpp e.o -lm -o mixed3 && ./mixed3"
else
    skip 'programs of C and C++: no g++'
fi
run_jobs
for object in "$work"/symbols*.o; do
    [ -f "$object" ] && symbols "${object##*/}" "$object"
done
for object in "$work"/static.*.o; do
    [ -f "$object" ] || continue
    clean "${object##*/}: names exported in static mode" "$(nm "$object" | awk 'NF == 3 && $2 ~ /[A-Z]/')"
    clean "${object##*/}: mutable data in static mode" "$(nm "$object" | awk 'NF == 3 && $2 ~ /^[DdBbCcGgSsVvu]$/')"
done
report
