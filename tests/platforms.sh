#!/bin/bash
# platforms.sh - the tests as other machines and compilers see them: processors by qemu, Windows by wine, x87, contracted
# arithmetic, levels of optimisation; and states that one machine saves and another goes on with. Before them the header is
# compiled, without a warning, for targets and with options for which check_compile.sh has no time: platform_compile.sh.
#
#     make -C tests platforms        all; NAMES='compile s390x windows': only these
#
# Each platform has a line in the table below: it builds the library and some test programs, and runs them. At the end
# stand the sums of each platform and, alone on a line, of all. What this machine lacks is skipped with a sentence.
. "$(dirname "${BASH_SOURCE[0]}")/checks.sh"

# Real meshes make emulation slow; the tests on this machine have them.
export GPROJ_DATA=/nonexistent LIMIT=1800
# Cases that platforms go without. Emulated: half a minute or more, for speed, memory, threads, or what does not depend on
# processors.
slow='cholesky_large cholesky_panels_and_updates_share_memory cholesky_every_allocation_fails cholesky_orders_agree
    cholesky_not_positive_definite each_byte_forged fairness_at_poles meshes_with_zero_edges_and_faces
    planarity_with_a_pole resumed_to_the_same_bytes resumed_while_it_is_mended restored_without_memory
    same_bits_for_all_workers verdicts_of_random_sets'
# Windows: compares with strtod and printf, whose last digits are wrong in the C library there.
windows='round_trip_random_bits'
# x87: the tests themselves compare doubles with constants, or bits with bits, that have the longer registers' digits; and
# meshes that are rounded otherwise in other units end on other ways where fairness leaves the choice.
x87='default_guidance guard_is_no_wish a_stray_vertex terms_in_common generated_meshes_in_other_units
    at_the_largest_coordinates'

out=$PWD/build/platforms
rm -rf "$out" && mkdir -p "$out"

compiled=
if [ -z "${NAMES:-}" ] || grep -qw compile <<<"$NAMES"; then
    . ./platform_compile.sh
    compiled="$passed passed, $failed failed, $skipped skipped"
fi

usual='mesh text number state cholesky system form' few='mesh number state system drag'
# NAME | COMPILER | OPTIONS | RUNNER, @ stands for the program | PROGRAMS
platforms="
aarch64    | aarch64-linux-gnu-gcc   | -std=c11 -O2 -static                | qemu-aarch64-static @ | $usual
armhf      | arm-linux-gnueabihf-gcc | -std=c11 -O2 -static                | qemu-arm-static @     | $usual
riscv64    | riscv64-linux-gnu-gcc   | -std=c11 -O2 -static                | qemu-riscv64-static @ | $usual
s390x      | s390x-linux-gnu-gcc     | -std=c11 -O2 -static                | qemu-s390x-static @   | $usual
microsoft  | microsoft/cc.sh         | -std=c11 -O2                        | wine @                | mesh text state form
windows    | x86_64-w64-mingw32-gcc  | -std=c11 -O2 -static                | wine @                | $usual
i686-x87   | i686-linux-gnu-gcc      | -std=c11 -O2 -static -mfpmath=387   | @                     | $usual
i686-gnu17 | i686-linux-gnu-gcc      | -std=gnu17 -O2 -static -mfpmath=387 | @                     | $usual
haswell    | gcc                     | -std=gnu17 -O2 -march=haswell       | @                     | $usual
O0         | gcc                     | -std=c11 -O0                        | @                     | $few
O1         | gcc                     | -std=c11 -O1                        | @                     | $few
O3         | gcc                     | -std=c11 -O3                        | @                     | $few limits
Os         | gcc                     | -std=c11 -Os                        | @                     | $few
lto        | gcc                     | -std=c11 -O2 -flto=auto             | @                     | state system
clang-O3   | clang                   | -std=c11 -O3                        | @                     | $few
native     | gcc                     | -std=c11 -O2                        | @                     |
"

# wine64 stands in Debian's /usr/lib/wine; a home of its own, without the windows that it would open.
wine64=$(command -v wine64 || ls /usr/lib/wine/wine64 2>/dev/null)
export WINEPREFIX=$out/wine WINEDEBUG=-all WINEDLLOVERRIDES='mscoree=;mshtml=' DISPLAY=
wineserver=$(command -v wineserver || ls /usr/lib/wine/wineserver 2>/dev/null)

wine() { # wine PROGRAM ARGUMENT...: in this folder; \r\n becomes \n. Now and then wine starts nothing: then again
    local program=$1 try code
    shift
    for try in 1 2 3; do
        "$wine64" "$program.exe" "$@" >"$program.out" 2>&1 </dev/null
        code=$?
        [ $code -ne 0 ] && [ ! -s "$program.out" ] || break
    done
    tr -d '\r' <"$program.out"
    return $code
}

