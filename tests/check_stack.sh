#!/bin/bash
# check_stack.sh - no function takes more than 32 KB of stack, and none a size known only at run time.
. "$(dirname "$0")/checks.sh"

limit=32768
for options in -O0 -O2 '-O3 -mavx2 -mfma'; do
    case "$options $(uname -m)" in *-mavx*x86_64) ;; *-mavx*) continue ;; esac
    if have gcc; then
        if ! gcc $options -fstack-usage -I"$root" -c "$work/whole.c" -o "$work/stack.o"; then
            fail "gcc $options does not compile"
            continue
        fi
        su=$(ls "$work"/stack*.su "$work"/whole*.su 2>/dev/null | head -n 1)
        clean "gcc $options: functions with more than $limit bytes of stack" \
            "$(awk -F '\t' -v limit=$limit '$2 + 0 > limit || $3 == "dynamic"' "$su")"
        [ -s "$su" ] && echo "gcc $options: largest frame $(sort -t "$(printf '\t')" -k2,2nr "$su" | awk -F '\t' '{ sub(/.*:/, "", $1); print $1 ", " $2 " bytes"; exit }')"
        rm -f "$work"/*.su
    fi
    have clang && clean "clang $options: functions with more than $limit bytes of stack" \
        "$(clang $options -Wframe-larger-than=$limit -I"$root" -c "$work/whole.c" -o "$work/stack.o" 2>&1)"
done
report
