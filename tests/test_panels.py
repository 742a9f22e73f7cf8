#!/usr/bin/env python3
"""test_panels.py SCALE MESH.obj PANELS.svg [PANELS.dxf] PANELS.csv [STRIPS.obj] - compares panels with the mesh in space.

Reads the SVG as XML, the DXF by ezdxf, and knows nothing of how they were made: each panel is congruent to its face and
not mirrored, its numbers are the neighbours', its angles those between the faces; sides that meet in space are equally
long; no rectangle along a side is smaller than the one it lies in; panels are inside their sheets and apart. Prints what
is wrong, and how many panels passed.
"""
import csv, math, sys, xml.etree.ElementTree as xml

SVG = "{http://www.w3.org/2000/svg}"
failed = 0


def check(condition, what):
    global failed
    failed += not condition
    if not condition: print("FAILED:", what)


def read_obj(path, scale):
    points, faces = [], []
    for line in open(path):
        words = line.split()
        if words[:1] == ["v"]: points.append([scale * float(x) for x in words[1:4]])
        if words[:1] == ["f"]: faces.append([int(w.split("/")[0]) - 1 for w in words[1:]])
    return points, faces


minus = lambda a, b: [x - y for x, y in zip(a, b)]
dot = lambda a, b: sum(x * y for x, y in zip(a, b))
cross = lambda a, b: [a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]]
pairs = lambda ring: list(zip(ring, ring[1:] + ring[:1]))


def normal(points):
    sides = [cross(minus(a, points[0]), minus(b, points[0])) for a, b in pairs(points)]
    return [sum(s[k] for s in sides) for k in range(3)]


def dihedral(a, b, side):
    return 180 - math.degrees(math.atan2(dot(cross(a, b), side) / math.hypot(*side), dot(a, b)))


def read_svg(path):
    """{name: (sheet, corners, [(words, x, y, angle)])} and the sheets' size; y upwards from each sheet's lower border."""
    panels, root = {}, xml.parse(path).getroot()
    size, places = None, []
    for number, sheet in enumerate(root.findall(SVG + "g")):
        border = sheet.find(SVG + "rect")
        size = float(border.get("width")), float(border.get("height"))
        places.append([float(x) for x in sheet.get("transform").replace("translate(", "").replace(")", "").split()])
        for group in sheet.findall(SVG + "g"):
            corners = [[float(x) for x in p.split(",")] for p in group.find(SVG + "polygon").get("points").split()]
            words = []
            for text in group.findall(SVG + "text"):
                x, y, angle = text.get("transform").replace("translate(", "").replace("rotate(", "").replace(")", "").split()
                words.append((text.text, float(x), size[1] - float(y), -float(angle)))
            panels[group.get("id").replace("panel-", "")] = number, [[x, size[1] - y] for x, y in corners], words
    box = [float(x) for x in root.get("viewBox").split()]
    check(all(0 <= x and x + size[0] <= box[2] and 0 <= y and y + size[1] <= box[3] for x, y in places), "sheets beyond the picture")
    check(are_apart(places, size), "sheets meet in the picture")
    return panels, size, root


def are_apart(places, size):
    return all(abs(p[0] - q[0]) > size[0] or abs(p[1] - q[1]) > size[1] for i, p in enumerate(places) for q in places[:i])


def far(a, b): return math.hypot(*minus(a, b))


def inside(corners, x, y):
    return sum((a[1] > y) != (b[1] > y) and x < a[0] + (y - a[1]) * (b[0] - a[0]) / (b[1] - a[1]) for a, b in pairs(corners)) % 2 == 1


