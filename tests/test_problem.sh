#!/bin/bash
# test_problem.sh - problem files: what --write-problem writes gives the same bytes of the mesh, sections do what they say,
# and wrong files are refused with their line and key.
#
#     TOOL=../tools/guidedproj ./test_problem.sh

. "$(dirname "$0")/tool.sh"
[ -x "$tool" ] || { echo "there is no tool at $tool: build it first, or set TOOL"; exit 2; }
cd "$work" || exit 2
for python in python3 /usr/bin/python3 ''; do # one with numpy
    [ -z "$python" ] || ! $python -c 'import numpy' >/dev/null 2>&1 || break
done

# ---- meshes: a wavy roof of 6 x 6 quads, a cage, curves ----

awk 'BEGIN {
    for (i = 0; i < 7; i++) for (j = 0; j < 7; j++)
        printf "v %d %d %.17g\n", i, j, 0.5 * (sin(0.5 * i) + 0.8 * cos(0.4 * j) + 0.03 * sin(1.3 * i * j))
    for (i = 0; i < 6; i++) for (j = 0; j < 6; j++) print "f", i*7+j+1, i*7+j+8, i*7+j+9, i*7+j+2 }' >roof.obj
printf 'v 0 0 0\nv 2 0 1\nv 4 0 0\nv 0 2 1\nv 2 2 2\nv 4 2 1\nv 0 4 0\nv 2 4 1\nv 4 4 0\nf 1 2 5 4\nf 2 3 6 5\nf 4 5 8 7\nf 5 6 9 8\n' >cage.obj
printf 'v 0 0 0\nv 6 0 0\nv 6 5 0\nv 0 5 0\nl 1 2 3 4 1\n' >curve.obj
printf '0 48\n' >list.txt
printf '24,0,0,-1\n' >loads.csv

# ---- round trips ----

round() { # round ARGUMENTS...: a problem file of these gives the same mesh, and the same problem file
    rm -f first.obj again.obj first.json again.json
    "$tool" "$@" -o first.obj --quiet --write-problem first.json >out.txt 2>&1
    local status=$?
    [ "$status" -le 1 ] || { fail "'$*' exits with $status: $(cat out.txt)"; return; }
    "$tool" --problem first.json -o again.obj --write-problem again.json >out.txt 2>&1
    if [ $? -ne $status ] || ! cmp -s first.obj again.obj; then
        fail "'$*' as a problem is another: $(cat out.txt)"
    elif ! diff <(grep -v '"output"' first.json) <(grep -v '"output"' again.json) >out.txt; then
        fail "'$*' is written in another way after it was read: $(cat out.txt)"
    else
        pass
    fi
}
round roof.obj --planar
round roof.obj --planar=2 --fix corners --fix 24,25=0.5 --fairness '0.2*0.9:6'
round roof.obj --planar --glide boundary --reference roof.obj=0.05 --tangential 0.1
round roof.obj --planar --fix list.txt --move 24,3,3,2 --move 10,1,3,0.5
round roof.obj --equilibrium --compressive --fix boundary --density 1 --snow 0.5 --loads loads.csv --force-fairness
round roof.obj --equilibrium --stress 0,9 --fix corners --supports corners --area-load 1
round roof.obj --planar --circular --closeness 0 --iterations 30
round cage.obj --subdivide 2 --planar --parallelograms
round --fill curve.obj --sides 4,4,6,6 --lift 1 --fairness 0.1
round roof.obj --nearest --planar --conical --fix corners --epsilon 1e-4 --tolerance 1e-10
round roof.obj --volume x1.1 --edge-length 0.5,2 --fix boundary --total-area x1.02
round roof.obj --planar --plain --fix corners --fairness '0.1*0.9' --reference input=0.05 --iterations 12
round roof.obj --equilibrium --compressive --fix boundary --start-forces 2
round roof.obj --planar-boundary --straight-boundary --equal-areas --gauss 0.1 --planar --title 'a "name" \ é' --picture p.svg

# ---- sections ----

