#!/usr/bin/env python3
"""Writes some 300 quad meshes into a new folder, and tries the command line on them:

    python3 tools/more_meshes.py FOLDER [SEED]     writes the meshes
    python3 tools/more_meshes.py --try FOLDER      counts how tools/guidedproj ends on those of a folder, task by task

s_NAME  shapes of OpenSubdiv's regression tests (Debian's source package), refined by Catmull and Clark
q_NAME  meshes of CGAL's documentation (Debian's libcgal-demo), remeshed with quads by Blender (Quadriflow)
p_NAME  parametric surfaces
n_NUMBER  random patches: a grid with vertices of valence 3 or 5, cut, bent by a few waves; SEED (0) chooses them

The packages are fetched by apt-get, without being installed (as root, or where /etc/apt can be read), and stay in
FOLDER.packages; without network, apt or Blender the meshes that need them are left out, and it says so. All meshes
are connected manifolds with 60 to 4,000 faces. They are for measuring: what they come from has licences of its own.

Trying takes about a quarter of an hour. whole: exit code 0, that is, all constraints hold and no face or edge is spoiled.
told: exit code 1, with a verdict. late: not finished in two minutes. else: any other end, which there should not be;
the commands of these are printed, and the exit code is 1.
"""
import concurrent.futures
import glob
import math
import os
import random
import re
import subprocess
import sys
import tarfile
import tempfile

FEWEST, MOST = 60, 4000


# ---- meshes: lists of points and of faces ----

def edges_of(faces):
    """(a, b) -> face, for each directed edge; None where a directed edge occurs twice."""
    owner = {}
    for number, face in enumerate(faces):
        for a, b in zip(face, face[1:] + face[:1]):
            if (a, b) in owner or a == b:
                return None
            owner[a, b] = number
    return owner


def is_whole(points, faces):
    """A connected manifold, each vertex with one fan of faces, no edge next to nothing."""
    owner = edges_of(faces)
    if owner is None or not FEWEST <= len(faces) <= MOST:
        return False
    fans = {}
    for face in faces:
        for before, at, after in zip(face[-1:] + face[:-1], face, face[1:] + face[:1]):
            fans.setdefault(at, {})[after] = before
    if len(fans) != len(points):
        return False
    for fan in fans.values():  # follow the fan from where it begins: all of it, once
        ends = set(fan) - set(fan.values())
        at, seen = (ends or set(fan)).pop(), set()
        while at in fan and at not in seen:
            seen.add(at)
            at = fan[at]
        if len(seen) < len(fan):
            return False
    reached, todo = {0}, [0]
    neighbours = {}
    for a, b in owner:
        neighbours.setdefault(a, []).append(b)
        neighbours.setdefault(b, []).append(a)
    while todo:
        for b in neighbours[todo.pop()]:
            if b not in reached:
                reached.add(b)
                todo.append(b)
    lengths = [math.dist(points[a], points[b]) for a, b in owner]
    return len(reached) == len(points) and min(lengths) > 1e-3 * sum(lengths) / len(lengths)


def used_points(points, faces):
    """The same mesh without points that no face uses."""
    used = sorted({v for face in faces for v in face})
    number = {v: i for i, v in enumerate(used)}
    return [points[v] for v in used], [[number[v] for v in face] for face in faces]


def write(path, points, faces):
    with open(path, 'w', encoding='ascii') as out:
        for point in points:
            out.write('v %.17g %.17g %.17g\n' % tuple(point))
        for face in faces:
            out.write('f ' + ' '.join(str(v + 1) for v in face) + '\n')


def read_obj(text):
    points, faces = [], []
    for line in text.split('\n'):
        words = line.split()
        if words[:1] == ['v']:
            points.append(tuple(float(w) for w in words[1:4]))
        elif words[:1] == ['f']:
            numbers = [int(w.split('/')[0]) for w in words[1:]]
            faces.append([n - 1 if n > 0 else n + len(points) for n in numbers])
    return points, faces


def mean(points):
    return tuple(sum(p[k] for p in points) / len(points) for k in range(3))