def check_panel(name, face, corners, words):
    """A panel against the points of its face."""
    size = max(far(face[0], p) for p in face)
    worst = max(abs(far(face[i], face[j]) - far(corners[i], corners[j])) for i in range(len(face)) for j in range(i))
    check(worst < 1e-12 * size, f"panel {name} is off by {worst / size:.1e} of its size")
    sides = max(abs(far(a, b) - far(c, d)) / far(a, b) for (a, b), (c, d) in zip(pairs(face), pairs(corners)))
    check(sides < 1e-12, f"panel {name} has sides off by {sides:.1e}")
    area = sum(a[0] * b[1] - a[1] * b[0] for a, b in pairs(corners)) / 2
    check(abs(area / (math.hypot(*normal(face)) / 2) - 1) < 1e-9, f"panel {name}: mirrored, or another area")
    check(words[0][0] == name and all(inside(corners, x, y) for _, x, y, _ in words), f"panel {name}: words {words}")
    # The rectangle: corners' extents along every side, the sides of the convex hull among them.
    extent = lambda u: max(dot(u, p) for p in corners) - min(dot(u, p) for p in corners)
    least, lies = math.inf, extent([1, 0]) * extent([0, 1])
    for a, b in pairs(corners):
        u = [x / far(a, b) for x in minus(b, a)]
        if all(dot([-u[1], u[0]], minus(p, a)) > -1e-9 * size for p in corners): least = min(least, extent(u) * extent([-u[1], u[0]]))
    check(lies < (1 + 1e-12) * least, f"panel {name} lies in a rectangle that is {lies / least:.6f} times the smallest")


def check_faces(points, faces, panels):
    beside = {edge: f for f, face in enumerate(faces) for edge in pairs(face)}
    normals = [normal([points[v] for v in face]) for face in faces]
    for f, face in enumerate(faces):
        sheet, corners, words = panels[str(f)]
        check_panel(str(f), [points[v] for v in face], corners, words)
        rest = list(words[1:])
        for k, (a, b) in enumerate(pairs(face)):
            other = beside.get((b, a))
            if other is None: continue
            middle = [(x + y) / 2 for x, y in zip(corners[k], corners[(k + 1) % len(face)])]
            near = min(rest, key=lambda w: far(middle, w[1:3]))
            rest.remove(near)
            number, angle = near[0].split(": ")
            along = math.degrees(math.atan2(*reversed(minus(corners[(k + 1) % len(face)], corners[k]))))
            check(int(number) == other and abs(float(angle.rstrip("\u00b0")) - dihedral(normals[f], normals[other], minus(points[b], points[a]))) < 0.051,
                  f"panel {f}: {near[0]} stands for face {other}")
            check(abs((along - near[3] + 90) % 180 - 90) < 0.01, f"panel {f}: words across the side to {other}")
            ours, theirs = panels[str(f)][1], panels[str(other)][1]
            m = faces[other].index(b)
            check(abs(far(ours[k], ours[(k + 1) % len(face)]) - far(theirs[m], theirs[(m + 1) % len(theirs)])) < 1e-12 * far(points[a], points[b]),
                  f"the sides of panels {f} and {other} differ")
        check(not rest, f"panel {f} has more words: {rest}")


def check_sheets(panels, size):
    """Bounding rectangles are inside the sheet and apart: hence the panels are."""
    boxes = {}
    for name, (sheet, corners, _) in panels.items():
        low, high = [min(p[k] for p in corners) for k in (0, 1)], [max(p[k] for p in corners) for k in (0, 1)]
        boxes.setdefault(sheet, []).append((low[0], high[0], low[1], high[1], name))
    for sheet, list in boxes.items():
        list.sort()
        check(all(0 < a and b < size[0] and 0 < c and d < size[1] for a, b, c, d, _ in list), f"panels beyond sheet {sheet + 1}")
        meeting = [(p[4], q[4]) for i, p in enumerate(list) for q in list[i + 1:] if q[0] <= p[1] and q[2] <= p[3] and p[2] <= q[3]]
        check(not meeting, f"panels meet on sheet {sheet + 1}: {meeting[:5]}")
    check(sorted(boxes) == [*range(len(boxes))], "sheets without panels")


