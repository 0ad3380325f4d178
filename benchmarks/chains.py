"""Chains of edges blended, and what the same profile costs elsewhere: writes docs/chains.md.

python benchmarks/chains.py
"""

from __future__ import annotations

from collections.abc import Iterator
from math import cos, pi, sin
from pathlib import Path

import numpy as np

from semispline import Base, BlendResult, BSplineCurve, Chain, blend, chain, extrude, ruled

DOCUMENT = Path(__file__).parents[1] / "docs" / "chains.md"
HEAD = """# Chains

Made by `python benchmarks/chains.py`; do not edit. A chain is edges that run end to end, each on its own face, met by a
blend as one contact: one surface, without a crease where the faces have none, in exact contact with each of them.

    blend(chain([Base(wall, "u0"), Base(corner, "u0"), ..]), Base(tube, "v0"), continuity="G2")

- Joints are classed by the equations that have to close there: *smooth*; *creased*, where the faces themselves are, by
  an angle that is said and that the blend inherits; *corner*, where the contact turns by more than a degree: the
  blend bends there, and is cut there when it is written. Corners of two chains answer each other where there are as
  many.
- Where a line meets an arc, curvature along the contact jumps. The blend inherits it, and it fades out to the other
  side.
- A chain that is one conic, such as a cylinder in three arcs, is run through by one smooth circle. Beside lines, arcs
  that are parts of one conic are one arc again, up to a half circle, and lines one line: each true face is measured
  over its own range all the same.
- Faces that are small beside the chain are told by their own rounding, not by that of all of it.
- Rims whose joints answer each other one to one, as around a rounded edge, are taken as they are: straight stretches
  of the blend are extruded, its corners revolved.
- Limits: what coordinates of a face have lost in its file, as far from the origin, no blend brings back: a contact that
  rounding alone may hide is refused by its face, with the number; edges below 1e-4 of the chain leave creases up to
  1e-8 degree.
"""


def arc(centre: tuple[float, float], radius: float, start: float, z: float, turn: float = pi / 2) -> BSplineCurve:
    """Return an arc in a plane of constant z."""
    half, middle = turn / 2, start + turn / 2
    ways = ((start, 1.0), (middle, 1 / cos(half)), (start + turn, 1.0))
    points = [[centre[0] + s * radius * cos(x), centre[1] + s * radius * sin(x), z] for x, s in ways]
    return BSplineCurve(2, [0, 0, 0, 1, 1, 1], points, [1, cos(half), 1])


def rounded_rectangle(x: float, y: float, radius: float, z: float) -> list[BSplineCurve]:
    """Return four arcs around (+-x, +-y), each with the line that follows it."""
    centres = [(x, y), (-x, y), (-x, -y), (x, -y)]
    arcs = [arc(centre, radius, k * pi / 2, z) for k, centre in enumerate(centres)]
    found = []
    for one, following in zip(arcs, arcs[1:] + arcs[:1], strict=True):
        ends = [one.control_points[-1], following.control_points[0]]
        found += [one, BSplineCurve(1, [0, 0, 1, 1], ends)]
    return found


def cut_arcs(x: float, y: float, radius: float, z: float) -> list[BSplineCurve]:
    """Return the same, each arc cut in two at a third of it."""
    centres, found = [(x, y), (-x, y), (-x, -y), (x, -y)], []
    for k, (centre, line) in enumerate(zip(centres, rounded_rectangle(x, y, radius, z)[1::2], strict=True)):
        start, third = k * pi / 2, pi / 6
        found += [arc(centre, radius, start, z, third), arc(centre, radius, start + third, z, 2 * third), line]
    return found


def circle(radius: float, z: float, parts: int) -> list[BSplineCurve]:
    """Return a circle in equal arcs."""
    return [arc((0.0, 0.0), radius, 2 * pi * k / parts, z, 2 * pi / parts) for k in range(parts)]


def extruded(profile: list[BSplineCurve], depth: float) -> Chain:
    """Return the chain of walls that leave a profile along z."""
    return chain([Base(extrude(curve, [0, 0, depth]), "u0") for curve in profile])


def between(one: list[BSplineCurve], other: list[BSplineCurve]) -> Chain:
    """Return the chain of ruled faces that leave a profile towards another."""
    return chain([Base(ruled(a, b), "u0") for a, b in zip(one, other, strict=True)])


