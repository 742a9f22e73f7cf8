#!/bin/bash
# check_frame.sh - tools/frame from the command line: closed forms, sums, refusals, and with build/tool (GPROJ_TOOL) what
# the paper tells of its meshes. The mechanics are tested by test_frame.c.
. "$(dirname "$0")/checks.sh"

have python3 || { skip 'frames: no python3'; report; }
tool=$(existing "${GPROJ_TOOL:-build/tool}")
compile() { # compile NAME LIBRARY FLAGS...: tools/frame.c, with the library that is compiled once for all tests, if it is
    local name=$1 library
    library=$(existing "$2")
    shift 2
    [ -n "$library" ] || set -- -O1
    ${CC:-cc} -std=c11 -Wall -Wextra -Werror "$@" ${library:+-DGPROJI_IMPLEMENTED} "$root/tools/frame.c" $library \
        -o "$work/$name" -lm -lpthread || { fail "tools/frame.c does not compile ($*)"; report; }
}
compile frame build/library.san.a -O1 -fsanitize=address,undefined -fno-sanitize-recover=all ${RUNTIME:-}
compile fast build/library.a -O2
data=$(existing "${GPROJ_DATA:-../../shared/data}")
cd "$work" || exit 2

grid() { # grid N HEIGHT: a vault of N x N quads over a square, by 1
    awk -v n="$1" -v h="$2" 'BEGIN {
        for (i = 0; i <= n; i++) for (j = 0; j <= n; j++) printf "v %d %d %.17g\n", i, j, h * 16 * i * (n - i) * j * (n - j) / n ^ 4
        for (i = 0; i < n; i++) for (j = 0; j < n; j++)
            print "f", i*(n+1)+j+1, (i+1)*(n+1)+j+1, (i+1)*(n+1)+j+2, i*(n+1)+j+2 }'
}
value() { # value EXPRESSION: of the report r
    python3 -c 'import json, math, sys; r = json.load(open("r.json")); print(eval(sys.argv[1]))' "$1"
}
holds() { # holds WHAT EXPRESSION
    if [ "$(value "$2")" = True ]; then pass; else fail "$1: not $2"; fi
}
run() { # run WHAT ARGUMENTS...
    local what=$1
    shift
    if ./${frame:-frame} "$@" --report r.json >out.txt 2>err.txt && [ ! -s err.txt ]; then pass; else fail "$what: $(head -n 3 err.txt)"; fi
}
refuses() { # refuses STATUS PART ARGUMENTS...
    local want=$1 part=$2
    shift 2
    ./frame "$@" >out.txt 2>err.txt
    if [ $? -eq "$want" ] && grep -qF -- "$part" err.txt; then pass; else fail "'$*' does not say '$part': $(head -n 2 err.txt)"; fi
}
grid 6 2 >vault.obj

# One square with clamped corners: four clamped beams, of 1 m after scaling; w = 7850 x 9.81 x 0.02 x 0.05 N/m.
grid 1 0 >square.obj
run 'square' square.obj --scale 2 --fixed 0-3 --section rectangle:0.02,0.05
holds 'bending of clamped beams' 'abs(r["totals"]["max_bending"] / (7850 * 9.81 * 0.001 * 4 / 12) - 1) < 1e-10'
holds 'stress of clamped beams' 'abs(r["totals"]["max_utilisation"] / (r["totals"]["max_bending"] / (0.02 * 0.05 ** 2 / 6) / 235e6) - 1) < 1e-12'
holds 'Euler load' 'abs(r["edges"][0]["euler_load"] / (math.pi ** 2 * 210e9 * 0.05 * 0.02 ** 3 / 12 / 4) - 1) < 1e-12'

