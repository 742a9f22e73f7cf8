#!/bin/bash
# check_examples.sh - every example in C builds, also alone by the command at its top, runs, prints what tests/expected/NAME.txt
# says, is short, is made again by problem files, and is shown in examples/README.md, as are those in Python (test_python.sh runs
# these).
. "$(dirname "$0")/checks.sh"

ls "$root"/examples/*.c >/dev/null 2>&1 || { fail 'no examples'; report; }
# With a library at -O2, as everybody builds it: numbers that they compute are in problem files with all digits (below). It is
# compiled once for all tests. The commands at the top are only parsed.
library=$(existing build/library.a)
[ -n "$library" ] || library=$root/examples/build/guidedproj.o
${MAKE:-make} --no-print-directory -k -C "$root/examples" LIBRARY="${library#"$root/examples/"}" build >"$work/make.txt" 2>&1 || cat "$work/make.txt"
clean 'the examples compile with warnings' "$(grep -E 'warning:|error:' "$work/make.txt")"
for source in "$root"/examples/*.c; do
    name=$(basename "$source" .c) expected=$root/tests/expected/$(basename "$source" .c).txt
    [ "$(wc -l <"$source")" -lt 120 ] && pass || fail "$name.c has 120 lines or more"
    command=$(sed -nE '1,20s/^   Build and run:   (cc [^&]*) && .*/\1/p' "$source")
    clean "the command at the top of $name.c" "$(cd "$root/examples" && { ${command:-false} -fsyntax-only -Wno-misleading-indentation || echo "fails: $command"; } 2>&1)"
    grep -q '^/\*' <(head -n 1 "$source") && pass || fail "$name.c does not begin with a comment"
    if [ ! -x "$root/examples/build/$name" ]; then
        fail "$name does not build"
    elif ! (cd "$work" && timeout 60 "$root/examples/build/$name" >"$name.txt" 2>&1 </dev/null); then
        fail "$name ends with an error"
        head -n 20 "$work/$name.txt"
    elif [ ! -f "$expected" ]; then
        fail "$name: no tests/expected/$name.txt; it printed:"
        cat "$work/$name.txt"
    else
        clean "$name does not print what is expected (< expected, > printed)" "$(diff "$expected" "$work/$name.txt")"
    fi
