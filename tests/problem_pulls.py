"""problem_pulls.py CAGE PULLED: PULLED is the mesh of a problem with "pulls", here by the library called directly.

The cage is subdivided twice and made planar with its corners fixed; then its vertex 4, vertex 10 of the level between and
vertex 30 of the mesh are pulled, one after the other, with a release each."""
import sys

import numpy as np

import guidedproj

cage = guidedproj.Mesh.load(sys.argv[1])
mesh, from_cage = cage.subdivide(levels=2)
_, from_middle = cage.subdivide(levels=2, stencil_level=1)
form = guidedproj.Form(mesh)
form.add_planarity()
form.add_fixed_corners()
form.solve(iterations=200, smooth=True)
for stencil, vertex, by in (from_cage, 4, [0, 0, 0.5]), (from_middle, 10, [0.1, 0, 0.2]), (None, 30, [0, 0.05, -0.1]):
    if stencil is None:
        vertices, weights = [vertex], [1.0]
    else:
        followers = stencil.transpose()
        row = slice(followers.start[vertex], followers.start[vertex + 1])
        vertices, weights = followers.column[row], followers.weight[row]
    before = form.V.copy()
    with form.drag(vertices, weights, start=[0, len(vertices)], position=[[0, 0, 0]]) as drag:
        drag.move([by])
    if np.abs(form.V - before).max() < 0.04:
        sys.exit(f"vertex {vertex} is not pulled")
found = np.array([line.split()[1:4] for line in open(sys.argv[2]) if line.startswith("v ")], float)
print(f"{np.abs(found - form.V).max() / mesh.mean_edge_length():.1e}")
