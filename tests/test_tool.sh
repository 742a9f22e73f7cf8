#!/bin/bash
# test_tool.sh - runs the built command line on small meshes of its own and, where they are, on real ones.
#
#     TOOL=../tools/guidedproj ./test_tool.sh        GPROJ_DATA: folder of the real meshes (../../shared/data)
#
# Results are measured by check_mesh.c, which knows nothing of the library. Prints one line a failure, and at the
# end `N passed, N failed, N skipped`; exits 1 where something failed.

. "$(dirname "$0")/tool.sh"
data=${GPROJ_DATA:-$here/../../shared/data}
check() { # check NAME COMMAND...: the command succeeds
    local name=$1
    shift
    if "$@" >/dev/null 2>&1; then pass; else fail "$name"; fi
}

if [ ! -x "$tool" ]; then
    echo "there is no tool at $tool: build it first, or set TOOL"
    exit 2
fi
if ! ${CC:-cc} -std=c99 -O2 -o "$work/check_mesh" "$here/check_mesh.c" -lm; then
    echo "check_mesh.c does not compile"
    exit 2
fi
cd "$work" || exit 2

# ---- meshes ----

# The height of the roof over the square: a surface that has planar quads, and a little on top.
height='function z(i, j) { return h * (sin(0.5 * i) + 0.8 * cos(0.4 * j) + 0.03 * sin(1.3 * i * j)) }'
grid() { # grid N AMPLITUDE: a wavy roof of N x N quads over a square
    awk -v n="$1" -v h="$2" "$height"'BEGIN {
        for (i = 0; i <= n; i++) for (j = 0; j <= n; j++) printf "v %.17g %.17g %.17g\n", i, j, z(i, j)
        for (i = 0; i < n; i++) for (j = 0; j < n; j++)
            print "f", i*(n+1)+j+1, (i+1)*(n+1)+j+1, (i+1)*(n+1)+j+2, i*(n+1)+j+2 }'
}
torus() { # torus N M: a closed mesh
    awk -v n="$1" -v m="$2" 'BEGIN {
        t = 6.283185307179586
        for (i = 0; i < n; i++) for (j = 0; j < m; j++) { u = t * i / n; v = t * j / m; r = 3 + cos(v)
            printf "v %.17g %.17g %.17g\n", r * cos(u), r * sin(u), sin(v) + 0.3 * sin(2 * u) }
        for (i = 0; i < n; i++) for (j = 0; j < m; j++) { k = (i + 1) % n; l = (j + 1) % m
            print "f", i*m+j+1, k*m+j+1, k*m+l+1, i*m+l+1 } }'
}
grid 8 0.6 >grid.obj
grid 20 0.5 >big.obj
torus 16 8 >torus.obj
awk 'BEGIN { print "OFF\n5 2 0\n0 0 0\n1 0 0.2\n1 1 0\n0 1 0.1\n2 0.5 0\n4 0 1 2 3\n3 1 4 2" }' >small.off

# ---- helpers for runs ----

