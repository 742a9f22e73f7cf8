#!/bin/bash
# test_save_tool.sh - the command line's outputs: all of them are replaced or none, whatever fails and whichever signal
# comes; nothing is left beside them; what cannot be printed is an error; names are printed on one line.
#
#     TOOL=../tools/guidedproj ./test_save_tool.sh

. "$(dirname "$0")/tool.sh"

[ -x "$tool" ] || { echo "there is no tool at $tool: build it first, or set TOOL"; exit 2; }
cd "$work" || exit 2
awk 'BEGIN {
    for (i = 0; i <= 4; i++) for (j = 0; j <= 4; j++) print "v", i, j, 0.3 * sin(i * j)
    for (i = 0; i < 4; i++) for (j = 0; j < 4; j++) print "f", i*5+j+1, (i+1)*5+j+1, (i+1)*5+j+2, i*5+j+2 }' >in.obj
leftovers() { ls gproj-*.tmp ./*.tmp 2>/dev/null | sort -u; }

# ---- each call that makes, flushes, links or renames a file fails once, or brings a signal ----

cat >shim.c <<'END'
/* SHIM="fail N": call N fails; "SIGNAL N": a signal comes at call N. */
#define _GNU_SOURCE
#include <dlfcn.h>
#include <errno.h>
#include <fcntl.h>
#include <signal.h>
#include <stdarg.h>
#include <stdio.h>
#include <stdlib.h>
#include <string.h>
#include <unistd.h>
static int now(void) {
    static int calls;
    const char *plan = getenv("SHIM"), *number = plan ? strchr(plan, ' ') : NULL;
    if (!number || ++calls != atoi(number)) return 0;
    fputs("", fopen("hit", "w"));
    if (!strncmp(plan, "fail", 4)) return errno = EIO, 1;
    kill(getpid(), atoi(plan));
    return 0;
}
#define NEXT(name) ((int (*)())dlsym(RTLD_NEXT, name))
int fsync(int d) { return now() ? -1 : NEXT("fsync")(d); }
int rename(const char *a, const char *b) { return now() ? -1 : NEXT("rename")(a, b); }
int link(const char *a, const char *b) { return now() ? -1 : NEXT("link")(a, b); }
int open(const char *path, int flags, ...) {
    va_list list;
    int mode;
    va_start(list, flags);
    mode = flags & O_CREAT ? va_arg(list, int) : 0;
    va_end(list);
    return (flags & O_CREAT) && now() ? -1 : NEXT("open")(path, flags, mode);
}
END
outcome() { # outcome: "old", "new" or what else the outputs are
    if [ "$(cat out.obj out.json)" = "$(printf 'old\nold')" ] && [ ! -e out.svg ]; then
        echo old
    elif cmp -s out.obj want.obj && tail -n 1 out.json | grep -q '^}' && tail -n 1 out.svg | grep -q '</svg>'; then
        echo new
    else
        echo mixed
    fi
}
"$tool" in.obj -o want.obj --planar --quiet || fail "the tool"
if [ -n "${GPROJT_SANITIZED:-}" ] || [[ $tool = *coverage* ]]; then
    skip "calls that fail (a sanitizer comes first)"
elif ! ${CC:-cc} -w -shared -fPIC shim.c -o shim.so -ldl 2>/dev/null; then
    skip "calls that fail (no shared library can be made)"
else
    for plan in fail 2 15; do
        hits=0
        for number in $(seq 1 99); do
            rm -f out.* hit && echo old >out.obj && echo old >out.json
            {
                (LD_PRELOAD=$PWD/shim.so SHIM="$plan $number" exec "$tool" in.obj -o out.obj --planar --quiet --threads 2 \
                    --report out.json --picture out.svg) 2>err.txt
                status=$?
            } 2>/dev/null
            [ -e hit ] || break
            hits=$number result=$(outcome) left=$(leftovers)
            case $plan-$status-$result in
            fail-3-old | fail-0-new | 2-130-old | 2-130-new | 15-143-old | 15-143-new) pass ;;
            *) fail "$plan at call $number: status $status, outputs $result: $(cat err.txt)" ;;
            esac
            [ -z "$left" ] && pass || fail "$plan at call $number leaves $left"
            rm -f gproj-*
        done
        [ "$hits" -ge 9 ] && [ "$(outcome)" = new ] && pass || fail "$plan: only $hits calls"
    done
fi

# ---- what was there before ----

rm -f out.* && echo old >out.obj && chmod 640 out.obj && ln -s out.obj link.obj
"$tool" in.obj -o link.obj --planar --quiet
[ "$(stat -c %a out.obj)" = 640 ] && [ -L link.obj ] && cmp -s out.obj want.obj && pass || fail "permissions, links"
ln -s nowhere/x.obj dangling.obj
"$tool" in.obj -o dangling.obj --planar --quiet 2>err.txt
[ $? -eq 2 ] && grep -q 'leads nowhere' err.txt && [ -L dangling.obj ] && pass || fail "a link that leads nowhere"
name=$(printf '%0251d' 0).obj
"$tool" in.obj -o "$name" --planar --quiet && cmp -s "$name" want.obj && pass || fail "a long name"
echo old >victim && rm -f out.obj
for ((i = 0; i < 3; ++i)); do # links at all names that the tool may take first
    (for ((k = 0; k < 5; ++k)); do ln -s victim "gproj-$BASHPID-$k.tmp" "out.obj.$BASHPID.tmp"; done 2>/dev/null
        ln -sf victim "out.obj.$BASHPID.tmp"
        exec "$tool" in.obj -o out.obj --planar --quiet)
