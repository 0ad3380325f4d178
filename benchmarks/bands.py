"""Bands along free curves: control points, rounds of limits met, cost, on known and random faces and in files.

    python benchmarks/bands.py [FILE ...]

writes docs/bands.md. Files are STEP, IGES or BREP; only read.
"""

from __future__ import annotations

import sys
from collections import defaultdict
from collections.abc import Iterator
from dataclasses import replace
from pathlib import Path
from time import process_time

import numpy as np

# The curves are those of the tests.
sys.path.insert(0, str(Path(__file__).parents[1] / "tests"))

from helpers.free_curves import cylinder, free_form, loop, open_curve, round_curve, sphere, torus
from semispline import BSplineCurve, BSplineSurface, SemisplineError, blend, plane, transform
from semispline.solver.judge import measure_face_contact
from semispline.solver.topology.band_measures import row_jet
from semispline.solver.topology.band_search import BandFit, band_limits, fit_band
from semispline.solver.topology.bands import band_along
from semispline.solver.topology.curve_pieces import CurvePiece, pieces
from semispline.solver.topology.face_curves import FaceCurve, curve_on_face, edge_on_face
from semispline.solver.topology.face_jets import Face
from semispline.solver.topology.reading import read_edges
from semispline.solver.topology.trim_curves import read_trim_curves

ROOT = Path(__file__).parents[1]
DEGREES = (3, 5, 7)


def closed_curves() -> Iterator[tuple[str, BSplineSurface, BSplineCurve]]:
    """Yield the closed curves of the table: a name, the face, the curve in space."""
    t = np.linspace(0, 2 * np.pi, 801)
    c, s = np.cos(t), np.sin(t)

    def curve(*xyz: object) -> BSplineCurve:
        return round_curve(np.stack(np.broadcast_arrays(*xyz), axis=1))

    yield "plane, circle r 10", plane([-20, -20, 0], [40, 0, 0], [0, 40, 0]), curve(10 * c, 10 * s, 0)
    for degrees in (30, 60):
        slope = np.tan(np.radians(degrees))
        yield f"cylinder r 10, plane at {degrees} degrees", cylinder(), curve(10 * c, 10 * s, 10 * c * slope)
    for r in (6, 9):
        yield f"cylinder r 10, cylinder r {r}", cylinder(), curve(np.sqrt(100 - (r * c) ** 2), r * c, r * s)
    radius = 44.9 / 2 / np.pi
    n = np.array([1, 0.5, 0.4]) / np.linalg.norm([1, 0.5, 0.4])
    a = np.cross(n, [0, 0, 1]) / np.linalg.norm(np.cross(n, [0, 0, 1]))
    tilted = np.sqrt(100 - radius**2) * n + radius * (c[:, None] * a + s[:, None] * np.cross(n, a))
    yield "sphere r 10, plane off the axis", sphere(), curve(*tilted.T)
    x, y = 4 * c + 3, 4 * s
    yield "sphere r 10, cylinder r 4 off centre", sphere(), curve(x, y, np.sqrt(100 - x**2 - y**2))
    # Where the plane x = 22 cuts the torus: along each ray from (22, 0, 0), by bisection.
    low, high = np.zeros_like(t), np.full_like(t, 40.0)
    for _ in range(60):
        q = (low + high) / 2
        outside = (np.hypot(22, q * c) - 20) ** 2 + (q * s) ** 2 > 36
        low, high = np.where(outside, low, q), np.where(outside, q, high)
    yield "torus 20/6, plane x = 22", torus(), curve(22, q * c, q * s)


def single(curve: FaceCurve) -> CurvePiece:
    """Return the only piece of a curve."""
    (piece,), _ = pieces(curve, 1.0, 1e-6)
    return piece


def fitted(piece: CurvePiece, degree: int, **loose: float) -> BandFit:
    """Return the fit of a degree within the limits, some of them loosened."""
    limits = replace(band_limits(piece.length, 0.0, None), **loose)
    return fit_band(piece, limits, 2, degree)


