"""self_supporting_roof.py - ../self_supporting_roof.c in Python: planar panels that stand by compression alone, Figures 1, 2
and 11 of "Form-finding with Polyhedral Meshes Made Simple" (2014).

A canopy of quads on one flared foot, which overhangs its own foot. The boundary glides on its curves and is supported
there; panels become planar, edges carry the load of the panels through compression alone. Reference is the design, with
the wishes and weights of the paper. Run it: python3 self_supporting_roof.py [FILE.obj]"""
import sys
from math import cos, pi, sin

import numpy as np

import guidedproj
from guidedproj import Outcome

AROUND, ALONG = 50, 18


def canopy(i, j):
    """Places vertex j of ring i: a trumpet with a foot, and a rim with five high arches."""
    t, turn = i / ALONG, 2 * pi * j / AROUND
    r, z = 2.3 - 4.2 * t + 6.6 * t * t, 4.2 * sin(2.2 * t)
    return 1.15 * r * cos(turn), r * sin(turn), z + 0.4 * t * t * t * cos(5 * turn)


# %% The design: closed rings of quads, and the foot and the rim as supports.

number = np.arange((ALONG + 1) * AROUND).reshape(ALONG + 1, AROUND)
right = np.roll(number, -1, axis=1)
V = [canopy(i, j) for i in range(ALONG + 1) for j in range(AROUND)]
F = np.stack([number[:-1], number[1:], right[1:], right[:-1]], axis=-1).reshape(-1, 4)
form = guidedproj.Form(V, F)

# %% What must hold, and what is wished.

form.add_planarity()
form.add_equilibrium(area_load=1, supports=np.concatenate([number[0], number[-1]]))
form.add_compression()
form.add_gliding_boundary()
form.add_reference(guidedproj.Surface(form.mesh), 0.1)
form.add_equal_areas(0.001)
form.set_schedule(form.add_fairness(1), guidedproj.schedule(1, decay=0.9, last=10))
result = form.solve(24)
if result.outcome != Outcome.CONVERGED:
    sys.exit(result.message)

# %% Does it stand?

forces, measures = form.measure_forces(), form.mesh.measure(V)
print(f"panels planar           {'to 1e-12 mean edge lengths' if measures.planarity_max <= 1e-12 else 'no'}")
print(f"every vertex stands     {'to 1e-9 of its load' if forces.residual <= 1e-9 else 'no'}")
print(f"compression alone       {'yes' if forces.min_density >= -1e-9 * forces.max_density else 'no'}")
print(f"largest force           {100 * forces.max_force / forces.total_load:.0f} % of the load")
print(f"the design moved by     {100 * measures.deviation_max:.0f} % of its size at most")
print(f"folded edges            {measures.folded_edges}")
for path in sys.argv[1:]:
    form.mesh.save(path)
