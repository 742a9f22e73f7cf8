#!/bin/bash
# test_panels.sh - panels that the command line lays flat: test_panels.py reads them back and compares them with the mesh in
# space; here are refusals, of which each leaves no output.
#
#     TOOL=../tools/guidedproj ./test_panels.sh

. "$(dirname "$0")/tool.sh"
[ -x "$tool" ] || { echo "there is no tool at $tool: build it first, or set TOOL"; exit 2; }
cd "$work" || exit 2

# ---- meshes: a roof, a torus of revolution (circular and conical), one face with a notch ----

cp "$here/../examples/roof.obj" roof.obj
"$tool" roof.obj -o flat.obj --planar --fix corners --quiet || fail "the roof"
awk 'BEGIN {
    t = 6.283185307179586
    for (i = 0; i < 16; i++) for (j = 0; j < 8; j++) { u = t * i / 16; v = t * (j + 0.3) / 8; r = 3 + cos(v)
        printf "v %.17g %.17g %.17g\n", r * cos(u), r * sin(u), sin(v) }
    for (i = 0; i < 16; i++) for (j = 0; j < 8; j++) { k = (i + 1) % 16; l = (j + 1) % 8
        print "f", i*8+j+1, k*8+j+1, k*8+l+1, i*8+l+1 } }' >torus.obj
awk 'BEGIN { # the top of a box, its walls, and a lid with a notch beside it
    print "v 0 0 0\nv 4 0 0\nv 4 3 0\nv 0 3 0\nv 0 0 2\nv 4 0 2\nv 4 3 2\nv 0 3 2"
    print "f 5 6 7 8\nf 1 2 6 5\nf 2 3 7 6\nf 3 4 8 7\nf 4 1 5 8"
    print "v 10 0 1\nv 14 0 3\nv 14 4 3\nv 12 0.5 2\nv 10 4 1\nf 9 10 11 12 13" }' >box.obj
still='--fix 0 --closeness 0 --quiet' # the mesh stays as it is

# ---- what is laid flat is what stands in space ----

python=
for candidate in python3 /usr/bin/python3; do
    "$candidate" -c 'import ezdxf' 2>/dev/null && python=$candidate && break
done
dxf=yes
[ -n "$python" ] || { dxf='' python=python3 && skip 'DXF read back (no python3-ezdxf)'; }
if ! command -v "$python" >/dev/null; then
    skip 'panels read back (no python3)'
else
    panels() { # panels NAME MESH SCALE ARGUMENTS...: lays the panels of the mesh flat, in both formats, and compares
        local name=$1 mesh=$2 scale=$3 counts
        shift 3
        for format in svg dxf; do
            "$tool" $mesh -o same.obj $still "$@" --panel-scale "$scale" --panels "$name.$format" --panel-list "$name.csv" ||
                fail "$name.$format: $*"
        done
        counts=$("$python" "$here/test_panels.py" "$scale" same.obj "$name.svg" ${dxf:+"$name.dxf"} "$name.csv" $strips)
        grep -v '^[0-9]* passed' <<<"$counts"
        [[ $counts =~ ([0-9]+)\ passed,\ ([0-9]+)\ failed$ ]] && passed=$((passed + BASH_REMATCH[1])) &&
            failed=$((failed + BASH_REMATCH[2])) || fail "test_panels.py on $name: $counts"
    }
    strips=
    panels one flat.obj 1
    panels sheets flat.obj 1 --sheet 6,4
    panels metres flat.obj 1000 --sheet 3000,5000,20
    panels tall torus.obj 1 --sheet 1.4,9,0.01
    panels notch box.obj 10 --sheet 60,50,1
    strips=strips.obj
    panels conical torus.obj 1 --planar --conical --offset 0.2,offset.obj --support strips.obj --sheet 5,5
    panels circular torus.obj 1 --planar --circular --offset=-0.3,offset.obj --support strips.obj
fi

# ---- angles do not depend on the unit ----

