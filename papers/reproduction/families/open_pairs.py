"""Random bicubic bases that face each other, and such that turn away from each other (U-turns)."""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from semispline.papers.reproduction.families.problems import Family, PairMeasures, ShapeProblem, measure_pair, on_edge
from semispline.solver.arrays import FloatArray
from semispline.solver.splines import BSplineSurface, clamped, greville

# Inner knots along and across a contact, at most.
ALONG, ACROSS = 5, 2
GAPS = (0.2, 2.0)
EXITS: dict[Family, tuple[float, float]] = {"facing": (0.0, 80.0), "u-turn": (90.0, 150.0), "rough": (0.0, 80.0)}
# Parameter domains spread over so many decades.
DECADES = 2.0
# The way out keeps so far from the edge itself: closer to it a base is a sliver.
LEAST_TO_EDGE = 25.0
_NUMBERS: dict[Family, int] = {"facing": 1, "u-turn": 2, "rough": 4}


@dataclass(frozen=True)
class _Roughness:
    """How far bases are from even ones.

    Attributes
    ----------
    bow : float
        How far a contact leaves its chord, as an arch and as an S, in each of three directions.
    depth : float
        How far a base reaches at the least, in contact lengths; across this way it bends by up to 60 degrees.
    uneven : float
        c of the way s + c s^2 that is run through across, at most; -0.4 at the least.
    dent : float
        Of control points, in the least distance between their rows.
    """

    bow: float
    depth: float
    uneven: float
    dent: float


_EVEN, _ROUGH = _Roughness(0.06, 0.5, 1.0, 0.08), _Roughness(0.12, 0.3, 1.5, 0.15)


def open_pair(family: Family, seed: int) -> ShapeProblem:
    """Return a pair of random bicubics, contact length about 1.

    Drawn evenly: gap 0.2 to 2 contact lengths, mean exit angle on each side 0 to 80 degrees ("facing") or 90 to 150
    ("u-turn"), to the same side of the chord or to opposite ones, sideways by up to 30 degrees, 0 to 5 inner knots
    along and 0 to 2 across; contacts bow, lean and are twisted against each other by up to 40 degrees; bases bend by up
    to 60 degrees, are dented and run through at uneven speeds; edges and directions at random, logarithms of the
    lengths of domains over two decades. Drawn again until what is measured is within these ranges. The family "rough"
    is "facing" with twice the bows and dents: contacts may turn by half a circle, radii at a contact be a tenth of the
    gap. It is there to see what is said of what nobody can blend well.

    Examples
    --------
    >>> pair = open_pair("u-turn", 3)
    >>> pair.name, pair.kind, round(pair.measures.gap, 2), [round(x) for x in pair.measures.exit_degrees]
    ('u-turn-003', 'exits to the same side', 1.11, [117, 122])
    """
    for attempt in range(1000):
        rng = np.random.default_rng([_NUMBERS[family], seed, attempt])
        same_side = bool(rng.random() < 0.5)
        surfaces = _surfaces(rng, EXITS[family], same_side, _ROUGH if family == "rough" else _EVEN)
        a, b = (on_edge(rng, surface, DECADES) for surface in surfaces)
        measures = measure_pair(a, b)
        if _is_within(measures, EXITS[family]):
            kind = "exits to the same side" if same_side else "exits to opposite sides"
            return ShapeProblem(f"{family}-{seed:03d}", family, kind, seed, a, b, measures)
    raise AssertionError("nearly every second pair is within the ranges")


def _is_within(measures: PairMeasures, exits: tuple[float, float]) -> bool:
    return (
        GAPS[0] <= measures.gap <= GAPS[1]
        and all(exits[0] <= angle <= exits[1] for angle in measures.exit_degrees)
        and measures.least_exit_to_edge_degrees >= LEAST_TO_EDGE
    )