cat >all.json <<'END'
{
  "input": "roof.obj",
  "equilibrium": true, "compressive": 1, "stress": "0,50", "supports": "0,6", "fairness": "0.1*0.9:8",
  "fix": [0, "6"],
  "curves": [
    {"vertices": [1, 3, 5], "points": [[0, 0, 0.4], [0, 6, 0.4]]},
    {"vertices": "43-45", "file": "curve.obj", "polyline": 0, "weight": 0.5}
  ],
  "coplanar": [{"vertices": "7,14,21,28,35"}],
  "collinear": [{"vertices": [22, 23, 24, 25, 26]}],
  "lengths": [{"edges": [[8, 9, 10], [15, 16]], "length": 1.1}, {"edges": [[30, 31]]}],
  "rollers": [{"vertices": "42,48", "free": "xy"}],
  "sections": [{"edges": "boundary", "section": 2.5}],
  "densities": [{"edges": "all", "density": 1}, {"edges": [[0, 1]], "density": 2}],
  "weights": [{"of": "fairness", "vertices": "0-10", "weight": 0}]
}
END
round --problem all.json
holds() { # holds NAME PROGRAM: awk, over the vertices x[0], y[0], z[0], ... of all.obj
    if awk '$1 == "v" { x[n] = $2; y[n] = $3; z[n++] = $4 } function abs(a) { return a < 0 ? -a : a }
        function apart(i, j) { return sqrt((x[i] - x[j])^2 + (y[i] - y[j])^2 + (z[i] - z[j])^2) }
        END { exit !('"$2"') }' all.obj; then pass; else fail "$1 does not hold"; fi
}
grep -vE '"(sections|densities)"' all.json | sed 's/.*"equilibrium".*/  "fairness": "0.1*0.9:8",/' >shape.json
"$tool" --problem shape.json -o all.obj --quiet --residuals residuals.csv --allow-spoiled >out.txt 2>&1 ||
    fail "shape.json: $(cat out.txt)"
awk '$1 == "v" { print $4 }' roof.obj >heights.txt
holds 'a chosen curve' 'abs(x[1]) < 1e-9 && abs(x[5]) < 1e-9 && abs(z[3] - 0.4) < 1e-9'
holds 'a length' 'abs(apart(8, 9) - 1.1) < 1e-9 && abs(apart(9, 10) - 1.1) < 1e-9 && abs(apart(15, 16) - 1.1) < 1e-9'
holds 'a roller' "abs(z[42] - $(sed -n 43p heights.txt)) < 1e-9 && abs(z[48] - $(sed -n 49p heights.txt)) < 1e-9"
holds 'a line' 'abs(apart(22, 26) - apart(22, 23) - apart(23, 24) - apart(24, 25) - apart(25, 26)) < 1e-9'
awk -F, 'NR == 1 { exit $0 != "group,place,element,residual" }' residuals.csv && awk -F, 'NR > 1 && !($2 ~ /^(vertex|edge|face)$/ &&
    $4 > 0 && $4 < 1e-9) && $1 !~ /fair|close/ { exit 1 }' residuals.csv && pass || fail 'residuals.csv'
cat >statics.json <<'END'
{
  "input": "roof.obj", "equilibrium": true, "compressive": true, "stress": "0,4", "fix": "7,14,21,28,35,13,20,27,34,41,1-5,43-47",
  "rollers": [{"vertices": "0,6,42,48", "free": "xy"}], "sections": [{"edges": "all", "section": 2}, {"edges": [[24, 25]], "section": 0.25}],
  "densities": [{"edges": "all", "density": 1}, {"edges": "boundary", "density": 2}]
}
END
"$tool" --problem statics.json -o statics.obj --quiet --forces forces.csv --allow-spoiled >out.txt 2>&1 ||
    fail "statics.json: $(cat out.txt)"
grep -q '^support,42,0,' forces.csv && ! grep '^support,' forces.csv | grep -qv '^support,[0-9]*,[^,]*,[^,]*,[^,]*$' && pass || fail 'a roller is no support'
awk -F, -v of=statics.obj 'BEGIN { while ((getline line <of) > 0) if (split(line, a, " ") == 4 && a[1] == "v") { for (k = 0; k < 3; k++)
        p[n, k] = a[k + 2]; n++ } }
    $1 == "edge" { l = 0; for (k = 0; k < 3; k++) l += (p[$2, k] - p[$3, k])^2; force = $4 * sqrt(l)
        if (force < -1e-9 || force > 8 + 1e-9 || ($2 + $3 == 49 && ($2 - $3)^2 == 1 && force > 1 + 1e-9)) exit 1 }
    $1 == "load" { load -= $5 }
    END { if (!(load > 100 && load < 150)) exit 1 }' forces.csv && pass || fail 'stresses of sections, or weights of edges'