done
# Without memory for one block they end, and do not crash.
cat >"$work/shim.c" <<'END'
#include <stdlib.h>
extern void *__libc_malloc(size_t), *__libc_calloc(size_t, size_t), *__libc_realloc(void *, size_t);
static int refused(void) {
    static long left = -1;
    if (left < 0) left = atol(getenv("REFUSE"));
    return left > 0 && --left == 0;
}
void *malloc(size_t size) { return refused() ? NULL : __libc_malloc(size); }
void *calloc(size_t count, size_t size) { return refused() ? NULL : __libc_calloc(count, size); }
void *realloc(void *block, size_t size) { return refused() ? NULL : __libc_realloc(block, size); }
END
if gcc -shared -fPIC -w "$work/shim.c" -o "$work/shim.so" 2>/dev/null &&
    REFUSE=0 LD_PRELOAD=$work/shim.so true 2>/dev/null; then
    mkdir "$work/poor"
    for source in "$root"/examples/*.c; do
        name=$(basename "$source" .c)
        for number in 1 3 8 13 20 25; do
            (cd "$work/poor" && exec timeout 60 env REFUSE=$number LD_PRELOAD="$work/shim.so" "$root/examples/build/$name") \
                >"$work/poor.txt" 2>&1 </dev/null
            [ $? -lt 124 ] && pass || fail "$name without its block number $number: $(tail -n 3 "$work/poor.txt")"
        done
    done
else
    skip 'examples without memory: allocations cannot be refused here'
fi
# Those that say that they are C and C++ compile as C++, too.
for compiler in g++ clang++; do
    have $compiler || { skip "examples in C++: no $compiler"; continue; }
    for source in $(grep -l 'C and C++\.' "$root"/examples/*.c); do
        clean "$(basename "$source") as C++, $compiler" \
            "$($compiler -x c++ -std=c++11 -Wall -Wextra -Werror -DGPROJI_IMPLEMENTED -fsyntax-only "$source" 2>&1)"
    done
done
# examples/roof.obj, the mesh to try, is what planarize writes (but for the last digits of other maths libraries).
clean 'examples/roof.obj is not the roof of planarize.c' "$(paste "$work/roof.obj" "$root/examples/roof.obj" | awk '
    { half = NF / 2; for (k = 1; k <= half; ++k) { d = $k - $(k + half); if ($1 != $(1 + half) || d * d > 1e-20) { print; next } } }')"
# Problem files give the same meshes, step by step as examples/problems/steps.txt says: all that the examples write, but for
# those that it names with a reason. The tool has the examples' library, so that no compiler's option comes between.
differ() { # differ FILE OTHER MOST: a complaint, unless all vertices agree to MOST mean edge lengths, and all else exactly
    paste -d '|' "$1" "$2" | awk -F '|' -v most="$3" '
        { n = split($1, a, " "); m = split($2, b, " "); if (n != m || a[1] != b[1]) { print "line " NR " differs"; exit bad = 1 } }
        a[1] != "v" && $1 != $2 { print "line " NR " differs"; exit bad = 1 }
        a[1] == "v" { for (k = 2; k < 5; ++k) { p[++c] = a[k]; d = a[k] - b[k]; if (d < 0) d = -d; if (d > far) far = d } }
        a[1] == "f" { for (k = 2; k <= n; ++k) { i = 3 * a[k]; j = 3 * a[k < n ? k + 1 : 2]; ++edges
            sum += sqrt((p[i] - p[j])^2 + (p[i - 1] - p[j - 1])^2 + (p[i - 2] - p[j - 2])^2) } }
        END { if (!bad && !(far <= most * sum / edges)) print "vertices differ by up to " far }'
}
steps=$root/examples/problems/steps.txt
mkdir "$work/again"
cp "$work"/*_start.obj "$work"/roof.obj "$work"/volume_blocks.obj "$work"/subdivision_cage.obj "$work/again"
tool=$(existing build/tool)
if [ -z "$tool" ] || [ "$library" != "$(existing build/library.a)" ]; then
    tool=$work/tool
    clean 'the tool' "$(${CC:-cc} -std=c11 -O0 -pthread -DGPROJI_IMPLEMENTED "$root/tools/guidedproj.c" "$library" -o "$tool" -lm 2>&1)"
fi
while read -r name output problem options; do
    [ -f "$root/examples/$name.c" ] && pass || fail "steps.txt: there is no example $name"
    [ "$problem" = - ] && { [ -n "$options" ] && pass || fail "steps.txt: $name $output - needs a reason"; continue; }
    # shellcheck disable=SC2086
    clean "$problem.json $options" "$(cd "$work/again" &&
        "$tool" --problem "$root/examples/problems/$problem.json" $options -o "$output" --quiet 2>&1 || echo "exit code $?")"
done < <(grep -v '^#' "$steps")
for source in "$root"/examples/*.c; do
    name=$(basename "$source" .c)
    grep -q "^$name " "$steps" && pass || fail "$name.c: steps.txt has neither a problem file nor a reason for it"
done
for mesh in "$work"/*.obj; do
    name=$(basename "$mesh")
    grep -qE "^[a-z_]+ $name - ." "$steps" && continue
    [ -f "$work/again/$name" ] || { fail "$name: no problem file of steps.txt makes it"; continue; }
    most=1e-12
    # Numbers in these problem files are results of solves, whose last digits depend on the vector unit: up to 1e-10 after the
    # next solve, between AVX2 and AVX-512.
    case $name in boundary_fill_?.obj | courtyard_c.obj | drag_vertex.obj) most=1e-9 ;; esac
    clean "$name is another mesh than the one of the problem file" "$(differ "$mesh" "$work/again/$name" $most)"
done
for expected in "$root"/tests/expected/*.txt; do
    [ -f "$expected" ] || continue
    [ -f "$root/examples/$(basename "$expected" .txt).c" ] && pass || fail "$expected belongs to no example"
done
# examples/README.md shows every example and picture, and nothing that is not there.
cd "$root/examples" || exit 2
for file in *.c python/*.py blender/*.py pictures/*.svg; do
    grep -qF "]($file)" README.md && pass || fail "examples/README.md does not show $file"
done
for link in $(grep -oE '\]\([^):]+\)' README.md | sed 's/^](//; s/)$//'); do
    [ -e "$link" ] && pass || fail "examples/README.md: there is no $link"
done
report