def families() -> Iterator[tuple[str, Chain, Base | Chain]]:
    """Yield a name and two sides of each pair."""
    tube = extruded(circle(1.5, 5.0, 4), 2.0)
    profile = rounded_rectangle(3.0, 2.0, 1.0, 0.0)
    yield "prism of 4 planes, 4 arcs; tube", extruded(profile, -2.0), tube
    yield "the same, its arcs cut in two; tube", extruded(cut_arcs(3.0, 2.0, 1.0, 0.0), -2.0), tube
    yield "the same whole, drafted by .2; tube", between(profile, rounded_rectangle(3.0, 2.0, 1.4, -2.0)), tube
    yield "plate outside of it; tube", between(profile, rounded_rectangle(3.0, 2.0, 2.5, 0.0)), tube
    wall = extruded(rounded_rectangle(3.0, 2.0, 2.0, 0.0), -2.0)
    top = between(rounded_rectangle(3.0, 2.0, 1.0, 1.0), rounded_rectangle(3.0, 2.0, 0.5, 1.0))
    yield "rounded rim: walls; top face", wall, top
    square = [[[3, 2, 0], [-3, 2, 0], [-3, -2, 0], [3, -2, 0]], [[1, 1, 5], [-1, 1, 5], [-1, -1, 5], [1, -1, 5]]]
    boxes = []
    for corners, depth in zip(square, (-2.0, 2.0), strict=True):
        ends = zip(corners, corners[1:] + corners[:1], strict=True)
        boxes.append(extruded([BSplineCurve(1, [0, 0, 1, 1], pair) for pair in ends], depth))
    yield "box; box", boxes[0], boxes[1]
    yield "box; tube", boxes[0], tube


def figures(result: BlendResult) -> dict[str, float]:
    """Return the worst of what was measured on the faces, and the worst crease where no face has one."""
    contacts = [one for one in (result.chain_a, result.chain_b) if one is not None]
    corners = [joint for one in contacts for joint in one.joints if joint.kind != "smooth"]
    inside = [crease.angle_degrees for crease in result.creases]
    if result.seam is not None:
        inside.append(result.seam.angle_degrees)
    return {
        "angle": max(one.worst("angle_degrees") for one in contacts),
        "curvature": max(one.worst("curvature_jump_relative") for one in contacts),
        "crease": max(inside, default=0.0) if not corners else float("nan"),
    }


def row(name: str, result: BlendResult) -> str:
    """Return a line of the table."""
    found = figures(result)
    crease = "the corners' own" if np.isnan(found["crease"]) else f"{found['crease']:.0e}"
    rows = result.surface.to_bspline().control_points.shape
    return (
        f"| {name} | {result.rows_stored} | {rows[0]} x {rows[1]} = {result.rows_converted} | {found['angle']:.0e} | "
        f"{found['curvature']:.0e} | {crease} | {len(result.warnings)} |"
    )


def document() -> str:
    """Return the text of docs/chains.md."""
    columns = (
        "points stored | as ordinary B-spline | angle to the faces, degrees | curvature, relative | crease, degrees"
    )
    lines = [HEAD, "## A profile of lines and arcs to a round one", ""]
    lines += [
        "An oval of 4 planes and 4 quarter cylinders (radius 1, 8 by 4), extruded, to a circle of 8 arcs, extruded.",
        "",
        f"| | {columns} | warnings |",
        "|---|---:|---|---:|---:|---:|---:|",
    ]
    for continuity in ("G2", "G3", "G4"):
        oval = extruded(rounded_rectangle(3.0, 1.0, 1.0, 0.0), -3.0)
        lines.append(row(continuity, blend(oval, extruded(circle(1.5, 6.0, 8), 3.0), continuity=continuity)))
    lines += [
        "",
        "A peer's own test files ask for this, profile to profile, G4, and come back with eight patches of 10 x 117 to",
        "10 x 174 points (11,640 in all), up to 0.021 degree off their faces, creased between the patches by up to 3.9",
        "degrees.",
        "",
        "## Families, G2",
        "",
        f"| | {columns} | warnings |",
        "|---|---:|---|---:|---:|---:|---:|",
    ]
    lines += [row(name, blend(a, b)) for name, a, b in families()]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    DOCUMENT.write_text(document())
