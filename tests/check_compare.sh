#!/bin/bash
# check_compare.sh - tools/compare builds, shows that the methods do what their papers claim, and tells how far each of them
# comes. Times are not checked.
. "$(dirname "$0")/checks.sh"

library= # compiled once for all tests
[ ! -f build/library.a ] || library=$PWD/build/library.a
build() { # build FOLDER OUT: compiles the compare.c of a folder of tools
    ${CC:-cc} -std=c11 -Wall -Wextra -O1 ${library:+-DGPROJI_IMPLEMENTED} "$1/compare.c" $library -o "$2" -lm 2>&1
}
clean 'compare compiles with warnings' "$(build "$root/tools" "$work/compare")"
[ -x "$work/compare" ] || { fail 'compare does not build'; report; }
for file in "$root"/tools/compare_{projection,cubic,shapeup,admm,poranne}.h; do
    [ "$(wc -l <"$file")" -le 150 ] && pass || fail "$file has more than 150 lines"
done

cd "$work" || exit 2
refuses() { # refuses SENTENCE ARGUMENTS...: exit code 2 and a part of the message
    local sentence=$1
    shift
    ./compare "$@" >out.txt 2>err.txt </dev/null
    [ $? = 2 ] && grep -q "$sentence" err.txt && pass || { fail "compare $*: not refused by '$sentence'"; cat err.txt; }
}
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n' >triangle.obj
refuses '^usage' --nonsense
refuses '^usage' --iterations none
refuses '^usage' --iterations 10x
refuses 'no faces with more than 3 sides' --mesh triangle.obj
refuses 'nowhere.obj' --mesh nowhere.obj

./compare --quick pictures >compare.txt 2>&1 </dev/null
code=$?
clean 'compare --quick fails' "$([ $code = 0 ] || { echo "exit code $code"; cat compare.txt; })"
clean 'claims that do not hold' "$(grep FAILS compare.txt)"
for method in 'guided projection' 'guided, cubic' Shape-Up ADMM alternating; do
    grep -q "^  $method .* holds$" compare.txt && pass || fail "no claim of $method is shown"
done
# The tables, planar first. Methods that converge linearly must neither stay where they begin nor be exact: then what is
# measured would not be what they do.
clean 'the tables are not what they should be' "$(awk -F ' *[|] *' '
    BEGIN { exact = 1e-12 }
    /^Planar faces/ { name = "planar" }
    /^Circular faces/ { name = "circular" }
    /^[|] method|^[|]-/ || !/^[|]/ { next }
    {
        ++rows[name]; method = $2; end = $6 + 0; ten = $4 + 0; off = $8 + 0; spoiled = $9
        if (method == "guided projection") first = off
        low = 0; high = exact
        if (method == "Shape-Up") { low = 1e-10; high = 1e-2 }
        if (method == "ADMM") { low = 1e-14; high = 1e-2 }
        if (method == "alternating") high = 1e-8
        if (!(low <= end && end <= high)) print name, method, "ends at", end
        if (method ~ /projection|cubic/ && !(ten <= exact)) print name, method, "is at", ten, "after 10 iterations"
        if (!(0 < off && off < 4 * first) || spoiled != 0) print name, method, "deviation", off, "spoiled", spoiled
        list = list "," $2
    }
    END {
        if (rows["planar"] != 6 || rows["circular"] != 4) print rows["planar"], "and", rows["circular"], "methods:", list
    }' compare.txt 2>&1)"
for kind in planar circular; do
    for name in iterations seconds deviation_iterations deviation_seconds projection nearest shapeup admm; do
        [ -f pictures/${kind}_$name.svg ] || fail "there is no ${kind}_$name.svg"
    done
done
for file in pictures/*.svg; do
    head -c 4 "$file" | grep -q '<svg' && tail -n 1 "$file" | grep -qx '</svg>' && pass || fail "$file is no picture"
done
[ "$(ls pictures | wc -l)" = 18 ] && pass || fail 'compare does not write 18 pictures'

# A method that is not what its paper says is noticed: here the penalty does not grow.
mkdir clone && cp -r "$root/tools" "$root/examples" "$root/guidedproj.h" clone
sed -i '/state->penalty \*= problem->growth/d' clone/tools/compare_poranne.h
if build clone/tools broken >/dev/null; then
    ./broken --quick >broken.txt 2>&1 </dev/null
    [ $? = 1 ] && grep -q '^  alternating .*FAILS' broken.txt && pass || fail 'compare does not notice a broken method'
else
    fail 'the broken method does not build'
fi
report
