"""planarize.py - the first program, ../planarize.c, in Python: flat panels on a free-form roof.

Makes a doubly curved quad mesh whose panels are warped, makes all panels planar with the corners of the roof held, and
prints what was done. Run it: python3 planarize.py [FILE.obj]"""
import sys
from math import cos

import numpy as np

import guidedproj
from guidedproj import Outcome

SIDE = 20  # panels along each side


def canopy(i, j):
    """Places vertex (i, j) of a waved canopy, whose grid lines do not follow the curvature: its panels are warped."""
    x, y = i / SIDE - 0.5, j / SIDE - 0.5
    return 20 * x, 20 * y, 2.2 * cos(6.5 * x) + 1.6 * cos(4.5 * y + 1.5 * x * x) + 1.5 * x * y


# %% The mesh: vertices n x 3, faces m x 4.

number = np.arange((SIDE + 1) ** 2).reshape(SIDE + 1, SIDE + 1)
V = [canopy(i, j) for i in range(SIDE + 1) for j in range(SIDE + 1)]
F = np.stack([number[:-1, :-1], number[1:, :-1], number[1:, 1:], number[:-1, 1:]], axis=-1).reshape(-1, 4)
form = guidedproj.Form(V, F)
before = form.mesh.measure()

# %% What must hold: every panel is planar, and the four corners stay. Of all changes that do it, take the smoothest.

form.add_planarity()
form.add_fixed_corners()
result = form.solve(smooth=True)
if result.outcome != Outcome.CONVERGED:
    sys.exit(f"no flat roof: {result.message}")

# %% What was done.

after = form.mesh.measure(V)
print(f"panels           {len(F)}")
print(f"warped by        {before.planarity_max:.3f} mean edge lengths before")
print(f"all planar       {'to 1e-12 mean edge lengths' if after.planarity_max < 1e-12 else 'no'}")
print(f"vertices moved   {after.displacement_mean:.2f} mean edge lengths on average")
print(f"turned panels    {after.turned_faces}")
for path in sys.argv[1:]:
    form.mesh.save(path)
