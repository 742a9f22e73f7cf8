#!/bin/bash
# check_house.sh - the repository's top level is what it should be, and its texts are tidy.
. "$(dirname "$0")/checks.sh"

wanted='LICENSE README.md examples guidedproj.h tests tools'
cd "$root" || exit 2
files=$(git ls-files 2>/dev/null)
[ -n "$files" ] || files=$(find . -type f -not -path '*/build/*' -not -path './.*' -not -path ./tools/guidedproj \
    -not -path ./tools/bench | sed 's|^\./||')
clean "the top level is not $wanted" \
    "$(diff <(tr ' ' '\n' <<<"$wanted") <(cut -d/ -f1 <<<"$files" | grep -v '^\.' | LC_ALL=C sort -u))"
clean 'files that a build makes are in the repository' "$(grep -E '(^|/)build/|\.(o|orig|gcda|gcno)$|^tools/(guidedproj|bench)$' <<<"$files")"
texts=$(grep -E '\.(c|h|sh|py|md)$|(^|/)Makefile$|^\.ci/' <<<"$files" | while read -r f; do [ -f "$f" ] && echo "$f"; done)
clean 'blanks at the end of a line' "$(grep -nE '[[:blank:]]+$' /dev/null $texts)"
clean 'CR at the end of a line' "$(grep -nl $'\r$' /dev/null $texts)"
clean 'tabs in C' "$(grep -n $'\t' /dev/null $(grep -E '\.[ch]$' <<<"$texts"))"
clean 'C lines of more than 130 columns' "$(LC_ALL=C.UTF-8 grep -nE '^.{131,}' /dev/null $(grep -E '\.[ch]$' <<<"$texts"))"
clean 'prose of more than 130 columns' "$(LC_ALL=C.UTF-8 grep -nE '^[^|!].{130,}' /dev/null $(grep -E '\.md$' <<<"$texts"))"
clean 'characters beyond ASCII in the header' "$(LC_ALL=C grep -nP '[^\x00-\x7f]' guidedproj.h)"
clean 'the header does not end with its licence or name it' "$(grep -qiE 'licen[cs]e|public domain' guidedproj.h || echo 'no word of a licence')"
for file in guidedproj.h $(grep -E '\.[ch]$' <<<"$texts"); do
    [ "$(tail -c 1 "$file" | od -An -c | tr -d ' ')" = '\n' ] || fail "$file does not end with a newline"
done
for file in $(grep -E '^tests/test_.*\.c$' <<<"$files"); do
    clean "$file: cases that main does not run" "$(comm -23 <(grep -oP '^GPROJT_TEST\(\K\w+' "$file" | sort -u) \
        <(grep -oP 'GPROJT_RUN\(\K\w+' "$file" | sort -u))"
done
for script in $(grep -E '^(tests/.*\.sh|\.ci/.*)$' <<<"$files"); do
    bash -n "$script" && pass || fail "$script is not valid bash"
done
report