run() { # run ARGUMENTS: sets status, and the texts out.txt and err.txt
    "$tool" "$@" >out.txt 2>err.txt
    status=$?
}
expect() { # expect STATUS PART ARGUMENTS...: exit status, and a part of the message; no output is touched
    local want=$1 part=$2
    shift 2
    printf 'old\n' >old.obj
    rm -f new.obj new.json new.svg
    run "$@"
    if [ "$status" -ne "$want" ]; then
        fail "'$*' exits with $status instead of $want: $(head -n 1 err.txt)"
    elif ! grep -qF -- "$part" err.txt; then
        fail "'$*' does not say '$part': $(head -n 1 err.txt)"
    elif [ "$(cat old.obj)" != old ] || [ -e new.obj ] || [ -e new.json ] || [ -e new.svg ] ||
        ls ./*.tmp >/dev/null 2>&1; then
        fail "'$*' touched an output"
    elif [ "$(grep -c . err.txt)" -gt 2 ]; then
        fail "'$*' prints more than a sentence"
    else
        pass
    fi
}
counts() { echo "$(grep -c '^v ' "$1") $(grep -c '^f ' "$1")"; } # of vertices and faces
value() { awk -v name="$1" '$1 == name { print $2 }' measures.txt; }
measure() { ./check_mesh "$1" "$2" >measures.txt; }
within() { # within NAME LIMIT: the measure is a number and at most this
    awk -v x="$(value "$1")" -v limit="$2" 'BEGIN { exit !(x != "" && x == x + 0 && x + 0 <= limit + 0) }'
}
want() { # want WHAT NAME LIMIT
    if within "$2" "$3"; then pass; else fail "$1: $2 is $(value "$2"), more than $3"; fi
}

# ---- usage ----

expect 2 "no input" -o new.obj --planar
expect 2 "no output" grid.obj --planar
expect 2 "nothing is asked for" grid.obj -o new.obj
expect 2 "must end in .obj, .off, .stl or .ply" grid.obj -o new.fbx --planar
expect 2 "did you mean --planar" grid.obj -o new.obj --plannar
expect 2 "did you mean --planar" grid.obj -o new.obj -planar
expect 2 "did you mean --fairness" grid.obj -o new.obj --fair 0.2
expect 2 "did you mean --circular" grid.obj -o new.obj --circle
expect 2 "no option --sphere; --help lists them" grid.obj -o new.obj --sphere
expect 2 "did you mean --tolerance" grid.obj -o new.obj --planar --tolerence=1e-9
for levels in 0 15 1.5 2,lop ,loop x; do
    expect 2 "expected a whole number from 1 to 14" grid.obj -o new.obj --planar --subdivide $levels
done
expect 2 "one is needed" grid.obj --fill curve.obj -o new.obj
expect 2 "add --fill" grid.obj -o new.obj --planar --sides 4,4,4,4
expect 2 "add --equilibrium" grid.obj -o new.obj --compressive
for sides in 4,4,,4 4,4,0,4 4,4, x 1.5; do
    expect 2 "expected N,N,..." --fill curve.obj -o new.obj --sides "$sides"
done
expect 2 "expected a height" grid.obj -o new.obj --planar --lift 0
expect 2 "expected a height" grid.obj -o new.obj --planar --lift up
expect 2 "expected a height" grid.obj -o new.obj --planar --lift 1e300
expect 2 "--state writes to a file" grid.obj -o new.obj --planar --state -
expect 3 "face 0 has 4 corners" grid.obj -o new.obj --planar --subdivide 1,loop
expect 3 "more than a mesh can have" grid.obj -o new.obj --planar --subdivide 14
expect 2 "a weight is written --planar=2" grid.obj -o new.obj --planar 2
expect 2 "the weight must be a number" grid.obj -o new.obj --planar=-1
expect 2 "the weight must be a number" grid.obj -o new.obj --planar=nan
expect 2 "the weight must be a number" grid.obj -o new.obj --planar=1x
expect 2 "--planar is given twice" grid.obj -o new.obj --planar --planar
expect 2 "--quiet takes no value" grid.obj -o new.obj --planar --quiet=yes
expect 2 "needs a value" grid.obj -o new.obj --planar --fairness
expect 2 "needs a value" grid.obj -o new.obj --fairness --planar
expect 2 "expected W[*DECAY][:N]" grid.obj -o new.obj --fairness 0.2*1.5
expect 2 "expected W[*DECAY][:N]" grid.obj -o new.obj --fairness 0.2:0
expect 2 "expected W[*DECAY][:N]" grid.obj -o new.obj --gauss inf
expect 2 "expected W[*DECAY][:N]" grid.obj -o new.obj --tangential ""
expect 2 "whole number from 1" grid.obj -o new.obj --planar --iterations 0
expect 2 "whole number from 1" grid.obj -o new.obj --planar --iterations 1e3
expect 2 "larger than 0" grid.obj -o new.obj --planar --tolerance -1
expect 2 "larger than 0" grid.obj -o new.obj --planar --epsilon 0
expect 2 "larger than 0" grid.obj -o new.obj --planar --time-limit 1s
expect 2 "from 0 to 256" grid.obj -o new.obj --planar --threads 1000
expect 2 "expected I,X,Y,Z" grid.obj -o new.obj --move 3,1,2
expect 2 "expected I,X,Y,Z" grid.obj -o new.obj --move 3,1,2,3,4
expect 2 "expected I,X,Y,Z" grid.obj -o new.obj --move -3,1,2,3
expect 2 "moved twice" grid.obj -o new.obj --move 3,1,2,3 --move 3,1,2,4
for range in 1 2,1 , =2 a,2 1,b -1,2 0.9,1.1=x 1,2,3 0.5,1.5=1*0.9; do
    expect 2 "expected MIN,MAX" grid.obj -o new.obj --planar --edge-length "$range"
    expect 2 "expected MIN,MAX" grid.obj -o new.obj --face-area="$range"
done
for cost in 1 1,2 1,2, 0,0,5 -1,2,5 1,2,x0 1,2,3,4 1,2,x; do
    expect 2 "expected LENGTHPRICE,AREAPRICE,MAX" grid.obj -o new.obj --planar --cost "$cost"
done
expect 2 "expected an area" grid.obj -o new.obj --planar --total-area 0
expect 2 "expected an area" grid.obj -o new.obj --planar --total-area xx
expect 2 "the weight must be a number" grid.obj -o new.obj --planar --equal-lengths=-1
expect 2 "--move: there is no vertex 81" grid.obj -o new.obj --planar --move 81,1,2,3
expect 2 "--fix: there is no vertex 99" grid.obj -o new.obj --planar --fix 0,99
expect 2 "runs backwards" grid.obj -o new.obj --planar --fix 9-7
expect 2 "expected vertices" grid.obj -o new.obj --planar --fix 9-
expect 2 "has no boundary" torus.obj -o new.obj --planar --glide boundary
expect 2 "two inputs" grid.obj big.obj -o new.obj --planar
expect 2 "same path" grid.obj -o new.obj --planar --report ./new.obj
expect 2 "same path" grid.obj -o new.obj --planar --report new.svg --picture new.svg
expect 2 "would overwrite the input" grid.obj -o new.obj --planar --report grid.obj
expect 2 "would overwrite the input" grid.obj -o new.obj --planar --reference big.obj --report big.obj
cp grid.obj roof.svg # an input by another name: a picture would overwrite it
expect 2 "would overwrite the input" roof.svg -o new.obj --planar --picture roof.svg
expect 2 "would overwrite the input" grid.obj -o new.obj --planar --reference roof.svg --picture roof.svg
rm roof.svg
expect 2 "the picture 'big.obj' must end in .svg" grid.obj -o new.obj --planar --picture big.obj
expect 2 "must end in .svg" grid.obj -o new.obj --planar --picture new
expect 2 "must end in .svg" grid.obj -o new.obj --planar --picture .svg
expect 2 "--report writes to a file" grid.obj -o new.obj --planar --report -
expect 2 "--report writes to a file" grid.obj -o new.obj --planar --report=-
expect 2 "add --planar" grid.obj -o new.obj --gauss 0.1
expect 2 "add --planar" grid.obj -o new.obj --gauss 0.1 --fairness 0.1 --fix boundary
expect 2 "there is no folder" grid.obj -o nowhere/new.obj --planar
long=$(printf 'a%.0s' {1..300}).obj
expect 2 "cannot be written: File name too long" grid.obj -o "$long" --planar
cp grid.obj program.obj && chmod +x program.obj # which its user may enter, were it a folder
expect 2 "cannot be written: Not a directory" grid.obj -o program.obj/new.obj --planar
expect 2 "needs a path" grid.obj -o new.obj --planar --report=
expect 2 "--view is for a picture" grid.obj -o new.obj --planar --view top
expect 2 "--colour is for a picture" grid.obj -o new.obj --planar --colour area
expect 2 "--title is for a picture" grid.obj -o new.obj --planar --title Roof
expect 2 "expected planarity, area, parallelogram or bend" grid.obj -o new.obj --planar --picture new.svg --colour red
expect 2 "AZIMUTH,ELEVATION" grid.obj -o new.obj --planar --picture new.svg --view north
expect 2 "expected DISTANCE,FILE" grid.obj -o new.obj --planar --offset 0.3
expect 2 "expected DISTANCE,FILE" grid.obj -o new.obj --planar --offset 0.3,
expect 2 "expected DISTANCE,FILE" grid.obj -o new.obj --planar --offset 0,old.obj
expect 2 "expected DISTANCE,FILE" grid.obj -o new.obj --planar --offset old.obj
expect 2 "expected DISTANCE,FILE" grid.obj -o new.obj --planar --offset inf,old.obj
expect 2 "must end in .obj, .off, .stl or .ply" grid.obj -o new.obj --planar --offset 0.3,new.fbx
expect 2 "must end in .obj, .off, .stl or .ply" grid.obj -o new.obj --planar --offset 0.3,old.obj --support new
expect 2 "expected little, big or ascii; did you mean little?" grid.obj -o new.ply --planar --encoding litle
expect 2 "--encoding is for outputs that end in" grid.obj -o new.obj --planar --encoding ascii
expect 2 "--encoding big is not for STL" grid.obj -o new.stl --planar --encoding big
expect 2 "--encoding big is not for STL" grid.obj -o new.ply --planar --encoding big --offset 0.3,old.STL
expect 2 "add --offset" grid.obj -o new.obj --planar --support old.obj
expect 2 "same path" grid.obj -o new.obj --planar --offset 0.3,new.obj
expect 2 "same path" grid.obj -o new.obj --planar --offset 0.3,old.obj --support old.obj
expect 2 "would overwrite the input" grid.obj -o new.obj --planar --offset 0.3,grid.obj
expect 2 "would overwrite the input" grid.obj -o new.obj --planar --offset 0.3,old.obj --support grid.obj
expect 2 "there is no folder" grid.obj -o new.obj --planar --offset 0.3,nowhere/old.obj
expect 2 "add --planar" grid.obj -o new.obj --conical
expect 3 "offset vertex" grid.obj --quiet -o new.obj --planar --offset 1e200,old.obj --report new.json
expect 2 "did you mean boundary?" grid.obj -o new.obj --planar --fix boundry
expect 2 "--fix cornrs: there is no such file; expected boundary, corners" grid.obj -o new.obj --planar --fix cornrs=2
expect 2 "did you mean corners?" grid.obj -o new.obj --equilibrium --supports cornesr
expect 2 "did you mean boundary?" grid.obj -o new.obj --planar --glide boundray
expect 2 "--glide edge: there is no such file; expected boundary, or an OBJ file" grid.obj -o new.obj --planar --glide edge
expect 2 "--reference Input: there is no such file; expected input, or the file of a mesh" grid.obj -o new.obj --planar --reference Input
expect 3 "--reference big.obj=1e60: there is no such file" grid.obj -o new.obj --planar --reference big.obj=1e60
expect 2 "--weld is for an input" --fill grid.obj --weld -o new.obj
expect 2 "--planar=1e60: the weight must be a number from 0 to 1e50" grid.obj -o new.obj --planar=1e60
expect 2 "--fairness 1e60: expected W" grid.obj -o new.obj --planar --fairness 1e60
for weighted in '--fix boundary=1e60' '--glide boundary=1e60' '--move 0,0,0,0=1e60' '--edge-length 0.5,2=1e60'; do
    expect 2 'and maybe =W, a weight from 0 to 1e50' grid.obj -o new.obj --planar $weighted
done
expect 2 'and maybe =W, a weight from 0 to 1e50' grid.obj -o new.obj --equilibrium --stress 0,2=1e60
expect 2 "--move 5,1e80,0,0: expected I,X,Y,Z" grid.obj -o new.obj --planar --move 5,1e80,0,0
: >none.txt
expect 2 "--fix none.txt: this names no vertex" grid.obj -o new.obj --planar --fix none.txt
expect 2 "--fix ,: this names no vertex" grid.obj -o new.obj --planar --fix ,
awk 'BEGIN { print "v 0 0 0.1"; for (i = 0; i < 24; ++i) print "v", cos(i * 0.2618), sin(i * 0.2618), 0
    for (i = 0; i < 24; ++i) print "f 1", i + 2, (i + 1) % 24 + 2 }' >disk.obj
expect 2 "--fix corners: the boundary has no corners" disk.obj -o new.obj --planar --fix corners
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\nf 1 3 2\nf 1 2 4\nf 2 3 4\nf 3 1 4\n' >closed.obj
for option in "--fix boundary" "--fix corners" "--glide boundary" --planar-boundary --straight-boundary --orthogonal-boundary \
    "--boundary-fairness 0.1"; do
    expect 2 "mesh is closed and has no boundary" closed.obj -o new.obj --planar $option
done
expect 2 "did you mean area?" grid.obj -o new.obj --planar --picture new.svg --colour aera
for weld in -1 2 x nan; do
    expect 2 "expected a distance in mean edge lengths" grid.obj -o new.obj --planar --weld=$weld
done
expect 2 "--allow-spoiled takes no value" grid.obj -o new.obj --planar --allow-spoiled=1
mkdir -p folder.obj
expect 2 "is a folder" grid.obj -o folder.obj --planar
if [ "$(id -u)" -ne 0 ]; then
    mkdir -p locked && chmod a-w locked
    expect 2 "cannot be written" grid.obj -o locked/new.obj --planar
fi

run --help
if [ $status -eq 0 ] && grep -q -- "--planar" out.txt && ! awk 'length > 80 { exit 1 }' out.txt; then
    fail "--help is wider than 80 columns"
elif [ $status -eq 0 ] && grep -q -- "--glide WHERE" out.txt && grep -q "exit status" out.txt; then
    pass
else
    fail "--help"
fi
run --version
if [ $status -eq 0 ] && grep -q '^guidedproj [0-9]' out.txt; then pass; else fail "--version"; fi

# ---- input that is refused: the message names the file, old outputs stay ----

refuse() { # refuse NAME: reads the text of a mesh
    cat >"bad-$1"
    expect 3 "bad-$1" "bad-$1" -o old.obj --planar --report new.json --picture new.svg
}
printf '' | refuse empty.obj
printf 'v 0 0 0\nv 1 0 0\nv 1 1 0\n' | refuse nofaces.obj
printf 'v 0 0 0\nv 1 0 0\nv 1 1 0\nf 0 1 2\n' | refuse zero.obj
printf 'v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 4\n' | refuse range.obj
printf 'v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 -4\n' | refuse negative.obj
printf 'v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2\n' | refuse two.obj
printf 'v 0 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 2\n' | refuse repeated.obj
printf 'v 0 0 nan\nv 1 0 0\nv 1 1 0\nf 1 2 3\n' | refuse nan.obj
printf 'v 0 0 1e999\nv 1 0 0\nv 1 1 0\nf 1 2 3\n' | refuse huge.obj
printf 'v 0 0\nv 1 0 0\nv 1 1 0\nf 1 2 3\n' | refuse short.obj
printf 'v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 0 0 1\nf 1 2 3\nf 2 1 4\nf 1 2 5\n' | refuse fin.obj
printf 'v 0 0 0\nv 1 0 0\nv 1 1 0\nv -1 0 0\nv -1 -1 0\nf 1 2 3\nf 1 4 5\n' | refuse bowtie.obj
printf 'OFF\n3 1 0\n0 0 0\n1 0 0\n' | refuse truncated.off
printf 'hello\n' | refuse word.off
head -c 100000 /dev/zero | refuse zeros.obj
head -c 100000 /dev/urandom | refuse noise.off
awk 'BEGIN { n = 12; t = 6.283185307179586
    for (i = 0; i < n; i++) for (j = 0; j < 2; j++) { u = t * i / n; s = (j - 0.5)
        print "v", (3 + s * cos(u / 2)) * cos(u), (3 + s * cos(u / 2)) * sin(u), s * sin(u / 2) }
    for (i = 0; i < n; i++) {
        a = 2*i+1; b = 2*i+2; c = i+1 < n ? 2*i+3 : 2; d = i+1 < n ? 2*i+4 : 1
        print "f", a, c, d, b } }' |
    refuse moebius.obj
printf 'OFF\n4 1 0\n0 0 0\n1 0 0\n1 1 0\n0 1 0\n4 1 2 3 4\n' | refuse one.off
grep -q "seem to be counted from 1" err.txt && pass || fail "OFF that counts from 1: $(cat err.txt)"
printf 'ply\nformat ascii 1.0\nelement vertex 3\n' | refuse words.ply
grep -q "words.ply: line 4: the file ends before 'end_header'" err.txt && pass || fail "PLY: $(cat err.txt)"
printf 'solid roof\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n' | refuse facets.stl
grep -q "facets.stl: line 5: the text ends where 'vertex' is expected" err.txt && pass || fail "STL: $(cat err.txt)"
printf 'solid roof\nfacet normal 0 0 1\nouter loop\nvertex 0 0 0\n' | refuse facets.obj
grep -q "this is an STL file: its name must end in .stl" err.txt && pass || fail "STL named .obj: $(cat err.txt)"
head -c 300 /dev/urandom | tr -d '\000' | refuse noise.stl
grep -q "noise.stl: byte 80: " err.txt && pass || fail "no STL: $(cat err.txt)"
printf 'abc\0\0' | refuse model.3dm
grep -q "a .3dm file, and only OBJ, OFF, STL and PLY are read" err.txt && pass || fail "an ending: $(cat err.txt)"
cp bad-range.obj v # a name that the sentence has in it
expect 3 "guidedproj: v: " v -o old.obj --planar
expect 3 "missing.obj" missing.obj -o old.obj --planar
expect 3 "missing.obj" grid.obj -o old.obj --planar --reference missing.obj=0.1
expect 3 "missing.obj" grid.obj -o old.obj --planar --glide missing.obj
expect 3 "missing.txt" grid.obj -o old.obj --planar --fix missing.txt
expect 3 "bad-range.obj" grid.obj -o old.obj --planar --reference bad-range.obj
expect 3 "bad-nofaces.obj" grid.obj -o old.obj --planar --glide bad-nofaces.obj
expect 3 "bad-nofaces.obj" grid.obj -o old.obj --planar --reference bad-nofaces.obj
printf '1 2 x\n' >words.txt
expect 3 "words.txt: line 1: expected vertices" grid.obj -o old.obj --planar --fix words.txt
printf '1 2 500\n' >far.txt
expect 3 "far.txt: line 1: there is no vertex 500" grid.obj -o old.obj --planar --fix far.txt
run grid.obj -o . --planar # no ending
[ $status -eq 2 ] && pass || fail "an output without a name"

# ---- results ----

run grid.obj -o flat.obj --planar --report flat.json --picture flat.svg
[ $status -eq 0 ] && pass || fail "--planar on a grid exits with $status: $(cat err.txt)"
measure grid.obj flat.obj
want "grid --planar" planarity_after 1e-12
want "grid --planar" turned 0
[ "$(value same_connectivity)" = 1 ] && pass || fail "grid --planar: the connectivity changed"
grep -q "^iteration 1: " err.txt && pass || fail "no lines of progress"
grep -q "planarity" out.txt && pass || fail "no summary"
if command -v python3 >/dev/null; then
    check "the report is JSON" python3 -m json.tool flat.json
    check "the picture is XML" python3 -c "import xml.dom.minidom as m; m.parse('flat.svg')"
    cat >report.py <<'PY'
import json, subprocess
r = json.load(open('flat.json'))
m = dict(line.split() for line in open('measures.txt'))
close = lambda a, b, e: abs(a - b) <= e * max(abs(a), abs(b), 1e-300) + 1e-13
assert r['input'] == 'grid.obj' and r['mesh']['vertices'] == 81 and r['mesh']['faces'] == 64
assert r['mesh']['edges'] == 144 and r['mesh']['boundary_loops'] == 1 and r['mesh']['faces_by_degree'] == {'4': 64}
assert r['variables'] == 3 * 81 + 3 * 64 and r['rows'] == sum(g['rows'] for g in r['groups'])
assert r['result']['outcome'] == 'converged' and r['result']['exit_code'] == 0
assert len(r['iterations']) == r['result']['iterations'] and r['result']['residual'] <= 1e-12
assert 1e-13 <= r['result']['tolerance'] <= 1e-12 and r['result']['residual'] <= r['result']['tolerance']
assert [i['number'] for i in r['iterations']] == list(range(1, len(r['iterations']) + 1))
assert close(r['iterations'][-1]['planarity_max'], r['measures']['planarity_max'], 1e-3)
assert all(len(i['groups']) == len(r['groups']) for i in r['iterations'])
assert close(r['measures_before']['planarity_max'], float(m['planarity_before']), 1e-3)
assert close(r['measures']['planarity_max'], float(m['planarity_after']), 1e-3)
assert close(r['measures']['displacement_mean'], float(m['displacement_mean']), 1e-5)
assert close(r['measures']['deviation_rms'], float(m['deviation_rms']), 1e-5)
assert r['measures']['turned_faces'] == int(m['turned'])
assert r['measures']['folded_edges'] == int(m['folded_after'])
assert set(r['seconds']) >= {'set_up', 'analysis', 'assembly', 'factorisation', 'solve', 'total'}
r = json.load(open('guided.json'))
wish = [[g['weight'] for g in i['groups'] if g['name'] == 'fairness'][0] for i in r['iterations']]
assert len(wish) > 4 and all((w == 0.2) == (n < 4) and (w > 0) == (i['energy'] > 0)
                              for n, (w, i) in enumerate(zip(wish, r['iterations'])))
assert not any('row' in g for g in r['groups']) and 'vertex' in r['groups'][1]
r = json.load(open('volume.json'))
assert r['result']['worst'] == {'group': 'volume'}
PY
    run grid.obj -o guided.obj --planar --plain --fairness 0.2 --fix boundary --iterations 8 --report guided.json
    run grid.obj -o volume.obj --volume x1.3 --fix boundary --iterations 1 --report volume.json
    if python3 report.py 2>report.txt; then pass; else fail "the report: $(tail -n 3 report.txt | tr '\n' ' ')"; fi
    cp grid.obj 'odd "name\.obj'
    run 'odd "name\.obj' -o 'out <&>.obj' --planar --report odd.json --picture odd.svg
    check "a path with quotes in the report" python3 -m json.tool odd.json
    check "a path with <&> in the picture" python3 -c "import xml.dom.minidom as m; m.parse('odd.svg')"
    # Bytes that only look like UTF-8 (a surrogate, too long, too large), and a character that XML does not have.
    for bytes in '\355\240\200' '\340\200\200' '\360\217\277\277' '\364\220\200\200' '\357\277\276' '\357\277\277'; do
        odd=odd$(printf "$bytes").obj
        run grid.obj -o "$odd" --planar --report odd.json --picture odd.svg --title "a$(printf "$bytes")b"
        check "the picture with the title a${bytes}b" python3 -c "import xml.dom.minidom as m; m.parse('odd.svg')"
        check "the report with the path odd$bytes" python3 -m json.tool odd.json
        rm -f "$odd"
    done
else
    skip "JSON and XML (python3 is not there)"
fi
[ "$(grep -c '<path' flat.svg)" -ge 64 ] && pass || fail "the picture has too few faces"
grep -qE 'nan|inf' flat.svg && fail "the picture has numbers that are none" || pass

run grid.obj -o quiet.obj --planar --quiet
[ $status -eq 0 ] && [ ! -s out.txt ] && [ ! -s err.txt ] && pass || fail "--quiet is not quiet"
cmp -s quiet.obj flat.obj && pass || fail "two runs give different bytes"
for n in 1 2 5 0; do
    run big.obj -o "threads$n.obj" --planar --fairness '0.2*0.9' --glide boundary --reference=big.obj=0.1 \
        --picture "threads$n.svg" --threads $n
    sed "s/threads$n/threads/" "threads$n.svg" >"picture$n.svg"
    cmp -s threads1.obj "threads$n.obj" && cmp -s picture1.svg "picture$n.svg" && pass ||
        fail "$n threads give different bytes"
done
cp grid.obj inplace.obj
run inplace.obj -o inplace.obj --planar
[ $status -eq 0 ] && cmp -s inplace.obj flat.obj && pass || fail "output over the input"
ln -s inplace.obj link.obj
run grid.obj -o link.obj --planar
[ -L link.obj ] && cmp -s inplace.obj flat.obj && pass || fail "output through a symbolic link"
run small.off -o small-out.off --planar
[ $status -eq 0 ] && head -n 1 small-out.off | grep -q OFF && pass || fail "OFF in, OFF out"
run small.off -o small-out.obj --planar
[ $status -eq 0 ] && [ "$(grep -c '^f ' small-out.obj)" = 2 ] && pass || fail "OFF in, OBJ out"
run --planar --iterations=20 -o after.obj -- grid.obj
[ $status -eq 0 ] && pass || fail "-- before the input"

run grid.obj -o few.obj --planar --iterations 1 --report few.json
[ $status -eq 1 ] && [ -s few.obj ] && grep -q '"exit_code": 1' few.json && pass ||
    fail "too few iterations exit with $status"
run grid.obj -o loose.obj --planar --tolerance 0.25e-3 --report loose.json
[ $status -eq 0 ] && grep -qE '"tolerance": (0.00025|2.5e-0?4),?$' loose.json && pass ||
    fail "the report does not tell the tolerance that was asked for"
run big.obj -o late.obj --planar --time-limit 1e-9 --report late.json
[ $status -eq 1 ] && grep -q '"time out"' late.json && pass || fail "--time-limit: exits with $status"
run grid.obj -o flat.obj --planar
measure grid.obj flat.obj
far=$(value deviation_rms)
run grid.obj -o near.obj --planar --nearest --report near.json
[ $status -eq 0 ] && pass || fail "--planar --nearest exits with $status: $(cat err.txt)"
measure grid.obj near.obj
want "--planar --nearest" planarity_after 1e-12
want "--planar --nearest" turned 0
want "--planar --nearest, less than by default" deviation_rms "$far"
[ "$(grep -c '"optimality": ' near.json)" -gt 3 ] && pass || fail "the report does not tell how near the nearest is"
expect 2 "nothing to be near to" grid.obj -o new.obj --planar --closeness 0 --nearest
awk 'BEGIN { # the circular meshes nearest to this one have lost edges
    for (j = 0; j <= 6; j++) for (i = 0; i <= 6; i++) { x = i / 6; y = j / 6
        printf "v %.6f %.6f %.6f\n", x, y, 0.2 * (sin(4 * x + 1) * cos(3 * y) + 2 * x * y) }
    for (j = 0; j < 6; j++) for (i = 0; i < 6; i++) { a = 7 * j + i + 1; print "f", a, a + 1, a + 8, a + 7 } }' >twisted.obj
run twisted.obj -o near.obj --planar --circular --nearest --report near.json
[ $status -eq 0 ] && grep -q "have only guided" out.txt && grep -q '"optimality": null' near.json && pass ||
    fail "--nearest without a whole mesh at a minimum exits with $status: $(cat out.txt)"
[ "$(grep -c '"epsilon": ' near.json)" -gt 52 ] && pass || fail "the report has not all iterations of all attempts"
run grid.obj -o near.obj --planar --closeness 0 --fairness 0.2*0.5:3 --fix boundary --nearest
[ $status -eq 0 ] && grep -q "projected gradient" out.txt && pass || fail "--fairness --nearest exits with $status"
run grid.obj -o wish.obj --fairness 0.2
{ [ $status -eq 0 ] || [ $status -eq 1 ]; } && pass || fail "wishes alone exit with $status"

# What holds exactly on a spoiled mesh exits 1, counted against where the work began: a vertex is moved beyond the boundary.
run grid.obj -o spoiled.obj --fix boundary --move 40,14,4,0.5 --report spoiled.json
[ $status -eq 1 ] && grep -q 'all constraints hold.*but the mesh is spoiled: .*faces turned over (first: face ' out.txt &&
    grep -q -- '--allow-spoiled accepts it' out.txt && pass || fail "--move beyond the boundary exits with $status"
measure grid.obj spoiled.obj
awk -v n="$(value turned)" '/"exit_code": 1/ { code = 1 } /"spoiled": / { inside = 1 }
    inside && /"turned_faces"/ { split($2, x, ","); good = x[1] == n && n > 0; inside = 0 } END { exit !(code && good) }' spoiled.json &&
    pass || fail "the report does not count what is spoiled"
cp spoiled.obj strict.obj
run grid.obj -o spoiled.obj --fix boundary --move 40,14,4,0.5 --allow-spoiled --report spoiled.json
[ $status -eq 0 ] && cmp -s spoiled.obj strict.obj && grep -q '"exit_code": 0' spoiled.json && pass ||
    fail "--allow-spoiled exits with $status"
run grid.obj -o spoiled.obj --planar --fix boundary --move 40,14,4,0.5 --iterations 1 --allow-spoiled
[ $status -eq 1 ] && pass || fail "--allow-spoiled accepts what does not hold"
run grid.obj -o spoiled.obj --fix 0-80 --move 40,4,4.98,0.36 --picture spoiled.svg --report spoiled.json
[ $status -eq 1 ] && grep -q '1 edge collapsed (edge [0-9]*, vertices 4[01] and 4[01])' out.txt && pass ||
    fail "a collapsed edge: exit $status, $(sed -n 2p out.txt)"
grep -q '<circle' spoiled.svg && grep -q 'collapsed edge' spoiled.svg && pass || fail "the picture marks no collapsed edge"
run grid.obj -o kept.obj --planar --report kept.json --picture kept.svg
grep -q '"total": 0' kept.json && ! grep -q 'collapsed\|<circle\|bow-tie' kept.svg && ! grep -q spoiled out.txt && pass ||
    fail "a good mesh is called spoiled"
printf 'v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 1 0\nv 2 0 0\nf 1 2 3 4\nf 2 5 6 3\n' >crossed.obj # face 1 crosses itself
run crossed.obj -o kept.obj --fix 0 --closeness 0 --picture crossed.svg
[ $status -eq 0 ] && grep -q 'bow-tie: crosses itself' crossed.svg && pass || fail "a bow-tie from the beginning: $status"
run crossed.obj -o kept.obj --fix 0-5 --move 3,0.9,-0.5,0 --picture crossed.svg
[ $status -eq 1 ] && grep -q '1 face crosses itself (face 0)' out.txt && grep -q 'bow-ties: cross themselves' crossed.svg && pass ||
    fail "a new bow-tie: $status, $(sed -n 2p out.txt)"

# Edges along the straight lines of a saddle: flat faces would collapse, and the advice works.
awk 'BEGIN { for (j = 0; j <= 8; ++j) for (i = 0; i <= 8; ++i) print "v", i, j, (i - 4) * (j - 4) / 8
    for (j = 0; j < 8; ++j) for (i = 1; i <= 8; ++i) print "f", j * 9 + i, j * 9 + i + 1, j * 9 + i + 10, j * 9 + i + 9 }' >straight.obj
run straight.obj -o flat.obj --planar --fix boundary
[ $status -eq 1 ] && grep -q 'edges follow asymptotic directions.*--diagonals' out.txt && pass || fail "a saddle: exit $status, $(sed -n 2p out.txt)"
run straight.obj -o flat.obj --planar --fix boundary --diagonals
[ $status -eq 0 ] && [ "$(counts flat.obj)" = "148 145" ] && grep -q 'displacement *[0-9.]*e-1[5-9]\|displacement *0 ' out.txt && pass ||
    fail "--diagonals: exit $status, $(counts flat.obj), $(sed -n 2,4p out.txt)"

# Seams: every face with vertices of its own is told, and closed by --weld.
awk '/^v / { x[++n] = $0; next } /^f / { for (k = 2; k <= NF; k++) { print x[$k]; list = list " " ++m }; f = f "f" list "\n"; list = "" }
    END { printf "%s", f }' grid.obj >soup.obj
run soup.obj -o apart.obj --planar
[ $status -eq 0 ] && grep -q '175 boundary vertices are at the same place' out.txt && [ "$(counts apart.obj)" = "256 64" ] && pass ||
    fail "open seams: exit $status, $(counts apart.obj)"
run soup.obj -o welded.obj --planar --weld
[ $status -eq 0 ] && grep -q '175 boundary vertices were merged' out.txt && [ "$(counts welded.obj)" = "81 64" ] &&
    grep -q '144 edges.*1 boundary loop' out.txt && pass || fail "--weld: exit $status, $(counts welded.obj)"
awk '$1 == "v" { if (int(n / 4) % 2) $2 += 1e-4; n++ } { print }' soup.obj >torn.obj # every other face
run torn.obj -o welded.obj --fix 0 --closeness 0 --weld
[ $status -eq 0 ] && [ "$(counts welded.obj)" != "81 64" ] && pass || fail "--weld joins what is 1e-4 apart"
run torn.obj -o welded.obj --fix 0 --closeness 0 --weld=1e-3
[ $status -eq 0 ] && [ "$(counts welded.obj)" = "81 64" ] && pass || fail "--weld=1e-3: exit $status, $(counts welded.obj)"
awk '$1 == "v" && ++n > 64 { printf "v %.17g %s %s\n", $2 + 1e-12, $3, $4; next } { print }' soup.obj >torn.obj
run torn.obj -o welded.obj --fix 0 --closeness 0 --weld=0
[ $status -eq 0 ] && [ "$(counts welded.obj)" != "81 64" ] && pass || fail "--weld=0 joins what is 1e-12 apart"
run soup.obj -o welded.obj --fix 0 --closeness 0 --weld=0
[ $status -eq 0 ] && [ "$(counts welded.obj)" = "81 64" ] && pass || fail "--weld=0: exit $status, $(counts welded.obj)"

# STL and PLY: PLY brings back all; triangles of an STL are joined by --weld, and those that are none left out.
still='--fix 0 --closeness 0 --allow-spoiled'
run grid.obj -o base.obj $still
for encoding in little big ascii; do
    run grid.obj -o same.ply $still --encoding $encoding
    run same.ply -o same.obj $still
    [ $status -eq 0 ] && cmp -s same.obj base.obj && pass || fail "PLY, $encoding: exit $status, $(cat err.txt)"
done
cp same.ply same.unknown
run same.unknown -o same.obj $still
[ $status -eq 0 ] && cmp -s same.obj base.obj && pass || fail "PLY by its first word: $(cat err.txt)"
run grid.obj -o same.ply $still
run <(cat same.ply) -o same.obj $still
[ $status -eq 0 ] && cmp -s same.obj base.obj && pass || fail "a binary PLY from a pipe: $(cat err.txt)"
for encoding in little ascii; do
    run grid.obj -o same.stl $still --encoding $encoding
    run same.stl -o same.obj $still
    [ $status -eq 0 ] && [ "$(counts same.obj)" = "384 128" ] && grep -q '303 boundary vertices are at the same place' out.txt &&
        pass || fail "STL, $encoding: exit $status, $(counts same.obj), $(cat err.txt)"
    run same.stl -o same.obj $still --weld=0
    [ $status -eq 0 ] && [ "$(counts same.obj)" = "81 128" ] && grep -q ' 1 boundary loop$' out.txt && pass ||
        fail "STL with --weld=0, $encoding: exit $status, $(counts same.obj)"
done
for size in 83 84 134 6483; do
    head -c $size same.stl >cut.stl
    expect 3 "cut.stl: " cut.stl -o new.obj $still
done
sed 's/^endsolid.*//' same.stl >slivers.stl
printf 'facet normal 0 0 0\nouter loop\nvertex 0 0 %s\nvertex 1 0 1\nvertex 0 0 %s\nendloop\nendfacet\n' 5 5 5 5.0000001 >>slivers.stl
echo endsolid >>slivers.stl
run slivers.stl -o same.obj $still --weld
grep -q '1 triangles with two corners at one place were left out, the first before face 128' out.txt && pass || fail "slivers: $(cat out.txt)"
printf 'v 0 0 0\nv 1 0 0\nv 0 1 0\nv 1 0 0\nv 1 1e-9 0\nv 1 1 0\nv 1 1e-9 0\nv 1 1 0\nv 0 1 0\nf 1 2 3\nf 4 6 5\nf 7 8 9\n' >thin.obj
run thin.obj -o same.obj $still --weld
[ "$(counts same.obj)" = "4 2" ] && grep -q '1 faces had fewer than 3 corners left after merging' out.txt && pass ||
    fail "a collapsing triangle: $(counts same.obj), $(cat out.txt err.txt)"
sed '1s/.*/&\nfacet normal 0 0 0\nouter loop\nvertex 9 9 0\nvertex 9 9 1\nvertex 9 9 2\nendloop\nendfacet/' same.stl >line.stl
run line.stl -o same.obj $still
grep -q '1 faces have no area' out.txt && pass || fail "a triangle without an area: $(cat out.txt err.txt)"
(cat same.stl; yes '                    ' | head -c 2000000) >long.stl
expect 3 "long.stl: more than 1 MB" long.stl -o new.obj $still --file-limit 1
ln -s /dev/zero zero.ply
expect 3 "zero.ply: more than 2 MB, or without end" zero.ply -o new.obj $still --file-limit 2
run grid.obj -o flat.ply --planar --offset 0.2,offset.stl --support support.ply --encoding ascii
[ "$(grep -c '^facet' offset.stl)" = 128 ] && grep -q '^element face 144$' support.ply && head -n 1 flat.ply | grep -qx ply && pass ||
    fail "offset and support as STL and PLY: $(cat err.txt)"

run grid.obj -o welded.obj --planar --weld
[ $status -eq 0 ] && ! grep -q 'note:' out.txt && pass || fail "--weld of a mesh without seams: $(cat out.txt)"
{ cat grid.obj; awk '/^v /' grid.obj; awk '/^f / { print "f", $2 + 81, $3 + 81, $4 + 81, $5 + 81 }' grid.obj; } >double.obj
run double.obj -o welded.obj --planar --weld # two sheets with one boundary: closed, one of them turned round
[ $status -ne 3 ] && grep -q '0 boundary loops' out.txt && pass || fail "--weld of two sheets exits with $status"
printf 'v 0 0 0\nv 1 0 0\nv 1 1 0\nv 1 0 0\nv 0 0 0\nv 1 1 1\nv 0 0 0\nv 1 0 0\nv 0 1 -1\nf 1 2 3\nf 4 5 6\nf 7 8 9\n' >fin.obj
expect 3 "after --weld: " fin.obj -o new.obj --fix 0 --weld

# Subdivision: counts, numbers of the cage's vertices, and what holds afterwards.
printf 'v 0 0 0\nv 2 0 0\nv 2 2 1\nv 0 2 0\nf 1 2 3\nf 1 3 4\n' >cage.obj
run cage.obj -o fine.obj --subdivide 2
[ $status -eq 0 ] && [ "$(counts fine.obj)" = "33 24" ] && pass || fail "--subdivide 2: $(counts fine.obj), exit $status"
run cage.obj -o fine.obj --subdivide 2,loop
[ $status -eq 0 ] && [ "$(counts fine.obj)" = "25 32" ] && pass || fail "--subdivide 2,loop: $(counts fine.obj)"
run grid.obj -o fine.obj --subdivide 1 --planar --fix 0,8,72,80 --report fine.json
[ $status -eq 0 ] && [ "$(counts fine.obj)" = "289 256" ] && grep -q '"vertices": 289' fine.json && pass ||
    fail "--subdivide 1 --planar exits with $status"
paste -d ' ' <(sed -n 9p fine.obj) <(sed -n 9p grid.obj) |
    awk '{ exit !(($2-$6)^2 + ($3-$7)^2 + ($4-$8)^2 < 1e-18) }' && pass || fail "--subdivide: --fix 8 is not the cage's vertex 8"

# A filled curve, its sides, and a lift.
awk 'BEGIN { n = 48; for (i = 0; i < n; i++) { t = 6.283185307179586 * i / n; r = 5 + cos(2 * t)
    printf "v %.17g %.17g 0\n", r * cos(t), r * sin(t) } }' >points.obj
{ cat points.obj; echo "l $(seq 1 48 | tr '\n' ' ')1"; } >curve.obj
printf 'v 0 0 0\nv 6 0 0\nv 6 5 0\nv 0 5 0\nl 1 2 3 4 1\n' >square.obj
run --fill square.obj --sides 6,5,6,5 -o filled.obj
[ $status -eq 0 ] && [ "$(counts filled.obj)" = "42 30" ] && pass || fail "--fill --sides: $(counts filled.obj), exit $status"
run --fill square.obj --sides 6,5,6,4 -o odd.obj
[ $status -eq 3 ] && [ ! -e odd.obj ] && grep -q "even" err.txt && pass || fail "an odd boundary exits with $status"
run --fill points.obj -o filled.obj
[ $status -eq 0 ] && pass || fail "--fill of vertices alone exits with $status: $(cat err.txt)"
cp filled.obj same.obj
run --fill curve.obj -o filled.obj
[ $status -eq 0 ] && cmp -s filled.obj same.obj && pass || fail "--fill of a polyline exits with $status: $(cat err.txt)"
run --fill grid.obj -o filled.obj
[ $status -eq 0 ] && [ "$(counts filled.obj)" = "81 64" ] && pass || fail "--fill of a mesh's boundary: $(counts filled.obj)"
run --fill square.obj --sides 6,5,6,5 -o filled.obj
run --fill filled.obj --sides 6,5,6,5 -o again.obj
[ $status -eq 0 ] && [ "$(counts again.obj)" = "42 30" ] && pass || fail "--fill of what was filled: $(counts again.obj), exit $status"
run --fill torus.obj -o none.obj
[ $status -eq 3 ] && grep -q "no curve" err.txt && pass || fail "--fill without a curve exits with $status"
run --fill curve.obj --lift 2 -o lifted.obj
[ $status -eq 0 ] && awk '$1 == "v" { if ($4 > z) z = $4; if ($4 < low) low = $4 } END { exit !(z > 1.99 && z < 2.01 && low > -0.1) }' \
    lifted.obj && pass || fail "--lift 2 exits with $status"
