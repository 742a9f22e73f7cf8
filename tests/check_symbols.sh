#!/bin/bash
# check_symbols.sh - what the object file shows: names with the prefix only, no mutable data, nothing in static mode;
# the header in several files of one program, of one and of both languages.
. "$(dirname "$0")/checks.sh"

have nm || { skip 'nm: not installed'; report; }
# Not position-independent: constant tables of pointers are then constant data as well, not data to be relocated. The
# optimiser may call other functions of the C library than the source does: gcc's, too, is looked at.
compile="-fno-pic -fno-pie -I'$root'"
for compiler in gcc gcc:-O1 clang g++ clang++ gcc:-DGPROJ_NO_SIMD gcc:-DGPROJ_NO_STDIO; do
    switch=${compiler#"${compiler%%:*}"} switch=${switch#:} compiler=${compiler%%:*}
    label="$compiler $switch" file=$work/whole.c
    have $compiler || { skip "$compiler: not installed"; continue; }
    case $compiler in *++) file=$work/whole.cpp ;; esac
    object=$work/symbols.o
    if ! eval $compiler $compile $switch -c "'$file'" -o "'$object'"; then
        fail "$label does not compile"
        continue
    fi
    symbols=$(nm "$object")
    grep -q ' T gproj_' <<<"$symbols" && pass || fail "$label: no function is exported"
    clean "$label: exported names without the prefix gproj_" \
        "$(awk 'NF == 3 && $2 ~ /[A-Z]/ && $3 !~ /^gproj_/' <<<"$symbols")"
    clean "$label: mutable data" "$(awk 'NF == 3 && $2 ~ /^[DdBbCcGgSsVvu]$/' <<<"$symbols")"
    clean "$label: functions of the C library that this library does without" "$(awk '
        $1 == "U" && $2 ~ /^(setlocale|localeconv|strtod|strtof|strtold|atof|v?f?printf|v?sn?printf|v?f?scanf|puts|putchar|fputs|fputc|exit|_exit|abort|__errno_location|rand|time|clock|getenv|stdout|stderr|stdin)$/' <<<"$symbols")"
    if eval $compiler $compile $switch -DGPROJ_STATIC -c "'$file'" -o "'$object'"; then
        clean "$label: names exported in static mode" "$(nm "$object" | awk 'NF == 3 && $2 ~ /[A-Z]/')"
        clean "$label: mutable data in static mode" "$(nm "$object" | awk 'NF == 3 && $2 ~ /^[DdBbCcGgSsVvu]$/')"
    else
        fail "$label: static mode does not compile"
    fi
done

# Programs of two files.
printf '#include "guidedproj.h"\n#ifdef __cplusplus\nextern "C"\n#endif\nint other(void);\nint main(void) { return other() + !gproj_code_string(GPROJ_OK); }\n' >"$work/main.c"
printf '#include "guidedproj.h"\n#ifdef __cplusplus\nextern "C"\n#endif\nint other(void);\nint other(void) { return !gproj_code_string(GPROJ_OK); }\n' >"$work/other.c"
cp "$work/main.c" "$work/main.cpp"
implement=-DGUIDEDPROJ_IMPLEMENTATION
if have gcc; then
    job 'static mode in two C files' \
        "gcc -I'$root' -DGPROJ_STATIC $implement main.c other.c -lm -o two_static && ./two_static"
    job 'implementation in one C file, use from another' \
        "gcc -I'$root' $implement -c other.c -o a.o && gcc -I'$root' main.c a.o -lm -o two && ./two"
    job 'one file implements and includes twice' \
        "printf '#include \"guidedproj.h\"\n#define GUIDEDPROJ_IMPLEMENTATION\n#include \"guidedproj.h\"\n#include \"guidedproj.h\"\nint main(void) { return 0; }\n' >twice.c && gcc -I'$root' twice.c -lm -o twice && ./twice"
fi
if have gcc && have g++; then
    job 'implementation in C, use from C++' \
        "gcc -I'$root' $implement -c other.c -o b.o && g++ -I'$root' main.cpp b.o -lm -o mixed && ./mixed"
    job 'implementation in C++, use from C' \
        "g++ -I'$root' $implement -c main.cpp -o c.o && gcc -I'$root' -c other.c -o d.o && g++ c.o d.o -lm -o mixed2 && ./mixed2"
    job 'static mode in a C and a C++ file' \
        "gcc -I'$root' -DGPROJ_STATIC $implement -c other.c -o e.o && g++ -I'$root' -DGPROJ_STATIC $implement main.cpp e.o -lm -o mixed3 && ./mixed3"
else
    skip 'programs of C and C++: no g++'
fi
run_jobs
report