# An equilibrium that starts from the forces at its end stays as it is.
"$tool" statics.obj --problem statics.json -o more.obj --start-forces forces.csv --closeness 1 >out.txt 2>&1 &&
    grep -q '^displacement  .*e-' out.txt && pass || fail "--start-forces: $(cat out.txt)"
sed 's/^edge,0,/edge,48,/' forces.csv >wrong.csv
"$tool" --problem statics.json -o more.obj --start-forces wrong.csv >out.txt 2>&1
[ $? -eq 3 ] && grep -q 'wrong.csv:2: there is no edge' out.txt && pass || fail "wrong forces: $(cat out.txt)"
# Handles of a cage: the cage with the handle moved in the file gives the same.
printf '{"input": "cage.obj", "subdivide": 2, "fairness": 0.1, "handles": [{"vertex": 4, "by": [0, 0, 1.5]}]}' >handle.json
sed 's/^v 2 2 2$/v 2 2 3.5/' cage.obj >pulled.obj
"$tool" --problem handle.json -o one.obj --quiet && "$tool" pulled.obj --subdivide 2 --fairness 0.1 -o two.obj --quiet &&
    cmp -s one.obj two.obj && pass || fail 'a handle is not like the cage with this vertex moved'
# Handles of a cage whose mesh has been shaped since: they move it by the subdivision's weights.
"$tool" cage.obj --subdivide 2 --fix 0 --closeness 0 -o fine.obj --quiet
cat >caged.json <<'END'
{
  "input": "fine.obj", "cage": "cage.obj", "subdivide": 2, "fix": 0, "closeness": 0,
  "handles": [{"vertex": 4, "by": [0, 0, 1.5]}, {"vertex": 10, "by": [0.5, 0, 0.25], "level": 1}, {"vertex": 80, "by": [0, 1, 0], "level": 2}]
}
END
sed 's/"fine.obj", "cage": //' caged.json >before.json
near() { # near FILE OTHER MOST: all vertices agree to MOST
    paste "$1" "$2" | awk -v most="$3" '$1 == "v" { for (k = 2; k < 5; k++) if (($k - $(k + 4))^2 > most^2) far = 1; n++ } END { exit far || !n }'
}
round --problem caged.json
"$tool" --problem caged.json -o one.obj --quiet && "$tool" --problem before.json -o two.obj --quiet && near one.obj two.obj 1e-13 &&
    ! near one.obj fine.obj 0.01 && pass || fail 'handles of --cage move the mesh in another way than before the subdivision'
"$tool" roof.obj -o one.obj --planar --reference input=0.2 --quiet && "$tool" roof.obj -o two.obj --planar --reference roof.obj=0.2 --quiet &&
    cmp -s one.obj two.obj && pass || fail '--reference input'
sed 's/^\(edge,.*\),.*/\1,3/' forces.csv >threes.csv
"$tool" --problem statics.json -o one.obj --quiet --allow-spoiled --start-forces 3 && "$tool" --problem statics.json -o two.obj --quiet \
    --allow-spoiled --start-forces threes.csv && cmp -s one.obj two.obj && pass || fail '--start-forces 3'

# ---- rows ----

cat >rows.json <<'END'
{
  "input": "roof.obj", "fairness": 0.05,
  "rows": [
    {"vertices": "0-20", "unknowns": [2, 9], "weight": 0.5,
      "terms": [[0.05, "x", "x"], [0.05, "y", "y"], [0.05, "z", "z"], [-0.1, "z", "u0"], [-0.05, "u1", "u1"], [0.05, "u0", "u0"]]},
    {"terms": [[1, "z40"], [-1, "z41"]], "constant": -0.25},
    {"vertices": [30, 31, 37, 38], "terms": [[1, "z"]], "constant": -0.6, "kind": "bound"},
    {"vertices": [48], "terms": [[1, "x"]], "constant": -7, "kind": "wish"}
  ]
}
END
round --problem rows.json
"$tool" --problem rows.json -o all.obj --quiet >out.txt 2>&1 || fail "rows.json: $(cat out.txt)"
holds 'a row of two vertices' 'abs(z[40] - z[41] - 0.25) < 1e-10'
holds 'bounds of rows' 'z[30] > 0.6 - 1e-10 && z[31] > 0.6 - 1e-10 && z[37] > 0.6 - 1e-10 && z[38] > 0.6 - 1e-10'
# A sphere about (0, 0, u0) with the radius u1; u0 by the vertices 0 and 20.
cat >sphere.awk <<'END'
BEGIN { n = 0 }
$1 == "v" { x[n] = $2; y[n] = $3; z[n++] = $4 }
END {
    u = (x[20]^2 + y[20]^2 + z[20]^2 - x[0]^2 - y[0]^2 - z[0]^2) / 2 / (z[20] - z[0])
    for (i = 0; i < 21; i++) { r = sqrt(x[i]^2 + y[i]^2 + (z[i] - u)^2); if (i == 0) first = r; if ((r - first)^2 > 1e-16) exit 1 }
}
END
awk -f sphere.awk all.obj && ! awk -f sphere.awk roof.obj && pass || fail 'rows with unknowns do not hold'