run --fill curve.obj --lift 2 --planar --fix boundary -o lifted.obj
measure lifted.obj lifted.obj
[ $status -eq 0 ] && pass || fail "--fill --lift --planar exits with $status"
want "--fill --lift --planar" planarity_after 1e-12
run torus.obj --lift 2 -o none.obj
[ $status -eq 3 ] && grep -q "needs a boundary" err.txt && pass || fail "--lift without a boundary exits with $status"

# A state: work in parts ends where work at once does; a wrong one is refused, and nothing is written.
run grid.obj -o whole.obj --planar --fairness 0.1
run grid.obj -o part.obj --planar --fairness 0.1 --time-limit 1e-9 --state work.state
[ $status -eq 1 ] && [ -s work.state ] && pass || fail "--state with --time-limit exits with $status"
run grid.obj -o part.obj --planar --fairness 0.1 --state work.state
[ $status -eq 0 ] && cmp -s whole.obj part.obj && pass || fail "work in parts is not what work at once is"
expect 3 "was written with --fairness 0.1; only" grid.obj -o new.obj --planar --state work.state
head -c 200 work.state >cut.state
expect 3 "state" grid.obj -o new.obj --planar --fairness 0.1 --state cut.state
[ "$(wc -c <cut.state)" -eq 200 ] && pass || fail "a refused state was written over"
for size in 20 40 50 60 61 62 63 64 65 66 67 68 69 70 71 72 80; do # in the list of what was asked for, and just behind it
    head -c $size work.state >cut.state
    run grid.obj -o new.obj --planar --fairness 0.1 --state cut.state
    [ $status -eq 3 ] && grep -q 'cut.state' err.txt || fail "a state of $size bytes exits with $status: $(head -n 1 err.txt)"