def catmull_clark(points, faces):
    """One step (Catmull and Clark 1978); boundaries become cubic B-splines, corners with one face stay."""
    owner = edges_of(faces)
    centres = [mean([points[v] for v in face]) for face in faces]
    middles, moved = {}, []
    around = [[] for _ in points]
    borders = [[] for _ in points]
    touching = [[] for _ in points]
    for number, face in enumerate(faces):
        for v in face:
            touching[v].append(centres[number])
    result = list(points) + centres
    for (a, b), face in owner.items():
        middle = mean([points[a], points[b]])
        if (b, a) not in owner:
            borders[a].append(b)
            borders[b].append(a)
            middles[a, b] = middles[b, a] = len(result)
            result.append(middle)
        elif a < b:
            middles[a, b] = middles[b, a] = len(result)
            result.append(mean([points[a], points[b], centres[face], centres[owner[b, a]]]))
            around[a].append(middle)
            around[b].append(middle)
    for v, point in enumerate(points):
        if borders[v]:
            ends = [points[b] for b in borders[v]]
            moved.append(point if len(touching[v]) == 1 else mean([point] * 6 + ends))
        else:
            n = len(touching[v])
            q, r = mean(touching[v]), mean(around[v])
            moved.append(tuple((q[k] + 2 * r[k] + (n - 3) * point[k]) / n for k in range(3)))
    result[:len(points)] = moved
    quads = []
    for number, face in enumerate(faces):
        for before, at, after in zip(face[-1:] + face[:-1], face, face[1:] + face[:1]):
            quads.append([at, middles[at, after], len(points) + number, middles[before, at]])
    return result, quads


# ---- packages ----

def fetch(folder):
    """Puts the source of opensubdiv and libcgal-demo there; returns what is missing."""
    parts, lists = folder + '/parts', folder + '/lists'
    os.makedirs(lists + '/partial', exist_ok=True)
    os.makedirs(parts, exist_ok=True)
    for path in glob.glob('/etc/apt/sources.list.d/*.sources') + glob.glob('/etc/apt/sources.list'):
        text = open(path, encoding='utf-8').read()
        text = text.replace('Types: deb\n', 'Types: deb deb-src\n')
        text += '\n' + '\n'.join(re.sub('^deb ', 'deb-src ', line) for line in re.findall('(?m)^deb .*', text)) + '\n'
        open(parts + '/' + os.path.basename(path), 'w', encoding='utf-8').write(text)
    apt = ['apt-get', '-q', '-o', 'Dir::Etc::sourcelist=' + parts + '/sources.list',
           '-o', 'Dir::Etc::sourceparts=' + parts, '-o', 'Dir::State::lists=' + lists]
    log = open(folder + '/log.txt', 'w', encoding='utf-8')
    for words in ['update'], ['source', '--download-only', 'opensubdiv'], ['download', 'libcgal-demo']:
        try:
            subprocess.run(apt + words, cwd=folder, stdout=log, stderr=log, check=False)
        except OSError as error:
            log.write(str(error) + '\n')
    for path in glob.glob(folder + '/opensubdiv_*.orig.tar.*'):
        with tarfile.open(path) as archive:
            for member in archive:
                if '/regression/shapes/' in member.name and member.name.endswith('.h'):
                    member.name = os.path.basename(member.name)
                    archive.extract(member, folder + '/shapes')
    for path in glob.glob(folder + '/libcgal-demo_*.deb'):
        subprocess.run(['dpkg-deb', '-x', path, folder + '/cgal'], check=True)
    for path in glob.glob(folder + '/cgal/usr/share/doc/*/data.tar.gz'):
        with tarfile.open(path) as archive:
            for member in archive:
                if member.name.startswith('data/meshes/') and member.name.endswith('.off'):
                    member.name = os.path.basename(member.name)
                    archive.extract(member, folder + '/meshes')