printf '{"input": "roof.obj", "planar": true, "fix": "corners", "nearest": true, "closeness": 0, "rows": [{"vertices": [24], "terms": [[1, "z"]],
    "constant": -2, "kind": "wish"}]}' >wish.json
"$tool" --problem wish.json -o all.obj --quiet >out.txt 2>&1
[ $? -le 1 ] && pass || fail "a wish of rows is not one: $(cat out.txt)"
holds 'a wish of rows' 'abs(z[24] - 2) < 0.01'

# ---- pulls ----

cat >pulls.json <<'END'
{
  "input": "cage.obj", "subdivide": 2, "planar": true, "fix": "corners",
  "pulls": [
    {"vertex": 4, "by": [0, 0, 0.5]},
    {"vertex": 10, "by": [0.1, 0, 0.2], "level": 1},
    {"vertex": 30, "by": [0, 0.05, -0.1], "level": 2}
  ]
}
END
round --problem pulls.json
"$tool" --problem pulls.json -o pulled.obj --quiet >out.txt 2>&1 || fail "pulls.json: $(cat out.txt)"
if [ -n "$python" ]; then
    off=$(PYTHONPATH=$here/../examples/python PYTHONDONTWRITEBYTECODE=1 GUIDEDPROJ_CACHE=$here/build/python $python "$here/problem_pulls.py" \
        cage.obj pulled.obj 2>out.txt)
    awk -v off="$off" 'BEGIN { exit !(off ~ /^[0-9.e+-]+$/ && off + 0 <= 1e-7) }' && pass ||
        fail "pulls are not those of the library called directly: off by '$off' $(cat out.txt)"
else
    skip 'pulls by the library called directly (no python3 with numpy)'
fi

# The command line takes the place of keys.
printf '{"input": "none.obj", "planar": 3, "output": "none/none.obj", "fix": ["0", "7"]}' >over.json
"$tool" --problem over.json roof.obj -o over.obj --planar --fix corners --quiet && "$tool" roof.obj -o under.obj --planar \
    --fix corners --quiet && cmp -s over.obj under.obj && pass || fail 'the command line does not take the place of keys'

# ---- refusals ----

