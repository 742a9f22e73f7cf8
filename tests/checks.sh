# checks.sh - what the check_*.sh scripts have in common; sourced, not run.
#
# Leaves the script in tests/ with $root (the folder of guidedproj.h; GPROJ_ROOT overrides it), $work (a temporary
# folder) and counters. Checks that take long are queued by `job` and run together by `run_jobs`.
set -u
cd "$(dirname "${BASH_SOURCE[0]}")" || exit 2
root=$(cd "${GPROJ_ROOT:-..}" && pwd)
work=$(mktemp -d)
trap 'rm -rf "$work"' EXIT
passed=0 failed=0 skipped=0 queued=0

have() { command -v "$1" >/dev/null 2>&1; }
pass() { passed=$((passed + 1)); }
fail() { failed=$((failed + 1)); printf 'FAIL %s\n' "$*"; }
skip() { skipped=$((skipped + 1)); printf 'skip %s\n' "$*"; }

# existing FILE: its absolute path if it is there, else nothing (realpath -q also answers for files that are missing).
existing() { [ ! -e "$1" ] || realpath "$1"; }

# clean LABEL TEXT: passes when the text, a list of complaints, is empty.
clean() {
    if [ -z "$2" ]; then pass; else fail "$1"; printf '%s\n' "$2" | head -n 20 | sed 's/^/  /'; fi
}

# job LABEL COMMAND: queues a shell command that must succeed and write nothing.
job() {
    queued=$((queued + 1))
    printf '%s\n' "$1" >"$work/$queued.label"
    printf '%s\n' "$2" >"$work/$queued.job"
}
run_jobs() {
    local i text
    local -A seen=()
    seq "$queued" | xargs -r -P "${JOBS:-2}" -I{} bash -c \
        'cd "$0"; bash {}.job >{}.out 2>&1 </dev/null || echo "exit code $?" >>{}.out' "$work"
    for ((i = 1; i <= queued; ++i)); do
        text=$(cat "$work/$i.out" 2>&1)
        if [ -n "$text" ] && [ -n "${seen[$text]:-}" ]; then
            fail "$(cat "$work/$i.label"): as ${seen[$text]}"
        else
            clean "$(cat "$work/$i.label")" "$text"
            [ -z "$text" ] || seen[$text]=$(cat "$work/$i.label")
        fi
    done
    queued=0
}

# symbols LABEL OBJECT: the library's object exports names with the prefix only, holds no mutable data, and calls no function
# of the C library that it does without.
symbols() {
    local list
    list=$(nm "$2" 2>&1)
    grep -q ' T gproj_' <<<"$list" && pass || fail "$1: no function is exported"
    clean "$1: exported names without the prefix gproj_" "$(awk 'NF == 3 && $2 ~ /[A-Z]/ && $3 !~ /^gproj_/' <<<"$list")"
    clean "$1: mutable data" "$(awk 'NF == 3 && $2 ~ /^[DdBbCcGgSsVvu]$/' <<<"$list")"
    clean "$1: functions of the C library that this library does without" "$(awk '
        $1 == "U" && $2 ~ /^(setlocale|localeconv|strtod|strtof|strtold|atof|v?f?printf|v?sn?printf|v?f?scanf|puts|putchar|fputs|fputc|exit|_exit|abort|__errno_location|rand|time|getenv|stdout|stderr|stdin)$/' <<<"$list")"
}
# Constant tables of pointers are constant data only if the code is not position-independent, else data to be relocated.
fixed='-fno-pic -fno-pie'

# The header and what a compiler needs to find it.
printf '#include "guidedproj.h"\n' >"$work/header.c"
printf '#define GUIDEDPROJ_IMPLEMENTATION\n#include "guidedproj.h"\n' >"$work/whole.c"
cp "$work/header.c" "$work/header.cpp"
cp "$work/whole.c" "$work/whole.cpp"
# A Python with numpy, which may be another one than the first on the path; empty: none.
python_with_numpy() {
    local one
    for one in python3 /usr/bin/python3; do
        $one -c 'import numpy' >/dev/null 2>&1 && echo "$one" && return
    done
}
have_cblas() { echo '#include <cblas.h>' | gcc -E -x c - >/dev/null 2>&1; }

report() {
    printf '%d passed, %d failed, %d skipped\n' "$passed" "$failed" "$skipped"
    exit $((failed > 0))
}
