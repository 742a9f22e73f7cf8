#!/bin/bash
# check_meshes.sh - tools/more_meshes.py: the meshes that it makes itself are manifolds, its Catmull and Clark step is one, and
# its table counts how the tool ends. What it fetches is not tried.
. "$(dirname "$0")/checks.sh"

have python3 || { skip 'more_meshes.py: no python3'; report; }
clean 'its meshes' "$(cd "$work" && PYTHONDONTWRITEBYTECODE=1 PYTHONPATH="$root/tools" python3 - 2>&1 <<'END_PYTHON'
import more_meshes as m
made = list(m.surfaces()) + list(m.patches(3, 12))
assert len(made) > 20 and all(m.is_whole(points, faces) for _, points, faces in made)
assert made[-1] != list(m.patches(4, 12))[-1] and made[-1] == list(m.patches(3, 12))[-1]
_, points, faces = made[-1]
assert not m.is_whole(points, faces + [faces[0]]) # an edge with three faces
assert not m.is_whole(points + [(0, 0, 0)], faces) # a point without a face
loose = [[v + len(points) for v in face] for face in faces]
assert not m.is_whole(points + points, faces + loose) # two parts
touching = [[v if v == faces[0][0] else v + len(points) for v in face] for face in faces]
assert not m.is_whole(*m.used_points(points + points, faces + touching)) # two fans at one vertex

corners = [(x, y, z) for x in (-1, 1) for y in (-1, 1) for z in (-1, 1)]
cube = [[0, 1, 3, 2], [4, 6, 7, 5], [0, 4, 5, 1], [2, 3, 7, 6], [0, 2, 6, 4], [1, 5, 7, 3]]
finer, quads = m.catmull_clark(corners, cube)
assert (len(finer), len(quads)) == (26, 24) and len(m.edges_of(quads)) == 96
assert max(abs(abs(x) - 5 / 9) for p in finer[:8] for x in p) < 1e-12 # (F + 2 R + 0 P) / 3, F = 1/3, R = 2/3
sheet, quads = m.catmull_clark([(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0)], [[0, 1, 2, 3]])
assert sheet[:4] == [(0, 0, 0), (2, 0, 0), (2, 2, 0), (0, 2, 0)] and len(quads) == 4 # corners stay

m.os.mkdir('few')
m.write('few/p_a.obj', *made[0][1:])
m.write('few/n_b.obj', *made[-1][1:])
assert m.read_obj(open('few/p_a.obj').read())[1] == made[0][2]
END_PYTHON
)"
tool=${GPROJ_TOOL:-${TOOL:-build/tool}}
[ -x "$tool" ] || tool=$root/tools/guidedproj
[ -x "$tool" ] || { skip 'more_meshes.py --try: no tool'; report; }
GPROJ_TOOL=$(realpath "$tool") python3 "$root/tools/more_meshes.py" --try "$work/few" >"$work/table.txt" 2>&1 && pass ||
    { fail 'more_meshes.py --try'; cat "$work/table.txt"; }
grep -qE '^planar +0/0/0/0 +0/0/0/0 +1/0/0/0 +1/0/0/0$' "$work/table.txt" && pass || { fail 'its table'; cat "$work/table.txt"; }
printf '#!/bin/sh\nkill -SEGV $$\n' >"$work/crash" && chmod +x "$work/crash"
GPROJ_TOOL=$work/crash python3 "$root/tools/more_meshes.py" --try "$work/few" >"$work/table.txt" 2>&1 && fail 'a crash is no failure' || pass
grep -q "^$work/crash .*few/p_a.obj" "$work/table.txt" && pass || { fail 'a crash is not told'; cat "$work/table.txt"; }
python3 "$root/tools/more_meshes.py" "$work/few" >"$work/again.txt" 2>&1 && fail 'an existing folder is written to' || pass
grep -q 'exists already' "$work/again.txt" && pass || fail 'an existing folder is refused without a reason'
report
