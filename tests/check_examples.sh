#!/bin/bash
# check_examples.sh - every example in C builds, also alone by the command at its top, runs, prints what tests/expected/NAME.txt
# says, is short, and is shown in examples/README.md, as are those in Python (test_python.sh runs these).
. "$(dirname "$0")/checks.sh"

ls "$root"/examples/*.c >/dev/null 2>&1 || { fail 'no examples'; report; }
# -O1, for speed; the commands at the top are only parsed
${MAKE:-make} --no-print-directory -k -C "$root/examples" CFLAGS=-O1 build >"$work/make.txt" 2>&1 || cat "$work/make.txt"
clean 'the examples compile with warnings' "$(grep -E 'warning:|error:' "$work/make.txt")"
for source in "$root"/examples/*.c; do
    name=$(basename "$source" .c) expected=$root/tests/expected/$(basename "$source" .c).txt
    [ "$(wc -l <"$source")" -lt 120 ] && pass || fail "$name.c has 120 lines or more"
    command=$(sed -nE '1,20s/^   Build and run:   (cc [^&]*) && .*/\1/p' "$source")
    clean "the command at the top of $name.c" "$(cd "$root/examples" && { ${command:-false} -fsyntax-only || echo "fails: $command"; } 2>&1)"
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
