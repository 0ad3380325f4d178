"""How the measures of a contact run along the edge: for a mean, and for a plot."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace
from typing import Any

import numpy as np

from semispline.solver.arrays import FloatArray
from semispline.solver.errors import InputError
from semispline.solver.judge.base import Base, local_origin
from semispline.solver.judge.contact import Contact, Place
from semispline.solver.judge.correspondence import Correspondence
from semispline.solver.judge.edge_normals import beside_poles
from semispline.solver.judge.edge_samples import Edges
from semispline.solver.judge.sections import just_inside

# Places along the edge, about; and in each span, at the least.
_PLACES, _LEAST = 400, 8
# The measures, numbered as in `Samples`, each with the place where it is worst; of the absolute ones the relative one.
_KINDS = (
    ("gap", "gap_at", None),
    ("angle_degrees", "angle_at", None),
    ("curvature_jump", "curvature_at", "curvature_jump_relative"),
    ("rate_jump", "rate_at", "rate_jump_relative"),
    ("second_rate_jump", "second_rate_at", "second_rate_jump_relative"),
)


@dataclass(frozen=True, eq=False)
class Profile:
    """Measures at places along edge a, in order, those where each is worst among them.

    Attributes
    ----------
    parameter : ndarray, shape (K,)
        Along edge a.
    points : ndarray, shape (K, 3)
        On edge a.
    length : ndarray, shape (K,)
        Of the edge from its start, model units, as that of chords.
    values : mapping
        Name of a measure, as `Contact` has it -> ndarray, shape (K,); not a number where a side has no proper
        normal, as in a pole and all but in it.
    """

    parameter: FloatArray
    points: FloatArray
    length: FloatArray
    values: Mapping[str, FloatArray]

    @property
    def means(self) -> dict[str, float]:
        """Mean of each measure over the length of the edge, as far as it is a number; else not a number."""
        return {name: _mean(value, self.length) for name, value in self.values.items()}

    @property
    def left_out(self) -> int:
        """At how many places a side has no proper normal: there only the gap is a number."""
        return int(np.isnan(self.values["angle_degrees"]).sum())


def _mean(value: FloatArray, length: FloatArray) -> float:
    known = ~np.isnan(value)
    value, length = value[known], length[known]
    if not len(value):
        return float("nan")
    total = length[-1] - length[0]
    return float(np.trapezoid(value, length) / total) if total > 0 else float(value.mean())


def measure_profile(a: Base, b: Base, contact: Contact) -> Profile:
    """Measure along two edges what `measure_contact` found the worst of.

    Parameters
    ----------
    a, b : Base
        As they were measured.
    contact : Contact
        What `measure_contact` returned for them: the same points of the edges are compared.

    Raises
    ------
    InputError
        The contact is not one of these edges.

    Examples
    --------
    >>> from semispline.solver.judge.continuity import measure_contact
    >>> from semispline.solver.splines.surfaces import BSplineSurface
    >>> k = [0, 0, 1, 1]
    >>> left = BSplineSurface(1, 1, k, k, [[[0, 0, 0], [0, 4, 0]], [[1, 0, 0], [1, 4, 0]]])
    >>> right = BSplineSurface(1, 1, k, k, [[[1, 0, 0], [1, 4, 1]], [[2, 0, 0], [2, 4, 1]]])
    >>> first, second = Base(left, "u1"), Base(right, "u0")
    >>> profile = measure_profile(first, second, measure_contact(first, second))
    >>> round(float(profile.length[-1]), 5), round(profile.means["gap"], 12)
    (4.0, 0.5)
    """
    order = 2 + (contact.rate_at is not None) + (contact.second_rate_at is not None)
    edges = Edges(a, b, Correspondence(contact.flipped, contact.shift), local_origin(a.surface, b.surface), order)
    if contact.corresponds == "affine":
        pairs = edges.affine_pairs()
    else:
        feet = edges.foot_pairs(2 * max(contact.gap, contact.allowed["gap"]))
        if feet is None:
            raise InputError("contact: found one by foot points, which these edges do not have; give its own edges")
        pairs = feet
    kinds = _KINDS[: order + 1]
    worst = [getattr(contact, place).parameter for _, place, _ in kinds]
    s = np.unique(np.concatenate([_places(pairs.breaks), worst]))
    found = edges.values(s, pairs.along_b(s), range(len(kinds)))
    for base, at, name in ((a, s, "a"), (b, pairs.along_b(s), "b")):
        places = [place for place in contact.no_normal if place.surface == name]
        found[1:, beside_poles(base, at, places)] = np.nan
    values = {}
    for (name, _, relative), value in zip(kinds, found, strict=True):
        values[name] = value
        if relative is not None:
            most = getattr(contact, name)
            # Both have one scale all along.
            values[relative] = value * (getattr(contact, relative) / most if most else 0.0)
    points = edges.curves_a.points(s, 0)[0, 0]
    return Profile(s, points + edges.origin, chord_lengths(points), values)


def chord_lengths(points: FloatArray) -> FloatArray:
    """Return the length of a polygon from its start to each of its points."""
    return np.append(0.0, np.cumsum(np.linalg.norm(np.diff(points, axis=0), axis=1)))


def edge_length(base: Base) -> float:
    """Return the length of an edge, as that of chords."""
    return float(chord_lengths(base.derivative(_places(base.breakpoints_along()), 0, 0))[-1])


def with_worse(contact: Contact, profile: Profile) -> Contact:
    """Return the contact with what its profile shows to be worse: rounding, which is another at each place."""
    worse: dict[str, Any] = {}
    for name, at, relative in _KINDS:
        if name not in profile.values:
            continue
        value = profile.values[name]
        k = int(np.nan_to_num(value, nan=-np.inf).argmax())
        if value[k] > getattr(contact, name):
            x, y, z = profile.points[k].tolist()
            worse |= {name: float(value[k]), at: Place(float(profile.parameter[k]), (x, y, z))}
            if relative is not None:
                worse[relative] = float(profile.values[relative][k])
    return replace(contact, **worse)


def _places(breaks: FloatArray) -> FloatArray:
    """Return places in every span, just inside of its ends: at a knot the two sides may be seen from other spans."""
    after, before = just_inside(breaks)
    share = np.diff(breaks) / (breaks[-1] - breaks[0])
    counts = np.maximum(_LEAST, np.ceil(_PLACES * share)).astype(int)
    parts = [np.linspace(a, b, n) for a, b, n in zip(after, before, counts.tolist(), strict=True)]
    return np.concatenate(parts)