refuse() { # refuse LINE PART PROBLEM...: exit status 3, FILE:LINE: and a part of the sentence, for the text of PROBLEM
    local line=$1 part=$2
    printf '%b' "$3" >bad.json
    rm -f bad.obj
    "$tool" --problem bad.json -o bad.obj >out.txt 2>err.txt
    local status=$?
    if [ $status -ne 3 ]; then
        fail "$3 exits with $status: $(cat err.txt)"
    elif ! grep -qF -- "bad.json:$line: " err.txt || ! grep -qF -- "$part" err.txt; then
        fail "$3 is not refused with line $line and '$part': $(cat err.txt)"
    elif [ -e bad.obj ] || [ "$(grep -c . err.txt)" -ne 1 ]; then
        fail "$3 writes a mesh or more than a sentence"
    else
        pass
    fi
}
P='{"input": "roof.obj",\n"planar": true,\n'
refuse 3 'there is no key "plannar"; did you mean "planar"?' '{"input": "roof.obj",\n\n"plannar": true}'
refuse 3 '"planar": the key stands twice' "$P\"planar\": 2}"
refuse 3 '"iterations": expected a string or number' "${P}\"iterations\": true}"
refuse 3 '"midsphere": expected true, or a string or number W' "${P}\"midsphere\": false}"
refuse 3 "the picture 'x.png' must end in .svg" "${P}\"picture\": \"x.png\"}"
refuse 3 '--report writes to a file' "${P}\"report\": \"-\"}"
refuse 3 '--encoding is for outputs' "${P}\"encoding\": \"ascii\"}"
refuse 1 '--conical needs the normals' '{"conical": true, "input": "roof.obj"}'
refuse 2 '--circular is for planar faces' '{"input": "roof.obj",\n"circular": true}'
refuse 3 '--nearest has nothing to be near to' "${P}\"nearest\": true, \"closeness\": 0}"
refuse 1 '--weld is for an input' '{"fill": "curve.obj", "weld": true}'
refuse 3 '--iterations 0: expected' "${P}\"iterations\": 0}"
refuse 4 '--fix: there is no vertex 49' "${P}\"fix\": [\"0-3\",\n\"49\"]}"
refuse 3 '"fix": expected' "${P}\"fix\": [[1]]}"
refuse 3 '--move: there is no vertex 70' "${P}\"move\": \"70,0,0,0\"}"
refuse 3 '--compressive is about forces' "${P}\"compressive\": true}"
refuse 3 'there is no key "help"' "${P}\"help\": true}"
refuse 3 '"coplanar": expected an array of objects' "${P}\"coplanar\": {}}"
refuse 3 '"coplanar": "vertices" is missing' "${P}\"coplanar\": [{}]}"
refuse 4 '"coplanar": there is no key "edges" here' "${P}\"coplanar\": [{\"vertices\": \"0-5\",\n\"edges\": \"all\"}]}"
refuse 4 '"coplanar": there is no vertex 49' "${P}\"coplanar\": [{\"vertices\": [0, 1,\n 49, 3]}]}"
refuse 3 '"coplanar": "vertices" names none of this mesh' "${P}\"coplanar\": [{\"vertices\": \",\"}]}"
refuse 3 '"coplanar": "vertices": there is no vertex 99' "${P}\"coplanar\": [{\"vertices\": \"0-99\"}]}"
refuse 3 '"collinear": "vertices": expected' "${P}\"collinear\": [{\"vertices\": [0, -1]}]}"
refuse 3 '"collinear": "weight": expected' "${P}\"collinear\": [{\"vertices\": [0, 1], \"weight\": -1}]}"
refuse 3 '"lengths": there is no edge between the vertices 0 and 2' "${P}\"lengths\": [{\"edges\": [[0, 2]]}]}"
refuse 3 '"lengths": there is no vertex 49' "${P}\"lengths\": [{\"edges\": [[0, 1, 49]]}]}"
refuse 3 '"lengths": "edges": expected' "${P}\"lengths\": [{\"edges\": [[0]]}]}"
refuse 3 '"lengths": "length": expected a number above 0' "${P}\"lengths\": [{\"edges\": \"all\", \"length\": 0}]}"
refuse 3 '"curves": expected either' "${P}\"curves\": [{\"vertices\": [0]}]}"
refuse 3 '"curves": "points": expected' "${P}\"curves\": [{\"vertices\": [0], \"points\": [[0, 0], [1, 1]]}]}"
refuse 3 '"curves": curve.obj has 1 curves' "${P}\"curves\": [{\"vertices\": [0], \"file\": \"curve.obj\", \"polyline\": 1}]}"
refuse 3 '"rollers": "free": expected' "${P}\"rollers\": [{\"vertices\": [0], \"free\": \"w\"}]}"
refuse 3 '"sections" needs the key "stress"' "${P}\"sections\": [{\"edges\": \"all\", \"section\": 1}]}"
refuse 3 '"handles" needs the key "subdivide"' "${P}\"handles\": [{\"vertex\": 1, \"by\": [0, 0, 1]}]}"
refuse 4 '"handles": there is no level 3' "${P}\"subdivide\": 2,\n\"handles\": [{\"vertex\": 1, \"by\": [0, 0, 1], \"level\": 3}]}"
refuse 3 '"handles": there is no vertex 49 on level 0' "${P}\"handles\": [{\"vertex\": 49, \"by\": [0, 0, 1]}], \"subdivide\": 1}"
refuse 3 '"pulls": there is no vertex 49 on level 0; it has 49' "${P}\"pulls\": [{\"vertex\": 49, \"by\": [0, 0, 1]}]}"
refuse 4 '"pulls": there is no level 1; the last is 0' "${P}\"pulls\": [{\"vertex\": 1, \"by\": [0, 0, 1]},\n{\"vertex\": 1, \"by\": [0, 0, 1], \"level\": 1}]}"
refuse 4 'coordinate z of handle 0 is 1e+99' "${P}\"quiet\": true, \"pulls\": [\n{\"vertex\": 1, \"by\": [0, 0, 1e99]}]}"
refuse 3 '"pulls": "by" is missing' "${P}\"pulls\": [{\"vertex\": 1}]}"
refuse 3 '"pulls" come after the solve that --state keeps' "${P}\"pulls\": [], \"state\": \"s.bin\"}"
refuse 3 '--cage is subdivided to the input: add --subdivide' "${P}\"cage\": \"cage.obj\"}"
refuse 3 '"plain": expected true' "${P}\"plain\": 1}"
refuse 3 '"rows": "terms" is missing' "${P}\"rows\": [{\"vertices\": [0]}]}"
refuse 3 '"rows": "terms": expected' "${P}\"rows\": [{\"terms\": [[1]]}]}"
refuse 3 '"rows": "terms": expected' "${P}\"rows\": [{\"terms\": [[\"x1\", 1]]}]}"
refuse 3 '"rows": "terms": expected' "${P}\"rows\": [{\"terms\": []}]}"
refuse 3 '"rows": "kind": expected constraint, wish or bound' "${P}\"rows\": [{\"terms\": [[1, \"x1\"]], \"kind\": \"must\"}]}"
refuse 3 '"rows": "unknowns": expected' "${P}\"rows\": [{\"terms\": [[1, \"x1\"]], \"unknowns\": [\"a\"]}]}"
refuse 4 '"rows": there is no "x49"' "${P}\"rows\": [{\"terms\": [[1, \"x4\"],\n[1, \"x49\"]]}]}"
refuse 3 'the start value of unknown' "${P}\"rows\": [{\"terms\": [[1, \"u0\"]], \"unknowns\": [1e99]}]}"
refuse 3 '"rows": there is no "x"; expected' "${P}\"rows\": [{\"terms\": [[1, \"x\"]]}]}"
refuse 3 '"rows": there is no "u1"' "${P}\"rows\": [{\"terms\": [[1, \"x1\"], [1, \"u1\"]], \"unknowns\": [1]}]}"
refuse 3 '"rows": there is no "w1"' "${P}\"rows\": [{\"terms\": [[1, \"x1\", \"w1\"]]}]}"
refuse 3 '"rows": there is no "u"' "${P}\"rows\": [{\"terms\": [[1, \"u\"]], \"unknowns\": [1]}]}"
refuse 4 'missing.obj: No such file' "${P}\"curves\": [\n{\"vertices\": [0], \"file\": \"missing.obj\"}]}"
refuse 3 '"weights" of "fairness": the problem has no such key' "${P}\"weights\": [{\"of\": \"fairness\", \"vertices\": [0], \"weight\": 2}]}"
refuse 3 '"planar" has weights for "faces"' "${P}\"weights\": [{\"of\": \"planar\", \"vertices\": [0], \"weight\": 2}]}"
refuse 3 '"weights": there is no face 36' "${P}\"weights\": [{\"of\": \"planar\", \"faces\": [36], \"weight\": 2}]}"
refuse 1 'a problem is a JSON object' '[]'
refuse 1 'a problem is a JSON object' ''
refuse 2 'there is more behind the last }' '{"planar": true}\n{}'
refuse 1 'expected , or }' '{"planar": true "fix": 0}'
refuse 1 'expected a key in quotes' '{"planar": true,}'
refuse 1 'expected a value' '{"planar": 01}'
refuse 1 'expected a value' '{"planar": 1e999}'
refuse 1 'expected a value' '{"planar": NaN}'
refuse 1 'expected a value' '{"fix": [1,]}'
refuse 1 'no end, or a control character' '{"input": "roof'
refuse 1 'is not UTF-8' '{"input": "\xff"}'
refuse 1 'half of a character' '{"input": "\\ud800x"}'
refuse 1 'begins none of' '{"input": "\\x"}'
refuse 1 'more than 16 deep' "{\"fix\": $(printf '[%.0s' $(seq 100000))"
refuse 1 'more than 200 keys' "{$(printf '"k%d": 1, ' $(seq 300))}"