def check_dxf(path, panels, size):
    import ezdxf
    document = ezdxf.readfile(path)
    check(document.dxfversion == "AC1009" and not document.audit().has_errors, "the DXF has errors")
    check({"CUT", "MARKS", "TEXT", "SHEETS"} <= {layer.dxf.name for layer in document.layers}, "layers")
    space = document.modelspace()
    cut = [e for e in space.query("POLYLINE") if e.dxf.layer == "CUT"]
    borders = [e for e in space.query("POLYLINE") if e.dxf.layer == "SHEETS"]
    check(len(cut) == len(panels) and all(e.is_closed for e in cut), "outlines in the DXF")
    check(len(borders) == 1 + max(sheet for sheet, _, _ in panels.values()), "borders in the DXF")
    place = [e.vertices[0].dxf.location for e in borders]
    check(are_apart(place, size) and all(len(e.vertices) == 4 for e in borders), "sheets meet in the DXF")
    texts = [e for e in space.query("TEXT")]
    check(len(texts) == sum(len(words) for _, _, words in panels.values()), "words in the DXF")
    check({e.dxf.layer for e in texts} == {"TEXT"} and {e.dxf.layer for e in space.query("LINE")} <= {"MARKS"}, "layers of words and lines")
    texts = iter(texts)
    order = sorted(panels, key=lambda name: (name[0] == "S", int(name.lstrip("S"))))
    for name, polygon in zip(order, cut):
        sheet, corners, words = panels[name]
        got = [v.dxf.location for v in polygon.vertices]
        worst = max(far([p[0] - place[sheet][0], p[1] - place[sheet][1]], c) for p, c in zip(got, corners))
        check(len(got) == len(corners) and worst < 1e-12 * len(borders) * max(size), f"panel {name} in the DXF is off by {worst:.1e}")
        sides = max(abs(far(a, b) - far(c, d)) for (a, b), (c, d) in zip(pairs([list(p) for p in got]), pairs(corners)))
        check(sides < 1e-12 * max(far(corners[0], c) for c in corners) * max(1, len(borders)), f"sides of panel {name} in the DXF: {sides:.1e}")
        for text, x, y, angle in words:
            e = next(texts)
            at = e.dxf.align_point
            check(e.dxf.text.replace("%%d", "\u00b0") == text and far([at[0] - place[sheet][0], at[1] - place[sheet][1]], [x, y]) < 1e-5 * max(size)
                  and abs(e.dxf.rotation - angle) < 1e-2 and e.dxf.height > 0, f"words {text} in the DXF: {e.dxf.text}")


def check_csv(path, panels, points, faces):
    rows = list(csv.reader(open(path)))[1:]
    lengths, count = {}, 0
    for row in rows:
        if row[0] == "panel":
            sheet, corners, _ = panels[row[1]]
            area = sum(a[0] * b[1] - a[1] * b[0] for a, b in pairs(corners)) / 2
            around = sum(far(a, b) for a, b in pairs(corners))
            wide, high = [max(p[k] for p in corners) - min(p[k] for p in corners) for k in (0, 1)]
            good = [abs(float(x) / y - 1) < 1e-11 for x, y in zip(row[4:8], (area, around, wide, high))]
            check(all(good) and int(row[2]) == sheet + 1 and int(row[3]) == len(corners) and float(row[8]) < 1e-6 * around, f"row {row}")
            count += 1
        elif not row[1].startswith("S"):
            lengths[int(row[1]), int(row[2]), int(row[3])] = float(row[5]), row[4], row[6]
    check(count == len(panels) and len(lengths) == sum(map(len, faces)), "rows of the table")
    for (f, a, b), (length, other, angle) in lengths.items():
        check(abs(length / far(points[a], points[b]) - 1) < 1e-12, f"length of {a}-{b} in panel {f}")
        if other: check(abs(lengths[int(other), b, a][0] / length - 1) < 1e-12 and lengths[int(other), b, a][2] == angle or
                        abs(float(lengths[int(other), b, a][2]) - float(angle)) < 1e-9, f"side {a}-{b} of panels {f} and {other}")


def main():
    files = {}
    for path in sys.argv[3:]: files[path.rsplit(".", 1)[1]] = path
    points, faces = read_obj(sys.argv[2], float(sys.argv[1]))
    panels, size, root = read_svg(files["svg"])
    check(root.get("width").endswith("mm") and root.get("width")[:-2] == root.get("viewBox").split()[2], "millimetres")
    strips = read_obj(files["obj"], float(sys.argv[1])) if "obj" in files else ([], [])
    check(len(panels) == len(faces) + len(strips[1]), "panels")
    check_faces(points, faces, panels)
    for e, face in enumerate(strips[1]):
        sheet, corners, words = panels[f"S{e}"]
        check_panel(f"S{e}", [strips[0][v] for v in face], corners, words)
        check(len(words) == 4 and [w[0][0] for w in words].count("V") == 2, f"words of strip {e}")
    check_sheets(panels, size)
    if "dxf" in files: check_dxf(files["dxf"], panels, size)
    check_csv(files["csv"], panels, points, faces)
    print(f"{len(panels)} passed, {failed} failed")
    sys.exit(failed > 0)


main()