def of_the_curve(fit: BandFit) -> tuple[float, float]:
    """Return by how much the first row alone leaves the tangent planes, in degrees, and the curvature along."""
    v = np.linspace(0, fit.piece.length, 4001)
    at = fit.piece.sections(v, 2)
    jet = row_jet(fit.degree, fit.knots, fit.rows, v, 2)
    slope, bend = (np.einsum("kd,kd->k", jet[0, k], at.normal) for k in (1, 2))
    largest = max(float(np.abs(at.bends).max()), 1e-3 / fit.piece.face.size)
    return float(np.degrees(np.abs(slope).max())), float(np.abs(bend - at.bends[0]).max() / largest)


def closed_table() -> Iterator[str]:
    """Yield a row for each closed curve: degrees of freedom for each degree, and what position alone leaves."""
    yield "| closed curve | L | q 3 | q 5 | q 7 | gap / L, q 5 | position alone, q 3: points, degrees, along |"
    yield "|---|---:|---:|---:|---:|---:|---|"
    for name, face, curve in closed_curves():
        piece = single(edge_on_face(Face(face), curve, None, 0.0))
        fits = {q: fitted(piece, q) for q in DEGREES}
        loose = fitted(piece, 3, angle_degrees=1e3, curvature=1e3)
        counts = " | ".join(str(fit.rows.shape[1] - q) + ("" if fit.is_good else ", missed") for q, fit in fits.items())
        gap = fits[5].largest("gap") / piece.length
        angle, along = of_the_curve(loose)
        left = f"{loose.rows.shape[1] - 3}, {angle:.2g}, {100 * along:.2g} %"
        yield f"| {name} | {piece.length:.1f} | {counts} | {gap:.1e} | {left} |"


def random_table(count: int = 40) -> Iterator[str]:
    """Yield a row for each kind of curve and degree, over random faces."""
    yield "| random free forms | q | bands | points: median, 90 %, most | missed | off / L, most |"
    yield "|---|---:|---:|---|---:|---:|"
    for name, kind in (("open, cubic pcurves", open_curve), ("closed wavy loops", loop)):
        for q in (3, 5):
            fits, off = [], []
            for seed in range(count):
                rng = np.random.default_rng(seed)
                face = free_form(rng, (3, 5)[seed % 2], int(rng.integers(6, 11)))
                piece = single(curve_on_face(Face(face), kind(rng)))
                fits.append(fitted(piece, q))
                off.append(fits[-1].largest("off") / piece.length)
            n = [fit.rows.shape[1] for fit in fits]
            missed = sum(not fit.is_good for fit in fits)
            spread = ", ".join(f"{x:.0f}" for x in np.quantile(n, [0.5, 0.9, 1.0]))
            yield f"| {name} | {q} | {count} | {spread} | {missed} | {max(off):.1e} |"


def cost(count: int = 20) -> str:
    """Return the cost of two bands over that of the blend between them, and how well the blend meets the faces."""
    ratios, worst = [], [0.0, 0.0]
    for seed in range(count):
        rng = np.random.default_rng(seed)
        faces = [free_form(rng, 5, 6), transform(free_form(rng, 5, 6), np.eye(3), [0, 9, 5])]
        curves = [BSplineCurve(3, [0] * 4 + [1] * 4, points) for points in (wave(rng, 0.7), wave(rng, 0.3))]
        start = process_time()
        (a,), (b,) = (band_along(f, c, side) for f, c, side in zip(faces, curves, ("right", "left"), strict=True))
        made = process_time()
        result = blend(a.base, b.base)
        ratios.append((made - start) / (process_time() - made))
        for face, edge in zip(faces, ("u0", "u1"), strict=True):
            seen = measure_face_contact(type(a.base)(result.surface, edge), face)
            worst = [max(worst[0], seen.angle_degrees), max(worst[1], seen.curvature_jump_relative)]
    return (
        f"Two bands with their checks cost {np.median(ratios):.2f} times the blend between them (median of {count} "
        f"pairs of biquintic faces, most {max(ratios):.2f});\non the true faces these blends are off by at most "
        f"{worst[0]:.2g} degree and {100 * worst[1]:.2g} % of curvature."
    )


def wave(rng: np.random.Generator, height: float) -> list[tuple[float, float]]:
    """Return control points of a curve along the side of a face."""
    return [(x, height + rng.uniform(-0.1, 0.1)) for x in (0.1, 0.35, 0.65, 0.9)]