lacks() { # lacks NAME COMPILER RUNNER: why the platform cannot be tried here; nothing: it can
    echo 'int main(void) { return 0; }' >"$work/try.c"
    if ! have "$2"; then
        echo "no $2"
    elif ! "$2" $options "$work/try.c" -o "$work/try" >/dev/null 2>&1; then
        echo "$2 makes no programs"
    elif [ "$3" = wine ]; then
        [ -n "$wine64" ] || echo 'no wine64'
    elif [ "$3" != @ ]; then
        have "$3" || echo "no $3"
    elif ! "$work/try" 2>/dev/null; then
        echo 'this machine does not run its programs'
    elif [ "$1" = haswell ] && ! grep -qw fma /proc/cpuinfo 2>/dev/null; then
        echo 'this processor has no FMA'
    fi
}

# ---- the programs ----

flags='-g0 -Wall -Wextra -Wno-unused-function -pthread'
names=() here=$PWD
while IFS='|' read -r name compiler options runner programs; do
    read -r name <<<"$name" && read -r compiler <<<"$compiler" && read -r runner <<<"$runner"
    [ -n "$name" ] || continue
    [ -z "${NAMES:-}" ] || grep -qw -- "$name" <<<"$NAMES native" || continue
    reason=$(lacks "$name" "$compiler" "${runner%% *}")
    [ -z "$reason" ] || { skip "$name: $reason"; continue; }
    names+=("$name")
    folder=$out/$name
    mkdir "$folder"
    echo "cd '$here' && $compiler $options $flags -c gprojt_inside.c -o '$folder/library.o'" >"$folder/library.build"
    for program in platform_state $([[ $runner != wine* ]] || echo platform_windows) \
        ${programs:+$(printf 'test_%s ' $programs)}; do
        file=$folder/$program.exe
        echo "cd '$here' && $compiler $options $flags $program.c '$folder/library.o' -o '$file' -lm" \
            >"$folder/$program.build"
        run=${runner/@/"'$file'"}
        except=
        case $name-$runner in
        *wine*)
            except=$windows run="cd '$folder' && wine '$program' \"\$@\"" ;;
        *qemu*) except=$slow run="$run \"\$@\"" ;;
        *) run="$run \"\$@\"" ;;
        esac
        [[ $name != i686* ]] || except=$x87
        { declare -f wine && echo "wine64='$wine64' GPROJT_EXCEPT='${except//$'\n'/ }'; export GPROJT_EXCEPT; $run"; } \
            >"$folder/$program.sh"
    done
done <<<"$platforms"
for stage in library '*'; do # the programs are linked with the library
    for name in "${names[@]}"; do
        for build in "$out/$name"/$stage.build; do
            job "$name: $(basename "$build" .build)" "$(cat "$build")"
            rm "$build"
        done
    done
    run_jobs
done

# ---- states: each machine writes some, each goes on with those of this machine, and this one with all ----

[ -z "$wine64" ] || "$wine64" cmd /c exit >/dev/null 2>&1 </dev/null # makes its home
for name in "${names[@]}"; do
    bash "$out/$name/platform_state.sh" write "$out/$name/state" >"$work/write.txt" 2>&1 ||
        fail "$name writes no states: $(head -n 3 "$work/write.txt")"
done
for name in "${names[@]}"; do
    others=$out/native/state
    [ $name != native ] || others=$(printf "$out/%s/state " "${names[@]}")
    # Big-endian and little-endian machines also among themselves.
    [ $name != s390x ] || [ ! -s "$out/aarch64/state" ] || others="$others $out/aarch64/state"
    [ $name != aarch64 ] || [ ! -s "$out/s390x/state" ] || others="$others $out/s390x/state"
    sed -i "1s|.*|set -- read $others\n&|" "$out/$name/platform_state.sh"
done

# ---- all of them; the slowest first ----

tests=()
for program in test_form test_cholesky test_state '*'; do
    for name in "${names[@]}"; do
        for test in "$out/$name"/$program.sh; do
            [[ ! -f $test || " ${tests[*]} " = *" ${test#"$here/"} "* ]] || tests+=("${test#"$here/"}")
        done
    done
done
logs=build/platforms/log bash run.sh -j "${JOBS:-2}" "${tests[@]}" | sed '$d' # its sums come below
[ -z "$wineserver" ] || "$wineserver" -k 2>/dev/null

echo
[ -z "$compiled" ] || printf 'platform %-11s %s\n' compile "$compiled"
for name in "${names[@]}"; do
    p=0 f=0 s=0
    for sum in "$out/log/platforms_${name}_"*.sum; do
        read -r x y z <"$sum"
        p=$((p + x)) f=$((f + y)) s=$((s + z))
    done
    printf 'platform %-11s %4d passed, %d failed, %d skipped\n' "$name" $p $f $s
    passed=$((passed + p)) failed=$((failed + f)) skipped=$((skipped + s))
done
report