# The supports bear everything; halves of an edge, and another direction of the mesh, change nothing.
printf 'vertex,fx,fy,fz\n24,100,0,-5000\n17,0,30,0 # a push\n' >loads.csv
run 'vault' vault.obj --loads loads.csv --picture r.svg
holds 'weight' 'abs(sum(e["length"] for e in r["edges"]) * 7850 * 9.81 * 0.0019 / r["totals"]["weight"] - 1) < 1e-12'
holds 'vertical reactions' 'abs(r["totals"]["reaction_z"] / (r["totals"]["weight"] + 5000) - 1) < 1e-12'
holds 'horizontal reactions' 'abs(r["totals"]["reaction_x"] + 100) < 1e-12 * 5000 and abs(r["totals"]["reaction_y"] + 30) < 1e-12 * 5000'
holds 'reactions of the list' 'abs(sum(v.get("fz", 0) for v in r["vertices"]) / r["totals"]["reaction_z"] - 1) < 1e-12'
holds 'buckling' 'r["buckling"][0]["factor"] > 0 and r["buckling"][0]["residual"] < 1e-8'
holds 'factors ascend' 'all(a["factor"] <= b["factor"] * (1 + 1e-9) for a, b in zip(r["buckling"], r["buckling"][1:]))'
grep -q 'buckling      if all loads are' out.txt && pass || fail 'the summary does not tell of buckling'
python3 -c 'import sys, xml.dom.minidom; xml.dom.minidom.parse("r.svg")' && pass || fail 'the picture is no XML'
two=$(value 'r["totals"]["max_displacement"]')
factor=$(value 'r["buckling"][0]["factor"]')
run 'one beam an edge' vault.obj --loads loads.csv --divide 1
holds 'displacement by one beam an edge' "abs(r['totals']['max_displacement'] / $two - 1) < 1e-8"
holds 'buckling by one beam an edge is from above' "$factor * (1 - 1e-9) < r['buckling'][0]['factor'] < 1.3 * $factor"
echo '0-6 # one side' >side.txt
run 'supports of three kinds' vault.obj --fixed side.txt --pinned 42,43 --roller 44-48 --skip-buckling
holds 'a roller bears in z alone' 'abs(r["vertices"][46]["fx"]) == 0 and r["vertices"][46]["fz"] > 0 and abs(r["vertices"][46]["ux"]) > 0'
holds 'a pinned vertex has no moment' 'r["vertices"][42]["mx"] == 0 and r["vertices"][42]["rx"] != 0 and r["vertices"][3]["mx"] != 0'

run 'corners' vault.obj --fixed corners --skip-buckling
grep -q ' 4 supports' out.txt && pass || fail 'a square has four corners'

printf 'kind,i\nedge,0,1,1\nload,0,0,0,-1\n' >flat.csv # no beam between supports has an axial force
run 'no axial forces' square.obj --fixed 0-3 --forces flat.csv
holds 'no correlation' 'r["form"]["correlation"] is None'
grep -q '^form .*no correlation$' out.txt && pass || fail 'the summary tells a correlation of nothing'

# Refusals name the place.
printf '24,1,2\n' >short.csv
printf '# nothing\n99,0,0,1\n' >far.csv
printf 'kind,i\nedge,0,48,1\n' >none.csv
printf 'kind,i\nedge,0,1\n' >cut.csv
printf 'v 0 0 0\nv 1 0 0\nv 1 1 0\nv 5 5 5\nf 1 2 3\n' >isolated.obj
printf '3,0,0,-1\n' >nowhere.csv
refuses 2 'no input is given'
refuses 2 'there is no option --planar' vault.obj --planar
refuses 2 'there are two inputs' vault.obj vault.obj
refuses 2 'expected box:W,H,T' vault.obj --section box:0.1,0.1,0.06
refuses 2 'expected box:W,H,T' vault.obj --section beam:1
refuses 2 'expected a number larger than 0' vault.obj --young 0
refuses 2 'expected a whole number from 1 to' vault.obj --divide 0
refuses 2 'must end in .json' vault.obj --report r.txt
refuses 2 'there is no vertex 49; the mesh has 49' vault.obj --pinned 0-49
refuses 2 '--fixed ,: this names no vertex' vault.obj --fixed ,
refuses 2 '--scale is given twice' vault.obj --scale 1 --scale 2
cp loads.csv loads.json
refuses 2 "would overwrite the input 'loads.json'" vault.obj --loads loads.json --report loads.json
cmp -s loads.csv loads.json && pass || fail 'loads are lost'
refuses 2 'give one' vault.obj --scale 2 --mean-edge 1 --pinned boundary
refuses 2 'nothing loads the frame' vault.obj --density 0
: >empty.obj
refuses 3 'empty.obj: the text is empty' empty.obj
refuses 3 'line 1: expected VERTEX,FX,FY,FZ' vault.obj --loads short.csv
refuses 3 'line 2: there is no vertex 99' vault.obj --loads far.csv
refuses 3 'vertex 3 bears a load' isolated.obj --loads nowhere.csv
refuses 3 'line 2: no edge joins vertices 0 and 48' vault.obj --forces none.csv
refuses 3 'line 2: expected edge,I,J,W' vault.obj --forces cut.csv
refuses 3 'no lines load,I,FX,FY,FZ' vault.obj --forces /dev/null
refuses 3 'No such file' vault.obj --fixed nothing.txt
refuses 3 'nothing.obj' nothing.obj
refuses 3 'is a mechanism: vertex ' vault.obj --roller boundary
refuses 3 'is a mechanism: vertex ' square.obj --pinned 0
refuses 3 'wrong units?' vault.obj --gravity 1e200
refuses 3 'cannot be written' vault.obj --report nowhere/r.json