done
[ -e new.obj ] && fail "a cut state leaves a mesh" || pass
expect 2 "would overwrite" grid.obj -o new.obj --planar --state grid.obj

# In parts by iterations, too; then what is asked for is what was: other bounds, options or files are refused.
for part in 1 2 3 4 5 6 7 8; do
    run grid.obj -o part.obj --planar --fairness 0.1 --iterations 3 --state parts.state
    [ $status -eq 0 ] && break
    grep -q 'the iterations of this run are done' out.txt || fail "part $part by iterations does not say that it is one"
done
[ $part -gt 1 ] && [ $status -eq 0 ] && cmp -s whole.obj part.obj && pass || fail "work in parts of 3 iterations differs ($part)"
run grid.obj -o part.obj --edge-length 0.5, --planar --time-limit 1e-9 --state asked.state
run grid.obj -o part.obj --planar --edge-length 0.5, --threads 2 --report part.json --state asked.state
[ $status -eq 0 ] && pass || fail "another order of options, and outputs, with --state: $(head -n 1 err.txt)"
run grid.obj -o part.obj --planar --edge-length 0.5, --time-limit 1e-9 --state asked.state
expect 3 "with --edge-length 0.5,, not --edge-length 0.6,;" grid.obj -o new.obj --planar --edge-length 0.6, --state asked.state
expect 3 "without --nearest;" grid.obj -o new.obj --planar --edge-length 0.5, --nearest --state asked.state
expect 3 "without --tolerance 1e-9;" grid.obj -o new.obj --planar --edge-length 0.5, --tolerance 1e-9 --state asked.state
expect 3 "with --planar, not --planar=2;" grid.obj -o new.obj --planar=2 --edge-length 0.5, --state asked.state
{ cat grid.obj && echo '# later'; } >other.obj
expect 3 "before other.obj was changed;" other.obj -o new.obj --planar --edge-length 0.5, --state asked.state
{ printf 'guidedproj state 1\n' && cat asked.state; } >foreign.state
expect 3 "no state of this version" grid.obj -o new.obj --planar --edge-length 0.5, --state foreign.state
printf '0\n' >one.txt
run grid.obj -o part.obj --planar --fix one.txt --time-limit 1e-9 --state asked2.state
printf '0 # the first\n' >one.txt
expect 3 "before one.txt was changed;" grid.obj -o new.obj --planar --fix one.txt --state asked2.state
run grid.obj -o part.obj --planar --move 40,0,0,9 --time-limit 1e-9
awk '/^v / && ++n == 41 { exit !($4 < 5) }' part.obj && pass || fail "--time-limit does not end the drag of --move"