def file_table(files: list[Path]) -> Iterator[str]:
    """Yield a row for each kind of face with the free edges of files, and a line for each that is missed."""
    points: dict[str, list[int]] = defaultdict(list)
    missed: dict[str, list[str]] = defaultdict(list)
    times = []
    for path in files:
        graph = read_edges(path)
        uses, kinds = graph.uses, np.array(graph.faces.kind)
        ends = graph.faces.ends[uses.face]
        widths = np.stack([ends[:, 1] - ends[:, 0], ends[:, 3] - ends[:, 2]], axis=1)
        free = (np.ptp(uses.uv, axis=1) > 1e-4 * widths).all(axis=1) & ~uses.degenerate
        free &= graph.faces.repeat[uses.face] == uses.face
        for face in np.unique(uses.face[free]).tolist():
            numbers = uses.number[free & (uses.face == face)].tolist()
            for curve in read_trim_curves(path, [(face, number) for number in numbers]):
                start = process_time()
                try:
                    points[kinds[face]] += [band.points for band in curve.bands()]
                except SemisplineError as error:
                    missed[kinds[face]].append(f"{path.name}, {error}")
                times.append(process_time() - start)
    yield f"| free edges of {len(files)} files | bands | points: median, most | edges missed |"
    yield "|---|---:|---|---:|"
    for kind in sorted(points.keys() | missed.keys()):
        n = points[kind]
        yield f"| {kind} | {len(n)} | {np.median(n):.0f}, {max(n)} | {len(missed[kind])} |"
    yield ""
    yield f"Time of a band: median {np.median(times):.2f} s, most {max(times):.2f} s of processor time."
    lines = [line for kind in sorted(missed) for line in missed[kind]]
    if lines:
        yield ""
        yield "Missed:"
        yield ""
        yield from (f"- {line}" for line in lines)


HEAD = """# Bands

Made by `python benchmarks/bands.py FILES`; do not edit. A band is a B-spline surface with the position, normal and
curvature of a face along a free trim curve; blends are exact to it. Limits: gap and off the curve 1e-5 of its length L
(0.001 mm at the most where the file has a unit; off the curve the edge's tolerance), 0.01 degree, 2 % of curvature
across, along and mixed.

`blend PART#N B --edge-a e3` takes such an edge, as `list PART --edges N` numbers it, and so does `near=x,y,z`; of a
face that is cut by the edge only the band is blended, and the blend is exact to that. Then the face itself is measured
at the blend's own edge: *gap to the face*, *off the trim curve*, angle and curvature stand in the result (`band_a`,
`band_b`) and in the report, with where the curve comes from: the feet of the edge in space, or, where the edge is
further from the face than its tolerance, the curve in the parameters. What misses a limit is refused.

- `--limits exact`: as between any two surfaces. The default for planes, whose bands are flat; only *off* is
  approximate.
- `--limits cad`: the limits above. The default for all other faces, for which `exact` is refused.
- A curve is cut at its corners and where the face's curvature jumps across it. Each part is a blend of its own,
  `e3[0]`, `e3[1]`, .. from its start, written into one file (`.json`: numbered ones). Parts of A and B go together by
  place; where their numbers differ, or the places do not tell, name one of each: `--edge-a e3[0] --edge-b u1[0,0.5]`.
- `check` measures on the face itself, without a band: against an edge of any surface, or the free edge of another face.
- Above 90 degrees the blend folds back over the face. 3dm files show no curves in the parameters: feet are taken.

- *q*: degree along the curve; numbers of closed curves are degrees of freedom of a row, of others its control points
- *position alone*: fitted with the gap and off as the only limits
"""


def main() -> None:
    """Write the document."""
    files = [Path(x) for x in sys.argv[1:]]
    parts = ["\n".join(closed_table()), "\n".join(random_table()), cost()]
    if files:
        parts.append("\n".join(file_table(files)))
    (ROOT / "docs" / "bands.md").write_text(HEAD + "\n" + "\n\n".join(parts) + "\n", "utf-8")


if __name__ == "__main__":
    main()