# An output that cannot be written leaves the other one as it was, and nothing beside it.
ln -s /dev/full full.json
mkdir folder.json folder.svg
for outputs in 'old.svg full.json' 'old.svg folder.json' 'folder.svg old.json'; do
    echo old | tee old.svg >old.json
    refuses 3 "the output '" vault.obj --skip-buckling --picture ${outputs% *} --report ${outputs#* }
    [ "$(cat old.svg old.json)" = "$(printf 'old\nold')" ] && ! ls gproj-*.tmp >ls.txt 2>&1 && pass ||
        fail "a failing output of '$outputs' changed the other, or left a file"
done
strange=$(printf 'a\nb\033[31m.obj') # names are printed on one line, without what terminals obey
refuses 3 'a?b?[31m.obj' "$strange"
cp vault.obj "$strange"
./frame "$strange" --skip-buckling >out.txt 2>err.txt
[ $? -eq 0 ] && head -n 1 out.txt | grep -qF 'a?b?[31m.obj: ' && pass || fail "a strange name: $(head -n 1 out.txt)"

# Equilibrium of the form: beams have nearly these forces. On Intersection, whose faces are planar (the paper, section 4):
# hardly any beam is in tension once forces are part of the form.
form() { # form MESH OPTIONS...
    local mesh=$1
    shift
    "$tool" "$mesh" -o form.obj --fix boundary --quiet "$@" >form.txt 2>&1 || fail "$mesh $*: $(head -n 2 form.txt)"
}
if [ ! -x "$tool" ]; then
    skip 'frames of forms: no tool'
else
    form vault.obj --equilibrium --compressive --forces form.csv
    run 'a form' form.obj --forces form.csv --section circle:0.05
    holds 'forces of a form' 'r["form"]["correlation"] > 0.9 and r["totals"]["edges_in_tension"] == 0'
    holds 'loads of a form' 'abs(r["form"]["unit"] / (7850 * 9.81 * math.pi * 0.05 ** 2 / 4) - 1) < 1e-6'
    form vault.obj --equilibrium --compressive --forces form.csv --supports boundary
    grep -v '^support,[1-9]' form.csv >corner.csv
    run 'supports of a form' form.obj --forces corner.csv --fixed 48 --skip-buckling
    grep -q ' 1 supports' out.txt && pass || fail 'supports of the form count beside --fixed'
fi
if [ -x "$tool" ]; then # the examples of --help run as they are printed
    mkdir examples
    cp "$root/examples/roof.obj" examples
    echo '200,0,0,-1000' >examples/snow.csv
    ln -s "$tool" guidedproj
    ./frame --help | sed -n '/^examples/,/^$/p' | sed -e 1d -e ':a' -e '/\\$/{N;s/\\\n//;ba' -e '}' | grep . >examples/list
    [ "$(wc -l <examples/list)" -ge 4 ] && pass || fail '--help has too few examples'
    while IFS= read -r command; do
        (cd examples && PATH=$work:$PATH sh -c "$command" >out.txt 2>&1 </dev/null) && pass ||
            fail "the example '$command': $(head -n 3 examples/out.txt)"
    done <examples/list
fi
if [ ! -x "$tool" ] || [ ! -f "$data/Intersection.obj" ]; then
    skip 'the frame of Intersection: no tool, or the folder of real meshes is not there (GPROJ_DATA)'
else
    form "$data/Intersection.obj" --planar
    frame=fast # for 31,000 unknowns
    run 'Intersection, planar' form.obj --mean-edge 1 --fixed boundary
    holds 'planar faces alone leave tension' 'r["totals"]["edges_in_tension"] > 50'
    factor=$(value 'r["buckling"][0]["factor"]') moved=$(value 'r["totals"]["max_displacement"]')
    form "$data/Intersection.obj" --planar --equilibrium --compressive --forces form.csv
    run 'Intersection, in equilibrium' form.obj --mean-edge 1 --fixed boundary --forces form.csv
    holds 'equilibrium leaves hardly any tension' 'r["totals"]["edges_in_tension"] <= 10 and r["totals"]["max_tension"] < 0.01 * r["totals"]["max_compression"]'
    holds 'forces of the form' 'r["form"]["correlation"] > 0.85 and 0.5 < r["totals"]["max_compression"] / max(e["form_force"] for e in r["edges"]) < 2'
    holds 'stiffer' "r['buckling'][0]['factor'] > $factor and r['totals']['max_displacement'] < 0.7 * $moved"
    holds 'the weight on the supports' 'abs(r["totals"]["reaction_z"] / r["totals"]["weight"] - 1) < 1e-12'
fi
report