# In a problem file, too, all but outputs, limits and threads is what was, wherever it stands; a solve in parts is one attempt.
printf '{"input": "grid.obj", "planar": true, "iterations": 2, "coplanar": [{"vertices": [0, 8, 72]}]}' >state.json
run --problem state.json -o part.obj --state problem.state
[ $status -eq 1 ] && pass || fail "a part of a problem exits with $status"
printf '{\n"coplanar": [ {"vertices": [0, 8, 72]} ],\n"iterations": 99, "report": "part.json", "input": "grid.obj"}' >state.json
run --problem state.json -o part.obj --planar --state problem.state
[ $status -eq 0 ] && pass || fail "other limits in a problem file with --state: exits with $status, $(head -n 1 err.txt)"
printf '{"input": "grid.obj", "planar": true, "coplanar": [{"vertices": [0, 8, 73]}]}' >state.json
expect 3 "before state.json was changed;" --problem state.json -o new.obj --state problem.state
run twisted.obj -o whole2.obj --planar --circular --fix boundary --report whole.json
run twisted.obj -o part.obj --planar --circular --fix boundary --report part.json --state twisted.state
[ "$(awk '/"attempts"/ { print $2 + 0 }' whole.json)" -gt 1 ] && grep -q '"attempts": 1,' part.json && pass ||
    fail "attempts with --state: $(grep -h '"attempts"' whole.json part.json | tr '\n' ' ')"
rm -f twisted.state
run twisted.obj -o part.obj --planar --circular --fix boundary --iterations 1 --report part.json --state twisted.state
grep -q '"outcome": "time out"' part.json && "$tool" --help | tr -s ' \n' ' ' | grep -q 'the outcome "time out" in --report' && pass ||
    fail "--help and the report differ about the outcome of a part: $(grep '"outcome"' part.json)"

# A solve that has ended stays as it is: a further run takes no step, and gives the same verdict, mesh and residuals.
for part in whole again; do
    run grid.obj -o $part.obj --planar --fairness 0.1 --state ended.state --residuals $part.csv --report $part.json
    [ $status -eq 0 ] && grep '^all constraints' out.txt >$part.txt && pass || fail "$part solve with --state exits with $status"
done
cmp -s whole.obj again.obj && cmp -s whole.txt again.txt && pass || fail "an ended solve goes on"
grep -q '"outcome": "converged"' again.json && [ "$(wc -l <again.csv)" -gt 10 ] && pass || fail "what an ended solve reports"
: >failed.txt
for part in 1 2 3 4; do
    run grid.obj -o again.obj --planar --fix boundary --edge-length 5,5 --state failed.state --iterations 60
    [ $status -eq 1 ] || fail "an impossible solve in parts exits with $status"
    sed -n 2p out.txt >>failed.txt
done
[ "$(sort -u failed.txt | wc -l)" -lt 4 ] && tail -n 1 failed.txt | grep -q 'no step makes\|the iterations ran out' && pass ||
    fail "an impossible solve in parts has no end: $(tail -n 1 failed.txt)"
run grid.obj -o part.obj --planar --fix 0,8,72,80 --free 0 --state free.state --iterations 2
expect 3 "with --free 0, not --free 8;" grid.obj -o new.obj --planar --fix 0,8,72,80 --free 8 --state free.state

# A solve that has not reached its end still leaves its outputs, but for panels that cannot be laid flat.
rm -f panels.svg part.obj panels.state
run grid.obj -o part.obj --planar --panels panels.svg --iterations 1 --state panels.state
[ $status -eq 1 ] && [ -s part.obj ] && [ -s panels.state ] && [ ! -e panels.svg ] && grep -q 'panels.svg is not written: face' err.txt &&
    pass || fail "panels of an unfinished solve: exits with $status, $(head -n 1 err.txt)"
run grid.obj -o part.obj --planar --panels $'line\nand\e[31m.svg' --iterations 1
grep -q '^guidedproj: line?and?\[31m.svg is not written: face' err.txt && pass || fail "a name with control characters: $(cat -v err.txt)"
printf 'old\n' >panels.svg
run grid.obj -o part.obj --planar --panels panels.svg --iterations 1
grep -q 'panels.svg is not written, and what is there belongs to an earlier mesh: face' err.txt && pass ||
    fail "panels of before: $(head -n 1 err.txt)"
rm -f panels.svg
run grid.obj -o part.obj --planar --tolerance 0.5 --fairness 0.1 --time-limit 1e-9
[ $status -eq 0 ] && grep -q 'note: all that must hold holds' out.txt && pass || fail "all holds as the time runs out: $status"

# Only the input may be replaced by the output.
cp grid.obj other.obj
expect 2 "would overwrite the input 'other.obj'" grid.obj -o other.obj --planar --glide other.obj
expect 2 "would overwrite the input 'other.obj'" grid.obj -o other.obj --planar --reference other.obj
run other.obj -o other.obj --planar --glide other.obj
[ $status -eq 0 ] && pass || fail "the input is replaced, and glides along itself: $(head -n 1 err.txt)"

