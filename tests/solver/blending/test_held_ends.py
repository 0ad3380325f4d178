"""Free rows held in planes at their ends: they lie there, and nothing costs less."""

from dataclasses import replace

import numpy as np
import pytest

from helpers.chains import arc, line, walls
from semispline.solver.blending import EndFace, chain
from semispline.solver.blending.chain_bases import as_bases
from semispline.solver.blending.held_ends import HeldSystem
from semispline.solver.blending.placing import place_sides
from semispline.solver.blending.problem import make_problem
from semispline.solver.options import BlendOptions

# Roundings of coordinates of size 1, of two solves of some dozen unknowns.
ROUNDED = 1e-12
# Walls over quarters of circles between the planes y = 0 and x = 0, over lines between y = 0 and 2 x + y - z = 1.
QUARTER = (
    walls([arc((0, 0), 1.0, 0, 90)]),
    walls([arc((0, 0), 2.0, 0, 90)], base=3.0, height=2.0),
    [(0, 1, 0), (1, 0, 0)],
)
SLANTED = (
    walls([line((2, 0), (-1, 3))]),
    walls([line((3, 0), (-0.5, 5))], base=3.0, height=2.0),
    [(0, 1, 0), (2, 1, -1)],
)


def stated(faces, others, normals, middle_curves):
    """The problem with its ends held, and its points."""
    ends = tuple(EndFace.plane(np.array(n, dtype=float)) for n in normals)
    options = BlendOptions(middle_curves=middle_curves)
    bases = as_bases(replace(chain(faces), ends_on=ends), replace(chain(others), ends_on=ends), options)
    placed = place_sides(bases.a, bases.b, bases.options, "no", bases.matched, held=bases.held)
    problem = make_problem(*placed.scaled, bases.options)
    return problem, problem.control_points(*problem.start)


@pytest.mark.parametrize(("faces", "others", "normals"), [QUARTER, SLANTED])
@pytest.mark.parametrize("middle_curves", [1, 12])
def test_rows_end_in_their_planes_and_nothing_costs_less(faces, others, normals, middle_curves):
    problem, points = stated(faces, others, normals, middle_curves)
    assert problem.is_rational is (faces is QUARTER[0])
    system, offsets = problem.free_system, problem.form.offsets
    assert isinstance(system, HeldSystem)
    places = points[:, :3] / points[:, 3:] if problem.is_rational else points
    plain = system.system.completed(points)
    loose = plain[:, :3] / plain[:, 3:] if problem.is_rational else plain
    for end, normal in enumerate(np.array(normals, dtype=float)):
        first = offsets[0] if end == 0 else offsets[1] - 1
        at = [offsets[row] if end == 0 else offsets[row + 1] - 1 for row in problem.free_rows]
        assert np.abs((places[at] - places[first]) @ normal).max() < ROUNDED
        # Control: free they would not.
        assert np.abs((loose[at] - loose[first]) @ normal).max() > 1e-5
    # Whatever pulls is at the ends, along the normals.
    gradient, _ = system.system.gradient_of(points)
    held = {}
    for end, normal in enumerate(np.array(normals, dtype=float)):
        for row in problem.free_rows:
            place = (offsets[row] if end == 0 else offsets[row + 1] - 1) - system.free.start
            held[place] = normal / np.linalg.norm(normal)
    largest = max(np.linalg.norm(gradient[place]) for place in held)
    for place, pull in enumerate(gradient):
        left = pull - (pull @ held[place]) * held[place] if place in held else pull
        assert np.linalg.norm(left) < 1e-8 * largest
    assert system.excess(points) < ROUNDED