# A cage of another mesh is refused by its name; outputs do not overwrite it.
"$tool" roof.obj --cage cage.obj --subdivide 2 --planar -o bad.obj >out.txt 2>&1
[ $? -eq 3 ] && grep -q 'cage.obj: subdivided, this cage has 81 vertices and 64 faces, and the input 49 and 36' out.txt && pass ||
    fail "a cage of another mesh: $(cat out.txt)"
"$tool" --problem caged.json -o cage.obj >out.txt 2>&1
[ $? -eq 2 ] && grep -q 'would overwrite the input .cage.obj' out.txt && pass || fail "an output over the cage: $(cat out.txt)"

# A file beyond --file-limit, one of zero bytes, and outputs over the problem itself.
head -c 1100000 /dev/zero | tr '\0' ' ' >big.json
"$tool" --problem big.json --file-limit 1 -o bad.obj >out.txt 2>&1
[ $? -eq 3 ] && grep -q 'more than 1 MB' out.txt && pass || fail "a large problem: $(cat out.txt)"
head -c 100 /dev/zero >zero.json
"$tool" --problem zero.json -o bad.obj >out.txt 2>&1
[ $? -eq 3 ] && pass || fail "a problem of zero bytes: $(cat out.txt)"
for output in write-problem report residuals; do
    "$tool" --problem all.json -o bad.obj --$output all.json >out.txt 2>&1
    [ $? -eq 2 ] && grep -q 'would overwrite' out.txt && pass || fail "--$output over the problem: $(cat out.txt)"