@dataclass(frozen=True, eq=False)
class _Contact:
    """A contact curve, and the frame in which its base leaves it.

    Attributes
    ----------
    bow : ndarray, shape (2, 3)
        How far the curve leaves the straight line, as an arch and as an S.
    along, chord, side : ndarray, shape (3,)
        Unit vectors: along the contact, to the other contact, and square to both.
    centre : ndarray, shape (3,)
    """

    bow: FloatArray
    along: FloatArray
    chord: FloatArray
    side: FloatArray
    centre: FloatArray


def _surfaces(
    rng: np.random.Generator, exits: tuple[float, float], same_side: bool, roughness: _Roughness
) -> tuple[BSplineSurface, BSplineSurface]:
    """Return two bases, each met along u0."""
    gap = rng.uniform(*GAPS)
    # The chord leans by up to 20 degrees along the contacts.
    lean, twist = np.radians(rng.uniform(-20, 20)), np.radians(rng.uniform(-40, 40))
    chord = np.array([np.cos(lean), np.sin(lean), 0.0])
    signs = 1.0, 1.0 if same_side else -1.0
    made = []
    for which, sign in enumerate(signs):
        turned = twist * (which - 0.5)
        along = np.array([0.0, np.cos(turned), np.sin(turned)])
        way = chord if which == 0 else -chord
        side = np.cross(chord, along)
        contact = _Contact(
            roughness.bow * rng.uniform(-1, 1, (2, 3)),
            along,
            way,
            sign * side / np.linalg.norm(side),
            chord * gap * which,
        )
        made.append(_surface(rng, contact, np.radians(rng.uniform(*exits)), gap, roughness))
    return made[0], made[1]


def _surface(
    rng: np.random.Generator, contact: _Contact, exit_angle: float, gap: float, roughness: _Roughness
) -> BSplineSurface:
    knots_u, knots_v = (_knots(rng, int(rng.integers(0, most + 1))) for most in (ACROSS, ALONG))
    s, t = greville(knots_u, 3), greville(knots_v, 3)
    # How far the base reaches; one that reaches towards the other stays short of the middle.
    depth = rng.uniform(roughness.depth, 1.2)
    towards = -np.cos(exit_angle)
    depth = min(depth, 0.45 * gap / towards) if towards > 0 else depth
    uneven = rng.uniform(-0.4, roughness.uneven)
    reach = depth * (s + uneven * s**2) / (1 + uneven)
    bend = np.radians(rng.uniform(-60, 60)) / depth
    angle = exit_angle + np.radians(rng.uniform(-10, 10)) * (2 * t - 1)
    sideways = np.radians(rng.uniform(-30, 30))
    across = np.cross(contact.side, contact.chord)
    lateral = np.cos(sideways) * contact.side + np.sin(sideways) * across
    inwards = -(np.cos(angle)[:, None] * contact.chord + np.sin(angle)[:, None] * lateral)
    normal = np.cross(inwards, contact.along)
    normal /= np.linalg.norm(normal, axis=1)[:, None]
    curve = contact.centre + (t - 0.5)[:, None] * contact.along
    curve = curve + np.stack([4 * t * (1 - t) - 2 / 3, np.sin(2 * np.pi * t)], axis=1) @ contact.bow
    # Along each line across the base runs on an arc of a circle.
    turned = bend * reach[:, None, None]
    net = curve + reach[:, None, None] * (
        np.sinc(turned / np.pi) * inwards + np.sin(turned / 2) * np.sinc(turned / 2 / np.pi) * normal
    )
    dent = rng.uniform(0, roughness.dent) * min(float(np.diff(reach).min()), float(np.diff(t).min()))
    return BSplineSurface(3, 3, knots_u, knots_v, net + rng.uniform(-dent, dent, net.shape))


def _knots(rng: np.random.Generator, n_inner: int) -> FloatArray:
    """Return cubic knots on [0, 1], spans between 1 and 4 times as long as others."""
    ends = np.cumsum(rng.uniform(1, 4, n_inner + 1))
    return clamped(ends[:-1] / ends[-1], 3, 0.0, 1.0)
