#!/bin/bash
# check_figures.sh - tools/figures makes its figures: exact, sound, with pictures that have titles; README shows its table.
#
# The program is FIGURES, or tests/build/figures, which the Makefile links with the library.
. "$(dirname "$0")/checks.sh"

figures=${FIGURES:-$PWD/build/figures}
[ -x "$figures" ] || { fail 'no program: make -C tests TEST=figures builds it'; report; }

# run NAME ARGUMENTS: the report of the program; the exit code must be 0.
run() {
    local name=$1
    shift
    "$figures" "$@" >"$work/$name.txt" 2>&1 || { fail "figures $*: exit code $?"; cat "$work/$name.txt"; }
}

run some "$work/pictures" --only 4,7,8,12,inset --meshes
clean 'a figure is not exact and sound' "$(sed 1d "$work/some.txt" | grep -v 'exact and sound$')"
for name in 4a 4b 4c 4d 4e 4f 4g 4h 7a 7b 7c 8a 8b 8c 12 inset; do
    picture=$work/pictures/figure_$name.svg
    [ -s "$picture" ] || { fail "there is no picture of figure $name"; continue; }
    grep -qE '<title>[A-Z][^<]{9,}</title>|font-weight="bold">[A-Z][^<]{9,}</text>' "$picture" && pass || fail "figure $name has no title"
    grep -qE '[" ,](nan|inf)|-nan' "$picture" && fail "figure $name has numbers that are none" || pass
    tail -n 1 "$picture" | grep -q '</svg>' && pass || fail "figure $name has no end"
done
grep -q 'axial forces' "$work/pictures/figure_12.svg" && pass || fail 'figure 12 has no scale of forces'
for name in 4b 4h 7a 8c 12; do
    [ -s "$work/pictures/figure_$name.obj" ] && [ -s "$work/pictures/figure_${name}_before.obj" ] && pass || fail "figure $name has no meshes"
done
rm -r "$work/pictures"

# One part alone; nothing is written without a folder.
run part "$work/pictures" --only 8b
[ "$(ls "$work/pictures")" = figure_8b.svg ] && pass || fail "--only 8b writes $(ls "$work/pictures")"
run json --only 12 --json
grep -qE '"figure": "12", "vertices": 520, .*"exact": true, "spoiled": 0' "$work/json.txt" && pass || fail '--json'
for wrong in '--only 99' '--frobnicate' '--only'; do
    "$figures" $wrong >"$work/wrong.txt" 2>&1
    [ $? -eq 2 ] && pass || fail "figures $wrong: not refused"
done

# Figure 9: sizes and the paper's numbers as README has them; iterations and seconds depend on the machine.
run table --only 9
constant() { awk -F'|' '/^\| [0-9]+[a-z]? \|/ && NF == 9 {print $2, $3, $4, $6, $8}' "$1"; }
clean 'the table of Figure 9 is not the one in README (< figures, > README)' \
    "$(diff <(constant "$work/table.txt") <(constant "$root/README.md"))"
[ "$(constant "$work/table.txt" | wc -l)" -eq 7 ] && pass || fail 'the table of Figure 9 has not seven rows'
report
