#!/bin/bash
# run.sh [-j JOBS] TEST... - runs tests, JOBS at a time, and adds up their results.
#
# A test is a program or a bash script. It ends its output with a line "N passed, N failed[, N skipped]" and exits with
# 0 iff none failed; one that crashes, hangs or does not exist counts as one failure. TEST@TOOL gives the test another
# command-line tool to try, as GPROJ_TOOL and TOOL in its environment. One line is printed for each test, then the failing
# tests' output in full, what was skipped and why, and at the end the sums, alone on a line.
set -u
cd "$(dirname "$0")" || exit 2
jobs=2
if [ "${1:-}" = -j ]; then jobs=$2; shift 2; fi
export logs=${logs:-build/log}
export ASAN_OPTIONS="${ASAN_OPTIONS:-allocator_may_return_null=1:detect_stack_use_after_return=1}"
export OPENBLAS_NUM_THREADS="${OPENBLAS_NUM_THREADS:-1}" # its threads spin where others compute
export UBSAN_OPTIONS="${UBSAN_OPTIONS:-print_stacktrace=1}"
export LIMIT="${LIMIT:-900}" # seconds for one test
rm -rf "$logs" && mkdir -p "$logs"

run_one() {
    local test=${1%%@*} name=${1//\//_} log code line sums start=$EPOCHREALTIME
    name=${name#build_}
    log=$logs/$name.log
    case $1 in
    *@*) export GPROJ_TOOL=$PWD/${1#*@} TOOL=$PWD/${1#*@} ;;
    esac
    case $1 in
    *.san) export GPROJT_SANITIZED=1 ;; # also of a tool
    esac
    case $test in
    *.sh) timeout -k 5 "$LIMIT" bash "$test" >"$log" 2>&1 </dev/null ;;
    *) timeout -k 5 "$LIMIT" "./$test" >"$log" 2>&1 </dev/null ;;
    esac
    code=$?
    line=$(tail -n 1 "$log")
    if [[ $line =~ ^([0-9]+)\ passed,\ ([0-9]+)\ failed(,\ ([0-9]+)\ skipped)?$ ]]; then
        sums=("${BASH_REMATCH[1]}" "${BASH_REMATCH[2]}" "${BASH_REMATCH[4]:-0}")
        if [ $code -ne 0 ] && [ "${sums[1]}" -eq 0 ]; then
            echo "exit code $code after: $line" >>"$log"
            sums[1]=1
        fi
    else
        echo "no closing line; exit code $code" >>"$log"
        [ $code -eq 124 ] && echo "stopped after $LIMIT seconds" >>"$log"
        sums=(0 1 0)
    fi
    echo "${sums[*]}" >"$logs/$name.sum"
    start=$(((${EPOCHREALTIME/[.,]/} - ${start/[.,]/}) / 100000))
    printf '%-4s %-44s %4d passed %3d failed %3d skipped %4d.%d s\n' "$([ "${sums[1]}" -eq 0 ] && echo ok || echo FAIL)" \
        "$name" "${sums[@]}" $((start / 10)) $((start % 10))
}
export -f run_one

# What drives a browser mostly waits: it runs beside the others, in addition to the JOBS.
others=()
for test in "$@"; do
    case $test in
    test_web.sh*) run_one "$test" & ;;
    *) others+=("$test") ;;
    esac
done
printf '%s\n' "${others[@]}" | xargs -r -P "$jobs" -I{} bash -c 'run_one {}'
wait

passed=0 failed=0 skipped=0
for test in "$@"; do
    name=${test//\//_}
    name=${name#build_}
    p=0 f=1 s=0
    [ -f "$logs/$name.sum" ] && read -r p f s <"$logs/$name.sum"
    passed=$((passed + p)) failed=$((failed + f)) skipped=$((skipped + s))
    if [ "$f" -ne 0 ]; then
        printf '\n---- %s ----\n' "$name"
        sed 's/^/    /' "$logs/$name.log"
    elif [ "$s" -ne 0 ]; then
        grep -i '^skip' "$logs/$name.log" | sed "s/^/$name: /"
    fi
done
echo "$passed passed, $failed failed, $skipped skipped"
[ "$failed" -eq 0 ]