awk 'BEGIN { for (i = 0; i < 12; i++) printf "v %.17g %.17g 0\n", cos(i * 0.5235987755982988), sin(i * 0.5235987755982988)
    print "l 1 2 3 4 5 6 7 8 9 10 11 12 1" }' >ring.obj
expect 2 "would overwrite the input 'ring.obj'" --fill ring.obj -o ring.obj --planar

# A byte order mark is no part of a list; a weight of 0 asks for nothing; loads say something; a title is well-formed XML.
printf '\357\273\2770,8 # by an editor\n' >marked.txt
run grid.obj -o part.obj --planar --fix marked.txt
[ $status -eq 0 ] && pass || fail "a byte order mark before a list: $(head -n 1 err.txt)"
run grid.obj -o part.obj --planar --fix corners --move 40,0,0,9=0
run grid.obj -o whole.obj --planar --fix corners
cmp -s part.obj whole.obj && pass || fail "--move with the weight 0 moves something"
printf '0\r# the second\r8,99\r' >cr.txt # lines end as on old Macs
expect 3 "there is no vertex 99" grid.obj -o new.obj --planar --fix cr.txt
printf '# nothing\n' >none.csv
expect 3 "none.csv, line 1: there are no loads in it" grid.obj -o new.obj --equilibrium --loads none.csv
expect 3 "loads" grid.obj -o new.obj --equilibrium --fix boundary --density 1e300 --picture new.svg
grep -q 'no error' err.txt && fail "an error that is none" || pass
expect 2 "--circular is for planar faces" grid.obj -o new.obj --circular
expect 2 "--gauss needs the normals of planar faces" grid.obj -o new.obj --gauss 0.1 --planar=0
expect 3 "--lift 1e+50 cannot be done: " grid.obj -o new.obj --planar --lift 1e50
run grid.obj -o part.obj --planar --picture title.svg --title "$(printf 'a\377b \303\274 <')"
LC_ALL=C grep -q "a?b $(printf '\303\274') &lt;" title.svg && pass || fail "a title that is not UTF-8"

