"""circular_mesh.py - ../circular_mesh.c in Python: nodes at constant distance, section 3.5 of "Form-finding with Polyhedral
Meshes Made Simple" (2014).

A funnel of revolution, bent by an inversion in a sphere, which turns circles into circles, and then dented by wind. Made
planar and circular again, it has a parallel mesh at a constant distance of its nodes, with flat panels between the layers.
Run it: python3 circular_mesh.py [FILE.obj], to save these panels."""
import sys
from math import cos, sin

import numpy as np

import guidedproj
from guidedproj import Outcome

AROUND, HIGH, DISTANCE = 26, 10, 0.2


def funnel(i, j):
    """Places vertex (i, j): row i of the height, column j of three quarters of the way round, so that there is no hole."""
    turn, z = 4.7 * j / AROUND + 0.8, 0.56 * i
    radius = 1.2 + 0.08 * z * z + 0.06 * sin(1.1 * j + 0.9 * i)  # with dents
    centre = np.array([9, 0, 5])
    d = np.array([radius * cos(turn), radius * sin(turn), z]) - centre
    return centre + 60 * d / (d @ d)  # x -> c + r^2 (x - c) / |x - c|^2


def say(what, value):
    print(f"{what:17}  to 1e-9: {'yes' if value <= 1e-9 else 'no'}")


# %% The dented funnel.

number = np.arange((HIGH + 1) * (AROUND + 1)).reshape(HIGH + 1, AROUND + 1)
V = [funnel(i, j) for i in range(HIGH + 1) for j in range(AROUND + 1)]
F = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1).reshape(-1, 4)
form = guidedproj.Form(V, F)
before = form.mesh.measure()

# %% Planar and circular again, fair and close to the dented one.

form.add_planarity()
form.add_circularity()
form.add_fairness(0.02)
form.add_closeness(0.03)
result = form.solve(12)
if result.outcome != Outcome.CONVERGED:
    sys.exit(result.message)

# %% The second layer, and the panels between.

mesh = form.mesh
offset = mesh.vertex_offset(DISTANCE)
support = mesh.support(offset)
after, between = mesh.measure(), mesh.measure_offset(offset)
print(f"before             planar to {before.planarity_max:.2f}, circular to {before.circularity_max:.2f}")
say("panels planar", after.planarity_max)
say("panels circular", after.circularity_max)
say("constant distance", max(DISTANCE - between.vertex_distance_min, between.vertex_distance_max - DISTANCE) /
    after.mean_edge)
say("edges parallel", between.parallel_max)
say("supports planar", support.measure().planarity_max)
print(f"folded edges       {after.folded_edges}, reversed {between.reversed_edges}")
for path in sys.argv[1:]:
    support.save(path)
