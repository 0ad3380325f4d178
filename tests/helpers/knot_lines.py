"""How smooth rows are along, at the least smooth of their knot lines."""

from semispline.solver.blending.knot_lines import knot_lines


def least_continuity(rows, along, *, closed=False):
    """Return how many derivatives of the homogeneous rows agree across every knot line, the degree where all do."""
    lines = knot_lines(rows, along, along.degree, closed=closed)
    return min((line.continuity for line in lines), default=along.degree)
