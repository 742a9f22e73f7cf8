#!/bin/bash
# check_api.sh - the interface from outside: functions are exported as GPROJ_API says, enumerators need no preprocessor,
# options begin as zeros in C and C++, no restrict, no -ffast-math, and the first program of the manual
# says why it cannot load.
. "$(dirname "$0")/checks.sh"
header=$root/guidedproj.h

# ---- exports: all functions that are declared, and nothing else ----

sed '/^#ifdef GUIDEDPROJ_IMPLEMENTATION/,$d' "$header" | grep -oE '^GPROJ_API.*' | grep -oE '\bgproj_[a-z0-9_]+ *\(' |
    tr -d ' (' | sort >"$work/declared"
[ "$(wc -l <"$work/declared")" -gt 100 ] && pass || fail 'the declarations were not found'
exported() { # exported LABEL COMMAND-THAT-LISTS
    clean "$1: declared (<) and exported (>)" "$(diff "$work/declared" <(sort -u))"
}
visible='-DGPROJ_API=__attribute__((visibility("default")))'
for compiler in gcc clang g++; do
    have $compiler && have nm || { skip "exports: no $compiler or no nm"; continue; }
    file=$work/whole.c
    case $compiler in *++) file=$work/whole.cpp ;; esac
    $compiler -w -O0 -shared -fPIC -fvisibility=hidden "$visible" -I"$root" "$file" -o "$work/library.so" -lm ||
        fail "$compiler: a shared library"
    nm -D --defined-only "$work/library.so" | awk '$2 == "T" { print $3 }' | exported "$compiler -fvisibility=hidden"
done
if have gcc; then
    gcc -w -O1 -shared -fPIC -fvisibility=hidden "$visible" -DGPROJ_STATIC -I"$root" "$work/whole.c" -o "$work/library.so" -lm
    clean 'exports in static mode' "$(nm -D --defined-only "$work/library.so" | grep gproj)"
fi
for compiler in x86_64-w64-mingw32-gcc x86_64-w64-mingw32-g++; do
    have $compiler || { skip "exports: no $compiler"; continue; }
    file=$work/whole.c
    case $compiler in *++) file=$work/whole.cpp ;; esac
    $compiler -w -O0 -shared '-DGPROJ_API=__declspec(dllexport)' -I"$root" "$file" -o "$work/library.dll" ||
        fail "$compiler: a DLL"
    x86_64-w64-mingw32-objdump -p "$work/library.dll" |
        awk '/Ordinal\/Name Pointer/ { on = 1 } on && $NF ~ /^gproj_/ { print $NF }' | exported "$compiler, dllexport"
done

# ---- enumerators: names, numbers, commas and comments ----

cat >"$work/enums.py" <<'END'
import re, sys
text = open(sys.argv[1], encoding="utf-8").read().split("#ifdef GUIDEDPROJ_IMPLEMENTATION")[0]
bodies = re.findall(r"^(?:typedef )?enum[^{;]*\{(.*?)\}", re.sub(r"/\*.*?\*/", "", text, flags=re.S), re.M | re.S)
if len(bodies) < 10: print("the enumerations were not found")
for word in ",".join(bodies).split(","):
    if not re.fullmatch(r"(GPROJ_[A-Z0-9_]+( = -?(0x)?[0-9a-f]+)?)?", word.strip()): print(word.strip())
END
if have python3; then
    clean 'enumerators that only a preprocessor finds' "$(python3 "$work/enums.py" "$header")"
else
    skip 'enumerators: no python3'
fi
clean 'macros that list names' "$(grep -nE '#define GPROJ_[A-Z]+\(X\)' "$header")"

# ---- nothing given: every function with NULL pointers, zeros and structs of zeros ----

cat >"$work/nothing.py" <<'END'
import re, sys
text = open(sys.argv[1], encoding="utf-8").read().split("#ifdef GUIDEDPROJ_IMPLEMENTATION")[0]
text = re.sub(r"/\*.*?\*/", "", text, flags=re.S)
calls = []
for name, inside in re.findall(r"GPROJ_API\s+[\w \*]+?\b(gproj_\w+)\(([^;]*?)\);", text, re.S):
    values, declared, part, depth = [], [], "", 0
    for c in " ".join(inside.split()) + ",":
        depth += (c == "(") - (c == ")")
        if c != "," or depth > 0:
            part += c
            continue
        part = part.strip()
        if part == "void": continue
        if any(mark in part for mark in "*[("):
            values.append("NULL")
        else:
            declared.append(f"static {re.sub(r'[a-z_]+$', '', part).replace('const ', '')} v{len(values)};")
            values.append(f"v{len(values)}")
        part = ""
    calls.append((name, " ".join(declared), ", ".join(values)))