def shapes(folder):
    for path in sorted(glob.glob(folder + '/shapes/*.h')):
        text = open(path, encoding='utf-8').read()
        lines = re.findall(r'"((?:[^"\\]|\\.)*)"', text.split('=', 1)[-1])
        points, faces = used_points(*read_obj(''.join(lines).replace('\\n', '\n')))
        if not faces or edges_of(faces) is None:
            continue
        while len(faces) < 300 or any(len(face) != 4 for face in faces):
            points, faces = catmull_clark(points, faces)
        yield 's_' + os.path.basename(path)[:-2], points, faces


BLENDER = """
import bpy, sys
source, target = sys.argv[-2:]
lines = [l.split('#')[0].split() for l in open(source)]
words = [w for l in lines for w in l]
words = words[1:] if words[0].endswith('OFF') else words
nv, nf = int(words[0]), int(words[1])
numbers, at = words[3:], 3 * nv
points = [tuple(map(float, numbers[3 * i:3 * i + 3])) for i in range(nv)]
faces = []
for _ in range(nf):
    n = int(numbers[at])
    faces.append([int(v) for v in numbers[at + 1:at + 1 + n]])
    at += 1 + n
mesh = bpy.data.meshes.new('m')
mesh.from_pydata(points, [], faces)
mesh.update()
thing = bpy.data.objects.new('m', mesh)
bpy.context.collection.objects.link(thing)
bpy.context.view_layer.objects.active = thing
thing.select_set(True)
bpy.ops.object.quadriflow_remesh(target_faces=1500, use_preserve_sharp=False, use_preserve_boundary=True, seed=1)
with open(target, 'w') as out:
    for v in thing.data.vertices:
        out.write('v %.9g %.9g %.9g\\n' % tuple(v.co))
    for p in thing.data.polygons:
        out.write('f ' + ' '.join(str(v + 1) for v in p.vertices) + '\\n')
"""


def quadriflow(folder):
    script = folder + '/quadriflow.py'
    open(script, 'w', encoding='utf-8').write(BLENDER)
    for path in sorted(glob.glob(folder + '/meshes/*.off')):
        if not 20000 < os.path.getsize(path) < 2000000:
            continue
        target = folder + '/quads.obj'
        if os.path.exists(target):
            os.remove(target)
        try:
            subprocess.run(['blender', '-b', '--factory-startup', '--python', script, '--', path, target],
                           stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=60, check=False)
        except subprocess.TimeoutExpired:
            continue
        if os.path.exists(target):
            points, faces = used_points(*read_obj(open(target, encoding='ascii').read()))
            if {len(face) for face in faces} == {4} and edges_of(faces) is not None:
                yield 'q_' + os.path.basename(path)[:-4], points, faces


# ---- surfaces ----

def grid(n, m, wrapped=(False, False)):
    """Faces of n x m quads; the vertex (i, j) has the number i columns + j."""
    rows, columns = n + (not wrapped[0]), m + (not wrapped[1])
    return rows, columns, [[i * columns + j, (i + 1) % rows * columns + j,
                            (i + 1) % rows * columns + (j + 1) % columns, i * columns + (j + 1) % columns]
                           for i in range(n) for j in range(m)]