for unit in 1e69 1e-70; do
    awk -v s=$unit '$1 == "v" { printf "v %.17g %.17g %.17g\n", s * $2, s * $3, s * $4; next } { print }' torus.obj >unit.obj
    for mesh in torus unit; do
        "$tool" $mesh.obj -o same.obj --fix 0 --closeness 0 --quiet --panels out.svg --panel-list out.csv --colour bend --picture $mesh.svg ||
            fail "panels of $mesh.obj"
        awk -F, '$1 == "edge" && NF > 6 { printf "%.6f\n", $7 }' out.csv | sort >$mesh.txt
        grep -o '<path[^>]*fill="[^"]*"' $mesh.svg | grep -o 'fill=".*' >$mesh.fills
    done
    [ "$(grep -c . torus.txt)" = 512 ] && cmp -s torus.txt unit.txt && cmp -s torus.fills unit.fills && pass ||
        fail "angles in the unit $unit: $(diff torus.txt unit.txt | head -n 3 | tr '\n' ' ')"
done
rm -f out.svg out.csv

# ---- refusals ----

refused() { # refused STATUS PART ARGUMENTS...: no output is touched
    local want=$1 part=$2 status
    shift 2
    echo old >out.obj && rm -f out.svg out.dxf out.csv
    "$tool" "$@" -o out.obj 2>err.txt
    status=$?
    [ $status -eq "$want" ] && grep -qF -- "$part" err.txt && [ "$(cat out.obj)" = old ] && [ "$(grep -c . err.txt)" -le 2 ] &&
        [ ! -e out.svg ] && [ ! -e out.dxf ] && [ ! -e out.csv ] && pass || fail "'$*': status $status: $(cat err.txt)"
}
awk '{ if ($1 == "v" && ++n == 7) $4 += 1e-4; print }' box.obj >warped.obj
printf 'v 0 0 0\nv 2 0 0\nv 2 1 0\nv 0 1 0\nv 1 -2 0\nf 1 3 4 2 5\n' >crossed.obj
printf 'v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nv 2 0 0\nv 3 0 0\nv 4 0 0\nf 1 2 3 4\nf 5 6 7\n' >empty.obj
refused 3 'face 0 is not planar: it is off its plane by' roof.obj $still --panels out.svg --panel-list out.csv
refused 3 'face 0 is not planar' warped.obj $still --panels out.dxf
refused 3 'face 0 crosses itself' crossed.obj $still --panels out.svg
refused 3 'face 1 has no area' empty.obj $still --panels out.svg
refused 3 'face 0 takes 4 x 3 mm and the sheet has 3.8 x 3.8 mm' box.obj $still --panels out.svg --sheet 4,4,0.1
refused 3 'face 0 takes 4 x 3 mm' box.obj $still --panels out.svg --sheet 0.1,0.1
refused 3 'the strip along edge' flat.obj $still --planar --offset 0.5,out.off --support out.csv.obj --panels out.svg
refused 2 'must end in .svg or .dxf' box.obj $still --panels out.pdf
refused 2 'must end in .csv' box.obj $still --panels out.svg --panel-list out.txt
refused 2 'add --panels' box.obj $still --panel-list out.csv
refused 2 'add --panels' box.obj $still --sheet 3,4
refused 2 'add --panels' box.obj $still --panel-scale 3
refused 2 'same path' box.obj $still --panels out.svg --picture out.svg
for sheet in 3 3,0 -1,3 3,4, 3,4,5 3,4,1,1 x,4 3,nan 3,1e99; do
    refused 2 'expected WIDTH,HEIGHT' box.obj $still --panels out.svg --sheet=$sheet
done
for scale in 0 -1 1e99 x; do refused 2 'expected the millimetres' box.obj $still --panels out.svg --panel-scale=$scale; done
"$tool" warped.obj -o out.obj --planar --fix 0 --panels out.SVG --quiet && [ -s out.SVG ] && pass || fail 'made planar first'

echo "$passed passed, $failed failed, $skipped skipped"
[ "$failed" -eq 0 ]