done
[ "$(cat victim)" = old ] && cmp -s out.obj want.obj && pass || fail "links at temporary names"
rm -f gproj-* out.obj.*

# ---- many at the same time ----

for ((i = 0; i < 30; ++i)); do "$tool" in.obj -o many.obj --planar --quiet --report "many$i.json" & done
wait
cmp -s many.obj want.obj && [ "$(ls many*.json | wc -l)" = 30 ] && [ -z "$(leftovers)" ] && pass || fail "many at the same time"

# ---- what is printed ----

if [ -w /dev/full ]; then
    rm -f out.obj
    "$tool" in.obj -o out.obj --planar >/dev/full 2>err.txt
    [ $? -eq 3 ] && grep -q 'standard output cannot be written: No space' err.txt && cmp -s out.obj want.obj && pass ||
        fail "a full standard output"
    for option in --help --version; do
        "$tool" $option >/dev/full 2>err.txt
        [ $? -eq 3 ] && pass || fail "$option on a full standard output"
    done
    echo old >out.obj
    "$tool" in.obj -o out.obj --planar --quiet --report /dev/full 2>err.txt
    [ $? -eq 3 ] && [ "$(cat out.obj)" = old ] && pass || fail "--report into a full device"
else
    skip "/dev/full"
fi
odd=$(printf 'o\nd\033[31md\302\2331m.obj')
cp in.obj "$odd"
"$tool" "$odd" -o "x$odd" --planar >out.txt 2>err.txt
[ $? -eq 0 ] && [ "$(head -n 1 out.txt | cut -c1-20)" = 'o?d?[31md?1m.obj: 25' ] && pass || fail "an odd name: $(head -n 2 out.txt)"
"$tool" "no$odd" -o out.obj --planar >out.txt 2>err.txt
[ "$(wc -l <err.txt)" = 1 ] && grep -qF 'o?d?[31md?1m.obj' err.txt && pass || fail "an odd name in an error: $(cat err.txt)"
"$tool" in.obj "$odd" -o out.obj 2>err.txt
[ "$(wc -l <err.txt)" = 2 ] && pass || fail "an odd name in a wrong command: $(cat err.txt)"

# ---- inputs without end, or of the wrong kind ----

refused() { # refused STATUS PART ARGUMENTS...
    local want=$1 part=$2 status
    shift 2
    echo old >out.obj
    timeout 60 "$tool" in.obj -o out.obj --planar --quiet "$@" 2>err.txt
    status=$?
    [ $status -eq "$want" ] && grep -qF -- "$part" err.txt && [ "$(cat out.obj)" = old ] && pass ||
        fail "'$*': status $status: $(cat err.txt)"
}
ln -s /dev/zero zero.obj
zero='a zero byte; this is a device'
refused 3 "/dev/zero: $zero" --fix /dev/zero
refused 3 "/dev/zero: $zero" --equilibrium --supports /dev/zero
refused 3 "/dev/full: $zero" --equilibrium --loads /dev/full
refused 3 "zero.obj: line 1: a zero byte" --glide zero.obj
refused 3 "zero.obj: line 1: a zero byte" --reference "$PWD/zero.obj"
refused 2 "--state /dev/full is a device or a pipe" --state /dev/full
mkfifo pipe && refused 2 "--state pipe is a device or a pipe" --state pipe
"$tool" zero.obj -o out.obj --planar 2>err.txt
[ $? -eq 3 ] && grep -q 'zero.obj: line 1: a zero byte' err.txt && pass || fail "a mesh without end: $(cat err.txt)"
endless() { yes "$1" >pipe 2>/dev/null & } # into the pipe that the tool reads
endless 1 && refused 3 'pipe: more than 3 MB, or without end; --file-limit' --fix pipe --file-limit 3
endless 0,0,0,1 && refused 3 'pipe: more than 3 MB' --equilibrium --loads pipe --file-limit 3
endless 'v 0 0 0' && refused 3 'pipe: more than 3 MB' --glide pipe --file-limit 3
head -c 2000000 /dev/zero >big.state
refused 3 'big.state: more than 1 MB' --state big.state --file-limit 1
refused 3 'big.state: ' --state big.state --file-limit 2
grep -q 'more than' err.txt && fail "--file-limit does not raise the limit" || pass
for limit in 0 1.5 -1 x 1000001; do refused 2 'expected a whole number from 1 to' --file-limit=$limit; done
(yes '# a comment' | head -c 2000000; echo; cat in.obj) >long.obj
"$tool" long.obj -o out.obj --planar --quiet --file-limit 1 2>err.txt
[ $? -eq 3 ] && grep -q 'long.obj: more than 1 MB' err.txt && pass || fail "a long mesh: $(cat err.txt)"
"$tool" long.obj -o out.obj --planar --quiet --file-limit 2 && cmp -s out.obj want.obj && pass || fail "--file-limit 2"

echo "$passed passed, $failed failed, $skipped skipped"
[ "$failed" -eq 0 ]