def surfaces():
    """x(u, v) with u, v from 0 to 1."""
    tau, sin, cos = 2 * math.pi, math.sin, math.cos
    table = {
        'saddle': (lambda u, v: (u, v, 1.2 * (u - .5) * (v - .5)), (16, 16), (False, False)),
        'monkey': (lambda u, v: (2 * u - 1, 2 * v - 1, .3 * ((2 * u - 1) ** 3 - 3 * (2 * u - 1) * (2 * v - 1) ** 2)),
                   (18, 18), (False, False)),
        'waves': (lambda u, v: (2 * u, v, .15 * sin(tau * u) * cos(tau * v)), (24, 14), (False, False)),
        'dome': (lambda u, v: (2 * u - 1, 2 * v - 1, .8 * (1 - (2 * u - 1) ** 2) * (1 - (2 * v - 1) ** 2)), (18, 18),
                 (False, False)),
        'vault': (lambda u, v: (2 * u, (1 + .3 * sin(tau * u)) * (v - .5), .6 * sin(math.pi * v)), (20, 14),
                  (False, False)),
        'helicoid': (lambda u, v: ((.3 + u) * cos(2.5 * v), (.3 + u) * sin(2.5 * v), .8 * v), (12, 24), (False, False)),
        'catenoid': (lambda u, v: (math.cosh(2 * u - 1) * cos(tau * v), math.cosh(2 * u - 1) * sin(tau * v), 2 * u - 1),
                     (14, 32), (False, True)),
        'twisted': (lambda u, v: (1.5 * u, (v - .5) * cos(1.3 * u), (v - .5) * sin(1.3 * u)), (24, 12), (False, False)),
        'torus': (lambda u, v: ((2 + .7 * cos(tau * v)) * cos(tau * u), (2 + .7 * cos(tau * v)) * sin(tau * u),
                                .7 * sin(tau * v)), (32, 16), (True, True)),
        'knotted': (lambda u, v: ((2 + (.6 + .15 * sin(3 * tau * u)) * cos(tau * (v + u))) * cos(tau * u),
                                  (2 + (.6 + .15 * sin(3 * tau * u)) * cos(tau * (v + u))) * sin(tau * u),
                                  (.6 + .1 * cos(2 * tau * u)) * sin(tau * (v + u))), (40, 16), (True, True)),
        'vase': (lambda u, v: ((1 + .4 * sin(5 * u)) * cos(tau * v), (1 + .4 * sin(5 * u)) * sin(tau * v), 3 * u), (18, 24),
                 (False, True)),
        'tower': (lambda u, v: ((1 - .4 * u) * cos(tau * v + 1.5 * u) * (1 + .2 * cos(3 * tau * v)),
                                (1 - .4 * u) * sin(tau * v + 1.5 * u) * (1 + .2 * cos(3 * tau * v)), 3 * u), (20, 36),
                  (False, True)),
        'skewed': (lambda u, v: (u + .4 * v, v, .4 * sin(3 * u + 1) * cos(2 * v)), (16, 18), (False, False)),
        'shell': (lambda u, v: (cos(4.5 * v) * (.5 + v) * (1 + .4 * u), sin(4.5 * v) * (.5 + v) * (1 + .4 * u), .8 * u * u),
                  (10, 32), (False, False)),
    }
    for name, (function, (n, m), wrapped) in table.items():
        rows, columns, faces = grid(n, m, wrapped)
        yield 'p_' + name, [function(i / n, j / m) for i in range(rows) for j in range(columns)], faces


def patches(seed, count):
    """A ring of k sectors of grids around a vertex of valence k, or a plain grid, cut off by a slanted line."""
    rng = random.Random(seed)
    for number in range(count):
        k, n = rng.choice([3, 4, 4, 5, 6]), rng.randint(6, 11)
        points, faces, seen = [], [], {}
        for sector in range(k):
            angle = 2 * math.pi / k
            a = (math.cos(sector * angle), math.sin(sector * angle))
            b = (math.cos((sector + 1) * angle), math.sin((sector + 1) * angle))
            for i in range(n + 1):
                for j in range(n + 1):
                    # (i, 0) of a sector is (0, i) of the one before it
                    key = (0, 0, 0) if i + j == 0 else ((sector + 1) % k, j, 0) if i == 0 else (sector, i, j)
                    if key not in seen:
                        seen[key] = len(points)
                        points.append((i * a[0] + j * b[0], i * a[1] + j * b[1]))
            for i in range(n):
                for j in range(n):
                    corner = lambda i, j: seen[(0, 0, 0) if i + j == 0 else ((sector + 1) % k, j, 0) if i == 0
                                               else (sector, i, j)]
                    faces.append([corner(i, j), corner(i + 1, j), corner(i + 1, j + 1), corner(i, j + 1)])
        nx, ny, limit = math.cos(number), math.sin(number), rng.uniform(.4, 1.2) * n
        inside = [x * nx + y * ny < limit for x, y in points]
        faces = [face for face in faces if all(inside[v] for v in face)]
        waves = [(rng.uniform(-1, 1) * 3 / n, rng.uniform(-1, 1) * 3 / n, rng.uniform(0, 6), rng.uniform(.3, 1) * n / 4)
                 for _ in range(3)]
        bent = [(x, y, sum(h * math.sin(p * x + q * y + s) for p, q, s, h in waves)) for x, y in points]
        yield 'n_%03d' % number, *used_points(bent, faces)