# Files of forces and loads say something.
: >none.csv
expect 3 "none.csv: no line edge,I,J,W" grid.obj -o new.obj --equilibrium --start-forces none.csv
expect 3 "grid.obj:1: expected edge,I,J,W" grid.obj -o new.obj --equilibrium --start-forces grid.obj
(ulimit -f 1 2>/dev/null && "$tool" grid.obj -o large.obj --planar --quiet) >out.txt 2>err.txt
status=$?
[ $status -eq 3 ] && grep -q 'large.obj' err.txt && ! ls large.obj ./*.tmp >/dev/null 2>&1 && pass ||
    fail "a file that grows too large: exits with $status, $(head -n 1 err.txt)"

printf '# corners\n0, 8\n72 80 # the last\n' >corners.txt
for fix in boundary corners 0,8,72,80 corners.txt 0-8,72=2; do
    run grid.obj -o fixed.obj --planar --fix $fix --iterations 30
    measure grid.obj fixed.obj
    case $fix in
    boundary | corners | corners.txt | 0,8,72,80) want "--fix $fix" corners 1e-9 ;;
    esac
    [ "$fix" = boundary ] && want "--fix boundary" boundary 1e-9
done
run grid.obj -o moved.obj --planar --fix corners --move 40,4,4,1.5 --move 0,-0.25,0,0 --iterations 30
awk 'NR == 41 { good = ($2-4)^2 + ($3-4)^2 + ($4-1.5)^2 < 1e-18 } NR == 1 { first = ($2+0.25)^2 + $3^2 + $4^2 < 1e-18 }
    END { exit !(good && first) }' moved.obj && pass || fail "--move"
run grid.obj -o gliding.obj --planar --glide boundary --move 4,-0.2,4,0.5 --iterations 30
awk 'NR == 5 { exit !(($2+0.2)^2 + ($3-4)^2 + ($4-0.5)^2 < 1e-18) }' gliding.obj && pass ||
    fail "--move of a gliding vertex"
# A corner that is free moves, and nothing else of the boundary; where it glides, circular faces need that in a sheared grid.
run grid.obj -o free.obj --planar --fix boundary --free 8 --iterations 30
awk '$1 == "v" && NR == FNR { x[++n] = $2; y[n] = $3; z[n] = $4 }
    $1 == "v" && NR > FNR { m++; i = (m - 1) % 9; j = (m - 1 - i) / 9; d = ($2-x[m])^2 + ($3-y[m])^2 + ($4-z[m])^2
        if (m == 9) freed = d > 1e-12; else if (i % 8 == 0 || j % 8 == 0) held += d < 1e-18 }
    END { exit !(freed && held == 31) }' grid.obj free.obj && pass || fail "--fix boundary --free 8"
awk 'BEGIN { for (j = 0; j < 8; j++) for (i = 0; i < 8; i++) print "v", i + 0.3 * j, j, i * (7 - i) * j * (7 - j) / 400
    for (j = 0; j < 7; j++) for (i = 1; i < 8; i++) print "f", 8 * j + i, 8 * j + i + 1, 8 * j + i + 9, 8 * j + i + 8 }' >sheared.obj
run sheared.obj -o free.obj --planar --circular --glide boundary --free 7
[ $status -eq 0 ] && pass || fail "--glide boundary --free 7: $status"
run sheared.obj -o free.obj --planar --circular --glide boundary
[ $status -eq 1 ] && grep -q "the sums differ by 67 degrees" out.txt err.txt && pass || fail "angles of a sheared boundary: $status"
expect 2 "vertex 3 is held by no --fix and --glide" grid.obj -o new.obj --planar --free 3
expect 2 "vertex 40 is held by no --fix and --glide" grid.obj -o new.obj --planar --glide boundary --free 8,40
expect 2 "--free lets all of these go" grid.obj -o new.obj --planar --fix 5,8 --free 8,5
expect 2 "this names no vertex" grid.obj -o new.obj --planar --fix 5 --free ''
expect 2 "there is no vertex 81" grid.obj -o new.obj --planar --fix boundary --free 81
awk -v h=0.6 "$height"'BEGIN {
    for (k = 0; k < 32; k++) {
        if (k < 8) { i = k; j = 0 } else if (k < 16) { i = 8; j = k - 8 }
        else if (k < 24) { i = 24 - k; j = 8 } else { i = 0; j = 32 - k }
        printf "v %.17g %.17g %.17g\n", i, j, z(i, j)
        s = s " " (k + 1)
    }
    print "l" s " 1" }' >curve.obj
run grid.obj -o curve-out.obj --planar --glide curve.obj=1 --fairness '0.1*0.9'
[ $status -eq 0 ] && pass || fail "--glide CURVE exits with $status: $(tail -n 1 err.txt)"
measure grid.obj curve-out.obj
want "--glide CURVE" boundary 1e-9
want "--glide CURVE" corners 1e-9
# sizes FILE: shortest and longest edge, smallest and largest face, length of all edges, area of all faces
sizes() {
    awk 'function far(a, b) { return sqrt((x[a]-x[b])^2 + (y[a]-y[b])^2 + (z[a]-z[b])^2) }
        $1 == "v" { n++; x[n] = $2; y[n] = $3; z[n] = $4 }
        $1 == "f" {
            u = v = w = 0
            for (i = 2; i <= NF; i++) {
                a = $i; b = i < NF ? $(i+1) : $2; key = a < b ? a " " b : b " " a
                u += (y[a]*z[b] - z[a]*y[b]) / 2; v += (z[a]*x[b] - x[a]*z[b]) / 2; w += (x[a]*y[b] - y[a]*x[b]) / 2
                if (key in seen) continue
                seen[key] = 1; e = far(a, b); sum += e
                if (emin == "" || e < emin) emin = e
                if (e > emax) emax = e
            }
            f = sqrt(u*u + v*v + w*w); area += f
            if (fmin == "" || f < fmin) fmin = f
            if (f > fmax) fmax = f
        }
        END { printf "%.12g %.12g %.12g %.12g %.12g %.12g\n", emin, emax, fmin, fmax, sum, area }' "$1"
}
holds() { # holds WHAT CONDITION FILE: the condition on e0 e1 (edges), f0 f1 (faces), l, a (totals), t = 1e-9
    sizes "$3" | awk '{ e0 = $1; e1 = $2; f0 = $3; f1 = $4; l = $5; a = $6; t = 1e-9; exit !('"$2"') }' && pass ||
        fail "$1: $(sizes "$3")"
}
run grid.obj -o sized.obj --planar --edge-length 0.98,1.12
[ $status -eq 0 ] && pass || fail "--edge-length exits with $status: $(tail -n 1 err.txt)"
holds "--edge-length 0.98,1.12" 'e0 > 0.98 - t && e1 < 1.12 + t' sized.obj
run grid.obj -o sized.obj --planar --edge-length ,1.05=2 --face-area 0.9, --iterations 30
[ $status -eq 0 ] && pass || fail "--edge-length and --face-area exit with $status: $(tail -n 1 err.txt)"
holds "--edge-length and --face-area" 'e1 < 1.05 + t && f0 > 0.9 - t' sized.obj
run grid.obj -o sized.obj --planar --equal-lengths --iterations 30
[ $status -eq 0 ] && pass || fail "--equal-lengths exits with $status: $(tail -n 1 err.txt)"
holds "--equal-lengths" 'e1 - e0 < t && e0 > 0.5' sized.obj
run grid.obj -o sized.obj --planar --total-area 70
[ $status -eq 0 ] && pass || fail "--total-area exits with $status: $(tail -n 1 err.txt)"
holds "--total-area" 'a > 70 - t && a < 70 + t' sized.obj
before=$(sizes grid.obj)
run grid.obj -o sized.obj --planar --total-area x1.1
holds "--total-area x1.1" 'a > 1.1 * '"${before##* }"' - 1e-8 && a < 1.1 * '"${before##* }"' + 1e-8' sized.obj
run grid.obj -o sized.obj --planar --cost 2,3,450 --report cost.json
[ $status -eq 0 ] && pass || fail "--cost exits with $status: $(tail -n 1 err.txt)"
holds "--cost" '2 * l + 3 * a < 450 + 1e-8 && 2 * l + 3 * a > 440' sized.obj
grep -q '"cost": 4[45]' cost.json && pass || fail "the report does not tell the cost"
grep -q '"volume": [0-9-]' cost.json && pass || fail "the report does not tell the volume"
run grid.obj -o sized.obj --planar --cost 2,3,x0.95
[ $status -eq 0 ] && pass || fail "--cost x0.95 exits with $status: $(tail -n 1 err.txt)"
run grid.obj -o sized.obj --fix boundary --edge-length 3,
[ $status -eq 1 ] && grep -q 'length bounds\|fixed' err.txt out.txt && pass || fail "bounds that cannot hold: $status"

run grid.obj -o all.obj --planar --glide boundary --fairness 0.1 --tangential '0.01*0.9:5' --gauss 0.01 \
    --boundary-fairness=0.01 --closeness 0.01 --epsilon 1e-3 --iterations 40 --tolerance 1e-9
[ $status -eq 0 ] && pass || fail "all wishes together exit with $status: $(tail -n 1 err.txt)"
for option in planar-boundary straight-boundary orthogonal-boundary lifting; do
    run grid.obj -o $option.obj --planar --$option --iterations 30 --report $option.json
    [ $status -eq 0 ] && grep -q "\"${option/-/ }\"" $option.json && pass || fail "--$option: $(tail -n 1 err.txt)"
done
for view in iso top bottom front back left right side 30,20 -120.5,-10; do
    run grid.obj -o view.obj --planar --picture view.svg --view $view
    [ $status -eq 0 ] && [ "$(grep -c '<path' view.svg)" -ge 64 ] && pass || fail "--view $view"
done

for colour in planarity area parallelogram bend; do
    run grid.obj -o colour.obj --planar --picture colour-$colour.svg --colour $colour
    [ $status -eq 0 ] && [ "$(grep -c '<path' colour-$colour.svg)" -ge 64 ] && pass || fail "--colour $colour"
done
# Thin triangles around one vertex: each is in few of the cells that its box has (else this takes minutes).
awk 'BEGIN { n = 6000; print "v 0 0 1"; for (i = 0; i < n; i++) printf "v %.9f %.9f 0\n", cos(6.28318530718 * i / n), sin(6.28318530718 * i / n)
    for (i = 0; i < n; i++) print "f 1", i + 2, (i + 1) % n + 2 }' >hub.obj
timeout 60 "$tool" hub.obj -o new.obj --fix 0 --closeness 0 --picture hub.svg --quiet && [ "$(grep -c '<path d' hub.svg)" -ge 6000 ] && pass ||
    fail "a picture of a hub with many triangles"
rm -f new.obj
run grid.obj -o titled.obj --planar --picture titled.svg --title 'Flat & <fair>'
grep -q '<title>Flat &amp; &lt;fair&gt;</title>' titled.svg && pass || fail "--title"
grep -q 'areas of the faces' colour-area.svg && pass || fail "--colour area has no legend"
cmp -s <(grep '<path d' colour-area.svg) <(grep '<path d' colour-planarity.svg) &&
    fail "--colour area colours like planarity" || pass
run grid.obj -o drawn.obj --fix 0 --closeness 0 --picture drawn.svg # holds already
[ $status -eq 0 ] && ! grep -q 'before (line)' drawn.svg && pass || fail "a mesh that holds already has a before"
measure grid.obj drawn.obj
want "a mesh that holds already" displacement_max 0

# ---- statics ----

vault() { # vault N H: a noisy vault of N x N quads over a square, its edges on the ground
    awk -v n="$1" -v h="$2" 'BEGIN {
        for (i = 0; i <= n; i++) for (j = 0; j <= n; j++) { x = 2 * i / n - 1; y = 2 * j / n - 1
            printf "v %.17g %.17g %.17g\n", i, j, h * (1 - x * x) * (1 - y * y) * (1 + 0.1 * sin(5 * i + 3 * j)) }
        for (i = 0; i < n; i++) for (j = 0; j < n; j++)
            print "f", i*(n+1)+j+1, (i+1)*(n+1)+j+1, (i+1)*(n+1)+j+2, i*(n+1)+j+2 }'
}
# From mesh and forces alone: the largest |sum w (v_i - v_j) + load| over the largest load, least and largest w, supports.
statics() { # statics MESH.obj FORCES.csv
    awk -F'[ ,]' 'FNR == NR { if ($1 == "v") { for (k = 0; k < 3; k++) p[n + 0, k] = $(k + 2); n++ } next }
        $1 == "edge" { if (!edges++ || $4 < low) low = $4; if (edges == 1 || $4 > high) high = $4
            for (k = 0; k < 3; k++) { d = $4 * (p[$2, k] - p[$3, k]); s[$2, k] += d; s[$3, k] -= d } }
        $1 == "load" { for (k = 0; k < 3; k++) { s[$2, k] += $(k + 3); m += $(k + 3)^2 }
            if (m > most) most = m; m = 0 }
        $1 == "support" { held[$2] = 1; supports++ }
        END { for (i = 0; i < n; i++) if (!(i in held)) { m = s[i, 0]^2 + s[i, 1]^2 + s[i, 2]^2; if (m > worst) worst = m }
            printf "%.3g %.17g %.17g %d %d\n", sqrt(worst / most), low, high, supports, edges }' "$1" "$2"
}
balanced() { # balanced NAME CONDITION: of r (residual), low, high, supports, edges
    statics new.obj forces.csv >statics.txt
    [ $status -eq 0 ] && awk '{ r = $1; low = $2; high = $3; supports = $4; edges = $5; exit !(r <= 1e-9 && ('"$2"')) }' \
        statics.txt && pass || fail "$1: status $status, $(cat statics.txt), $(tail -n 1 err.txt)"
}
vault 8 3 >vault.obj
run vault.obj -o new.obj --planar --equilibrium --compressive --forces forces.csv --report new.json --picture new.svg
balanced "own weight" 'low >= -1e-9 * high && high > 0 && supports == 32 && edges == 144'
measure vault.obj new.obj
want "own weight" planarity_after 1e-9
head -n 1 forces.csv | grep -q '^kind,' && pass || fail "the forces have no heading"
grep -q '"equilibrium_residual"' new.json && grep -q '"load_path"' new.json && pass || fail "the report has no forces"
grep -q 'stroke-width' new.svg && grep -q '^equilibrium' out.txt && pass || fail "picture and summary of forces"
run vault.obj -o new.obj --equilibrium --compressive --area-load 2 --fix boundary --forces forces.csv --picture new.svg
balanced "area load" 'low >= -1e-9 * high'
grep -q 'best forces' new.svg && pass || fail "the picture does not tell how self-supporting the mesh is"
run vault.obj -o new.obj --equilibrium --compressive --snow 1 --density 0.2 --glide boundary --forces forces.csv
balanced "snow" 'low >= -1e-9 * high'
run vault.obj -o new.obj --equilibrium --forces forces.csv --supports corners --fix corners
balanced "four supports" 'supports == 4'
awk -F, '$1 == "load" || $1 == "support" { for (k = 0; k < 3; k++) sum[k] += $(k + 3); most += $5 < 0 ? -$5 : $5 }
    END { for (k = 0; k < 3; k++) bad += sum[k] > 1e-8 * most || sum[k] < -1e-8 * most; exit bad > 0 || most == 0 }' forces.csv &&
    pass || fail "reactions and loads do not add up to nothing"
awk '/^v / { $4 = -$4 } { print }' vault.obj >net.obj
run net.obj -o new.obj --equilibrium --tensile --fix boundary --forces forces.csv
balanced "hanging net" 'high <= -1e-9 * low'
printf 'vertex,fx,fy,fz\n40,0,0,-5 # the middle\n\n20,1,0,-1\n' >loads.csv
run vault.obj -o new.obj --equilibrium --density 1 --loads loads.csv --fix boundary --forces forces.csv
balanced "point loads" 'edges == 144'
grep -q '^load,20,1,0,' forces.csv && pass || fail "the load on vertex 20: $(grep '^load,20,' forces.csv)"
run vault.obj -o new.obj --equilibrium --stress 0.4,6 --fix boundary --forces forces.csv --force-fairness=0.1
balanced "bounds on forces" '1'
awk -F'[ ,]' 'FNR == NR { if ($1 == "v") { for (k = 0; k < 3; k++) p[n + 0, k] = $(k + 2); n++ } next }
    $1 == "support" { held[$2] = 1 } $1 == "edge" { a[++c] = $2; b[c] = $3; w[c] = $4 }
    END { for (i = 1; i <= c; i++) { if (a[i] in held && b[i] in held) continue; l = 0
        for (k = 0; k < 3; k++) l += (p[a[i], k] - p[b[i], k])^2
        f = w[i] * sqrt(l); if (f < 0.4 - 1e-8 || f > 6 + 1e-8) bad++ } exit bad > 0 }' new.obj forces.csv && pass ||
    fail "--stress 0.4,6 is not kept"
awk '/^v / { printf "v %.17g %.17g %.17g\n", 1000 * $2, 1000 * $3, 1000 * $4; next } { print }' vault.obj >mm.obj
run vault.obj -o m.obj --planar --equilibrium --compressive --density 1
run mm.obj -o mm_new.obj --planar --equilibrium --compressive --density 7.5
awk 'FNR == NR { if ($1 == "v") { for (k = 2; k < 5; k++) p[n + 0, k] = $k; n++ } next }
    $1 == "v" { for (k = 2; k < 5; k++) { d = $k / 1000 - p[m + 0, k]; if (d < 0) d = -d; if (d > worst) worst = d }; m++ }
    END { exit !(worst < 1e-8) }' m.obj mm_new.obj && pass || fail "mm and other weights give another shape"
awk '/^v / { $4 = 0 } { print }' vault.obj >flat.obj
run flat.obj -o new.obj --equilibrium --fix 0-80
[ $status -eq 1 ] && grep -q 'no equilibrium was found near this shape: vert' out.txt && pass ||
    fail "a fixed plate: status $status, $(cat out.txt)"
rm -f new.obj new.json new.svg
expect 2 "--compressive is about forces: add --equilibrium" vault.obj -o new.obj --planar --compressive
expect 2 "--snow is about forces: add --equilibrium" vault.obj -o new.obj --planar --snow 0 --forces new.json
expect 2 "add --equilibrium" vault.obj -o new.obj --planar --forces new.json
expect 2 "expected MIN,MAX" vault.obj -o new.obj --equilibrium --stress 3,1
expect 2 "expected a number" vault.obj -o new.obj --equilibrium --density heavy
expect 2 "there is no vertex 81" vault.obj -o new.obj --equilibrium --supports 81
expect 2 "there is no support" torus.obj -o new.obj --equilibrium
printf '3,0,0,-1\n99,0,0,-1\n' >bad.csv
expect 3 "bad.csv, line 2: there is no vertex 99" vault.obj -o new.obj --equilibrium --loads bad.csv
printf '3,0,0\n' >bad.csv
expect 3 "bad.csv, line 1: expected VERTEX,FX,FY,FZ" vault.obj -o new.obj --equilibrium --loads bad.csv
expect 2 "would overwrite the input" vault.obj -o new.obj --equilibrium --loads loads.csv --forces loads.csv
printf 'load,24,0,0,-1\n' >bad.csv # a line of --forces, and no heading
expect 3 "bad.csv, line 1: expected VERTEX,FX,FY,FZ" vault.obj -o new.obj --equilibrium --loads bad.csv
printf '\357\273\277vertex,fx,fy,fz\r\n40 ,\t0, 0 ,-5\r\n20,1,0,-1\r\n' >marked.csv # as spreadsheets write it
run vault.obj -o new.obj --equilibrium --density 1 --loads marked.csv --fix boundary --forces forces.csv
balanced "loads from a spreadsheet" 'edges == 144'
expect 2 "names no vertex" vault.obj -o new.obj --equilibrium --supports ,
expect 2 "the mesh has no boundary" closed.obj -o new.obj --equilibrium --supports boundary
printf '0\n# and\n999\n' >far.txt
expect 3 "far.txt: line 3: there is no vertex 999" vault.obj -o new.obj --planar --fix far.txt
printf '0\n1 b\n' >far.txt
expect 3 "far.txt: line 2: expected vertices" vault.obj -o new.obj --planar --fix far.txt

# ---- offsets ----

moulding() { # moulding N M: an arch of M quads along a bent road of N, with ripples
    awk -v n="$1" -v m="$2" 'BEGIN {
        for (i = 0; i <= n; i++) {
            for (j = 0; j <= m; j++) { v = 2.2 * j / m - 1.1; s = 1 + 0.02 * sin(0.8 * i + 0.9 * j); r = 5 * s * sin(v)
                printf "v %.17g %.17g %.17g\n", x - r * sin(t), y + r * cos(t), 4 * s * cos(v) }
            x += cos(t); y += sin(t); t += 0.05 + 0.04 * sin(0.3 * i) }
        for (i = 0; i < n; i++) for (j = 0; j < m; j++)
            print "f", i*(m+1)+j+1, (i+1)*(m+1)+j+1, (i+1)*(m+1)+j+2, i*(m+1)+j+2 }'
}
# How far V + D * x is from an offset: distances of the corners of its faces (or of the vertices) along the normals.
distances() { # distances MESH OFFSET faces|vertices: prints the least and the largest
    awk -v kind="$3" '/^v / { n[FILENAME]++; for (k = 0; k < 3; k++) p[FILENAME, n[FILENAME], k] = $(k + 2) }
        FNR == NR && /^f / { f++; d[f] = NF - 1; for (k = 1; k < NF; k++) c[f, k - 1] = $(k + 1) }
        function note(x) { if (low == "" || x < low) low = x; if (high == "" || x > high) high = x }
        END { a = ARGV[1]; b = ARGV[2]
            for (i = 1; kind == "vertices" && i <= n[a]; i++) { s = 0
                for (k = 0; k < 3; k++) s += (p[b, i, k] - p[a, i, k])^2
                note(sqrt(s)) }
            for (i = 1; kind == "faces" && i <= f; i++) {
                for (k = 0; k < 3; k++) { u[k] = p[a, c[i, 2], k] - p[a, c[i, 0], k]; w[k] = p[a, c[i, 3], k] - p[a, c[i, 1], k] }
                for (k = 0; k < 3; k++) m[k] = u[(k+1)%3] * w[(k+2)%3] - u[(k+2)%3] * w[(k+1)%3]
                l = sqrt(m[0]^2 + m[1]^2 + m[2]^2)
                for (j = 0; j < d[i]; j++) { s = 0
                    for (k = 0; k < 3; k++) s += m[k] / l * (p[b, c[i, j], k] - p[a, c[i, j], k])
                    note(s) } }
            printf "%.17g %.17g\n", low, high }' "$1" "$2"
}
between() { # between NAME KIND DISTANCE: the offset is exact to 1e-9, the support is planar
    distances shaped.obj offset.obj "$2" >distances.txt
    awk -v d="$3" '{ exit !($1 > d - 1e-9 && $2 < d + 1e-9) }' distances.txt && pass ||
        fail "$1: the distances are $(cat distances.txt)"
    measure support.obj support.obj
    want "$1: support" planarity_after 1e-9
    [ "$(grep -c '^f ' support.obj)" = "$(sed -n 's/.*vertices, \([0-9]*\) edges.*/\1/p' out.txt)" ] && pass ||
        fail "$1: not one quad an edge in the support"
    grep -q "^offset  *$2 at distance" out.txt && pass || fail "$1: no sentence about the offset"
}
moulding 16 8 >moulding.obj
run moulding.obj -o shaped.obj --planar --conical --offset 0.25,offset.obj --support support.obj --report offset.json
[ $status -eq 0 ] && pass || fail "--conical exits with $status: $(tail -n 1 err.txt)"
between "face offset" faces 0.25
grep -q '"name": "conicality"' offset.json && grep -q '"kind": "faces"' offset.json && pass || fail "report of the offset"
awk -F'[:,]' '/"conicality_max"/ { last = $2 } END { exit !(last != "" && last + 0 < 1e-9) }' offset.json && pass ||
    fail "the report's conicality"