print('#define GUIDEDPROJ_IMPLEMENTATION\n#include "guidedproj.h"\n#include <stdio.h>\n#include <sys/wait.h>')
for name, declared, values in calls: print(f"static void call_{name}(void) {{ {declared} (void){name}({values}); }}")
print("static const struct { const char *name; void (*call)(void); } all[] = {")
for name, _, _ in calls: print(f'{{"{name}", call_{name}}},')
print("""};
int main(void) {
    unsigned i, count = sizeof all / sizeof *all;
    for (i = 0; i < count; ++i) {
        int status = 0;
        if (fork() == 0) {
            all[i].call();
            _exit(0);
        }
        wait(&status);
        if (status) printf("%s crashes\\n", all[i].name);
    }
    if (count < 140) printf("only %u functions were found\\n", count);
}""")
END
library=$(existing build/library.san.a) # compiled once for all tests
if have python3 && have gcc && python3 "$work/nothing.py" "$header" >"$work/nothing.c" &&
    ${CC:-gcc} -w -O1 -g1 -fsanitize=address,undefined -fno-sanitize-recover=all -I"$root" ${library:+-DGPROJI_IMPLEMENTED} "$work/nothing.c" $library -pthread -o "$work/nothing" -lm; then
    clean 'functions that crash where nothing is given' "$("$work/nothing" 2>/dev/null)"
else
    skip 'nothing given: no python3, or no gcc with sanitizers'
fi

# ---- options begin as zeros ----

options=$(sed '/^#ifdef GUIDEDPROJ_IMPLEMENTATION/,$d' "$header" | grep -oE '^\} gproj_([a-z_]*_options|host|loads|supports|handles|mesh_data)' | tr -d '} ')
[ "$(wc -w <<<"$options")" -ge 10 ] && pass || fail 'the options were not found'
{
    echo '#include "guidedproj.h"'
    echo 'int use(const void *any); int begin(void); int begin(void) { int sum = 0;'
    for type in $options; do echo "{ $type it = ZEROS; sum += use(&it); }"; done
    echo 'return sum; }'
} >"$work/zeros.c"
cp "$work/zeros.c" "$work/zeros.cpp"
for compiler in 'gcc -std=c99 -DZEROS={0} zeros.c' 'clang -std=c99 -DZEROS={0} zeros.c' 'g++ -std=c++11 -DZEROS={} zeros.cpp' 'clang++ -std=c++11 -DZEROS={} zeros.cpp'; do
    have "${compiler%% *}" || { skip "zeros: no ${compiler%% *}"; continue; }
    job "zeros: $compiler" "${compiler% *} -Wall -Wextra -Wmissing-field-initializers -Werror -Wpedantic -I'$root' -fsyntax-only ${compiler##* }"
done
grep -q '`= {}` in C++' "$header" && pass || fail 'the manual does not say how options begin in C++'

# ---- compilers ----

have gcc && for option in -ffast-math -Ofast -D_M_FP_FAST; do
    gcc $option -I"$root" -fsyntax-only "$work/whole.c" 2>"$work/fast.txt" && fail "$option compiles" ||
        { grep -q 'error.*compile it without -ffast-math' "$work/fast.txt" && pass || fail "$option: $(head -n 3 "$work/fast.txt")"; }
    job "$option for declarations alone" "gcc $option -I'$root' -fsyntax-only header.c"
done
# Microsoft's compiler has no restrict in its older modes; its headers are not here, so only the preprocessor is tried.
if have clang; then
    mkdir "$work/empty"
    for name in assert fcntl float io limits math process share stdarg stdbool stddef stdint stdio stdlib string time intrin; do
        : >"$work/empty/$name.h"
    done
    mkdir "$work/empty/sys" && : >"$work/empty/sys/stat.h"
    clang --target=x86_64-pc-windows-msvc -U__clang__ -U__GNUC__ -DGPROJ_NO_SIMD -nostdinc -I"$work/empty" -I"$root" -E -P \
        "$work/whole.c" >"$work/microsoft.i" 2>"$work/microsoft.txt" || fail "Microsoft: $(head -n 3 "$work/microsoft.txt")"
    clean 'restrict where Microsoft has none' "$(grep -nwE 'restrict|__restrict__' "$work/microsoft.i")"
fi
clean 'restrict, which C++ does not have' "$(sed 's|/\*.*\*/||' "$header" | grep -nwE 'restrict')"

# ---- the first program ----

if have gcc; then
    sed -n '/^     #define GUIDEDPROJ_IMPLEMENTATION/,/^     }/p' "$header" | sed 's/^     //' >"$work/first.c"
    library=$(existing build/library.a)
    gcc -w -O0 -I"$root" ${library:+-DGPROJI_IMPLEMENTED} "$work/first.c" $library -o "$work/first" -lm && (cd "$work" && ./first >first.txt 2>&1)
    [ $? -eq 1 ] && grep -q "'roof.obj' cannot be opened" "$work/first.txt" && pass || fail "the first program does not say why it cannot load: $(head -n 2 "$work/first.txt")"
fi
run_jobs
report