# ---- trying ----

TASKS = {
    'planar': ['--planar'],
    'planar, subdivided': ['--subdivide', '1', '--planar'],
    'planar, fixed boundary': ['--planar', '--fix', 'boundary'],
    'planar, gliding, faired': ['--planar', '--glide', 'boundary', '--reference', '@=0.1', '--fairness', '0.2*0.9'],
    'planar, nearest': ['--planar', '--nearest'],
    'planar, circular': ['--planar', '--circular'],
    'planar, conical': ['--planar', '--conical'],
}


def try_one(work):
    """How a command ends: whole, told, late or else."""
    try:
        end = subprocess.run(work, stdout=subprocess.DEVNULL, stderr=subprocess.DEVNULL, timeout=120, check=False)
        return {0: 'whole', 1: 'told'}.get(end.returncode, 'else')
    except subprocess.TimeoutExpired:
        return 'late'


def try_all(folder):
    tool = os.environ.get('GPROJ_TOOL') or os.path.join(os.path.dirname(os.path.abspath(__file__)), 'guidedproj')
    kinds = {'s': 'OpenSubdiv', 'q': 'CGAL', 'p': 'surfaces', 'n': 'patches'}
    meshes = sorted(glob.glob(folder + '/*.obj'))
    if not os.path.exists(tool) or not meshes:
        sys.exit('no %s: make -C tools' % tool if meshes else folder + ' has no meshes')
    others = []
    print('%-26s' % 'task' + ''.join('%22s' % name for name in kinds.values()) + '   whole/told/late/else')
    with tempfile.TemporaryDirectory() as out, concurrent.futures.ThreadPoolExecutor(os.cpu_count()) as pool:
        for task, words in TASKS.items():
            chosen = [m for m in meshes if not {'--fix', '--glide'} & set(words) or has_boundary(m)]
            works = [[tool, m, '-o', os.path.join(out, os.path.basename(m))] + [w.replace('@', m) for w in words]
                     for m in chosen]
            ends = list(pool.map(try_one, works))
            others += [' '.join(work) for work, end in zip(works, ends) if end == 'else']
            cells = []
            for kind in kinds:
                mine = [end for m, end in zip(chosen, ends) if os.path.basename(m).startswith(kind)]
                cells.append('/'.join(str(mine.count(end)) for end in ('whole', 'told', 'late', 'else')))
            print('%-26s' % task + ''.join('%22s' % cell for cell in cells), flush=True)
    print('\n'.join(others))
    sys.exit(bool(others))


def has_boundary(path):
    owner = edges_of(read_obj(open(path, encoding='ascii').read())[1])
    return any((b, a) not in owner for a, b in owner)


def main():
    if len(sys.argv) == 3 and sys.argv[1] == '--try':
        try_all(sys.argv[2])
    if len(sys.argv) not in (2, 3) or os.path.exists(sys.argv[1]):
        sys.exit(__doc__ if len(sys.argv) not in (2, 3) else sys.argv[1] + ' exists already; name a new folder')
    folder, seed = os.path.abspath(sys.argv[1]), int(sys.argv[2]) if len(sys.argv) == 3 else 0
    packages = folder + '.packages'
    os.makedirs(folder)
    os.makedirs(packages, exist_ok=True)
    if not os.path.exists(packages + '/shapes') or not os.path.exists(packages + '/meshes'):
        fetch(packages)
    for what, source in ('shapes of OpenSubdiv', shapes(packages)), ('remeshed meshes of CGAL', quadriflow(packages)), \
            ('surfaces', surfaces()), ('random patches', patches(seed, 160)):
        count = 0
        try:
            for name, points, faces in source:
                if is_whole(points, faces):
                    write('%s/%s.obj' % (folder, name), points, faces)
                    count += 1
        except OSError as error:
            print(error)
        print('%d %s%s' % (count, what, '' if count else ': see %s/log.txt' % packages), flush=True)


if __name__ == '__main__':
    main()