done

# ---- mutations: cut short and changed at random, a problem is solved or refused ----

cat >mutate.awk <<'END'
BEGIN { srand(seed); RS = "\001" }
{   text = $0; n = length(text); marks = "{}[],:\"-0123456789eE.\\ \ntfx"
    for (k = 0; k < 1 + seed % 4; k++) {
        at = 1 + int(rand() * n); what = int(rand() * 4)
        mark = substr(marks, 1 + int(rand() * length(marks)), 1)
        if (what == 0) text = substr(text, 1, at)
        else if (what == 1) text = substr(text, 1, at - 1) mark substr(text, at + 1)
        else if (what == 2) text = substr(text, 1, at) mark substr(text, at + 1)
        else text = substr(text, 1, at) substr(text, at + 1 + int(rand() * 20))
    }
    printf "%s", text }
END
seed=0
while [ $seed -lt 90 ]; do
    seed=$((seed + 1))
    case $((seed % 3)) in 0) from=all ;; 1) from=rows ;; 2) from=pulls ;; esac
    awk -v seed=$seed -f mutate.awk $from.json >bad.json
    "$tool" --problem bad.json -o mutated.obj --iterations 3 --quiet >out.txt 2>&1
    status=$?
    [ $status -le 3 ] && ! grep -qE 'Sanitizer|runtime error' out.txt || fail "mutation $seed exits with $status: $(head -n 3 out.txt)"
done
pass

# ---- the examples are exact and sound ----

cp "$here"/../examples/problems/* .
for name in shell three_curves hall; do # check_examples.sh runs the others
    "$tool" --problem $name.json -o example.obj --quiet >out.txt 2>&1 && pass || fail "$name.json exits with $?: $(cat out.txt)"
done

# ---- the schema has the keys that the tool has ----

if command -v python3 >/dev/null; then
    "$tool" --help >help.txt
    # What a section may hold, as the tool says when it is asked for a key "?".
    for section in $(python3 "$here/test_problem.py" "$here/../tools/problem.schema.json"); do
        printf '{"input": "roof.obj", "planar": true, "%s": [{"?": 1}]}' "$section" >asked.json
        "$tool" --problem asked.json -o bad.obj 2>&1 | sed -n "s/.*\"$section\": there is no key \"?\" here; it has:/$section/p"
    done >sections.txt
    python3 "$here/test_problem.py" "$here/../tools/problem.schema.json" help.txt sections.txt >out.txt 2>&1 && pass || fail "$(cat out.txt)"
else
    skip 'the schema (no python3)'
fi

echo "$passed passed, $failed failed, $skipped skipped"
[ "$failed" -eq 0 ]