run moulding.obj -o shaped.obj --planar --conical --offset=-0.25,offset.obj --support support.obj
between "face offset inwards" faces -0.25
run moulding.obj -o shaped.obj --planar --circular --offset 0.25,offset.obj --support support.obj
[ $status -eq 0 ] && pass || fail "--circular exits with $status: $(tail -n 1 err.txt)"
between "vertex offset" vertices 0.25
run moulding.obj -o shaped.obj --planar --conical=0 --offset 0.25,offset.off
[ $status -eq 0 ] && head -n 1 offset.off | grep -q OFF && pass || fail "an offset of a mesh that is not conical, as OFF"
run moulding.obj -o shaped.obj --planar --conical --offset 30,offset.obj
grep -q "run backwards" out.txt && pass || fail "edges that run backwards are not told"
rm -f offset.off support.obj
[ "$(ls ./*.tmp 2>/dev/null)" = "" ] && pass || fail "temporary files stay"

# ---- little memory: it works or says so, and never leaves half an output ----

if [[ $tool != *coverage* ]] && { (ulimit -v 1000000 && "$tool" --version) >/dev/null; } 2>/dev/null; then
    for limit in $(seq 4000 500 16000); do
        rm -f low.obj
        {
            (ulimit -v $limit && "$tool" torus.obj -o low.obj --planar --reference big.obj --report low.json \
                --picture low.svg --allow-spoiled) >out.txt 2>err.txt
            status=$?
        } 2>/dev/null
        case $status in
        0) [ -s low.obj ] && pass || fail "with $limit KB: exit 0 without an output" ;;
        4) grep -qE "out of memory|too large for the memory" err.txt && [ ! -e low.obj ] && pass || fail "with $limit KB: $(cat err.txt)" ;;
        127) pass ;; # not even the program could be loaded
        *) fail "with $limit KB it exits with $status: $(tail -n 1 err.txt)" ;;
        esac
    done
else
    skip "little memory (the limit cannot be set for this build)"
fi

# ---- units and place: the same shape to 1e-8 mean edges ----

transform() { # transform SCALE SHIFT MESH
    awk -v s="$1" -v x="$2" '/^v / { printf "v %.17g %.17g %.17g\n", $2*s+x, $3*s, $4*s; next } { print }' "$3"
}
same_shape() { # same_shape NAME A B
    ./check_mesh "$2" "$3" >measures.txt
    want "$1" displacement_max 1e-8
}
units() { # units NAME MESH OPTIONS...
    local name=$1 mesh=$2
    shift 2
    run "$mesh" -o unit.obj "$@"
    for s in 0.001 1000; do
        transform $s 0 "$mesh" >scaled.obj
        run scaled.obj -o scaled-out.obj "$@"
        transform "$(awk -v s=$s 'BEGIN { print 1 / s }')" 0 scaled-out.obj >back.obj
        same_shape "$name times $s" unit.obj back.obj
    done
    transform 1 100000 "$mesh" >moved.obj
    run moved.obj -o moved-out.obj "$@"
    transform 1 -100000 moved-out.obj >back.obj
    same_shape "$name moved" unit.obj back.obj
    awk '/^v / { printf "v %s %s %s\n", $3, $4, $2; next } { print }' "$mesh" >turned.obj # a rotation by 120 degrees
    run turned.obj -o turned-out.obj "$@"
    awk '/^v / { printf "v %s %s %s\n", $4, $2, $3; next } { print }' turned-out.obj >back.obj
    same_shape "$name turned" unit.obj back.obj
}
units grid grid.obj --planar
units "gliding grid" grid.obj --planar --glide boundary --fairness '0.2*0.9'
units torus torus.obj --planar
units moulding moulding.obj --planar --conical

# ---- real meshes ----

planar_only() { # planar_only NAME MEAN_DISPLACEMENT_OF_A_PLAIN_IMPLEMENTATION
    local mesh=$data/$1.obj
    run "$mesh" -o real.obj --planar --iterations 12
    [ $status -eq 0 ] && pass || fail "$1 --planar exits with $status: $(tail -n 1 out.txt)"
    measure "$mesh" real.obj
    [ "$(value same_connectivity)" = 1 ] && pass || fail "$1 --planar: the connectivity changed"
    want "$1 --planar" planarity_after 1e-12
    [ "$1" = hypar ] || want "$1 --planar" turned 0
    want "$1 --planar" displacement_mean "$(awk -v d="$2" 'BEGIN { print 1.6 * d }')" # smooth steps move farther
    run "$mesh" -o real.obj --planar --iterations 10 --closeness 0
    measure "$mesh" real.obj
    want "$1 --planar --closeness 0, 10 iterations" planarity_after 1e-12
}
faired() { # faired NAME
    local mesh=$data/$1.obj
    run "$mesh" -o real.obj --planar --reference "$mesh=0.1" --glide boundary --fairness '0.2*0.9' --iterations 12
    [ $status -eq 0 ] && pass || fail "$1 faired exits with $status: $(tail -n 1 out.txt)"
    measure "$mesh" real.obj
    want "$1 faired" planarity_after 1e-9
    want "$1 faired" boundary 1e-9
    want "$1 faired" corners 1e-9
    want "$1 faired" folded_after "$(value folded_before)"
    want "$1 faired" turned 0
}
if [ -r "$data/Intersection.obj" ]; then
    while read -r name displacement; do
        planar_only "$name" "$displacement"
    done <<'TABLE'
6-sub-lifted 1.23e-4
Intersection 0.0434
M2_eq_quad2 0.630
YasIsland 3.76e-4
botanic-garden 0.0882
eyeye_circular 0.147
formfinding-circular 9.0e-6
free_negshell 5.19e-3
heart 0.379
hypar 0.937
quad_dome 9.4e-3
tubemesh 0.137
hexagonalminimal 1e-9
TABLE
    for name in Intersection YasIsland botanic-garden free_negshell; do faired $name; done
    for name in eyeye_circular formfinding-circular; do
        # (a ring has an offset only where that closes around the hole: by the shortest way these do)
        run "$data/$name.obj" -o shaped.obj --planar --circular --closeness 0 --offset 0.01,offset.obj --support support.obj
        [ $status -eq 0 ] && pass || fail "$name --circular exits with $status: $(tail -n 1 err.txt)"
        between "$name" vertices 0.01
    done
    units "botanic-garden" "$data/botanic-garden.obj" --planar
    for n in 1 2 5; do
        run "$data/Intersection.obj" -o "real$n.obj" --planar --threads $n
        cmp -s real1.obj "real$n.obj" && pass || fail "Intersection: $n threads give different bytes"
    done
else
    skip "real meshes (there is no $data/Intersection.obj; set GPROJ_DATA)"
fi

echo "$passed passed, $failed failed, $skipped skipped"
[ "$failed" -eq 0 ]
