"""Chains in the place of bases: what is blended for them, and what is said of the blend on their faces."""

from __future__ import annotations

from collections.abc import Callable, Sequence
from dataclasses import dataclass, replace
from typing import cast

from semispline.solver.blending.chain_coefficients import Joint
from semispline.solver.blending.chain_contact import chain_contact
from semispline.solver.blending.chain_rims import facing_rims
from semispline.solver.blending.chain_runs import facing_chains
from semispline.solver.blending.chains import Chain, Strip, order_of_contact
from semispline.solver.blending.end_faces import HeldEnd
from semispline.solver.blending.result import BlendResult
from semispline.solver.errors import OptionError
from semispline.solver.judge import Base, Correspondence
from semispline.solver.options import BlendOptions


@dataclass(frozen=True, eq=False)
class StatedBases:
    """Two bases to be blended, strips in the place of chains.

    Attributes
    ----------
    a, b : Base
    options : BlendOptions
    chains : pair of Chain or None
        As they are run through.
    strips : pair of Strip or None
    matched : Correspondence or None
        How the edges correspond, where corners or joints of both say so.
    lines_answer : bool
        Lines at which rows are only continuous are left: those of both answer each other.
    """

    a: Base
    b: Base
    options: BlendOptions
    chains: tuple[Chain | None, ...] = (None, None)
    strips: tuple[Strip | None, ...] = (None, None)
    matched: Correspondence | None = None
    lines_answer: bool = False

    @property
    def held(self) -> tuple[HeldEnd, ...]:
        """The planes in which chain a ends, seen along a."""
        faces = (None, None) if self.chains[0] is None else self.chains[0].ends_on
        return tuple(HeldEnd(k, face.normal) for k, face in enumerate(faces) if face is not None and face.is_flat)

    @property
    def shown(self) -> tuple[Base, Base]:
        """Both bases as wide as the faces are: what the blend may run into."""
        a, b = (
            base if strip is None else Base(strip.shown, "u0")
            for base, strip in zip((self.a, self.b), self.strips, strict=True)
        )
        return a, b

    @property
    def cuts(self) -> tuple[tuple[float, ...], tuple[float, ...]]:
        """Where the pieces of both chains begin and end, along the bases."""
        a, b = (() if strip is None else strip.cuts for strip in self.strips)
        return a, b

    @property
    def joints(self) -> tuple[Joint, ...]:
        """The joints of both chains."""
        return tuple(joint for strip in self.strips if strip for joint in strip.joints if joint is not None)


def as_bases(a: Base | Chain, b: Base | Chain, options: BlendOptions) -> StatedBases:
    """Return what is blended: a strip for each chain, and smooth runs of both that answer each other.

    Raises
    ------
    EdgeError
        As `Chain.strip`.
    OptionError
        C1 or C2 at a chain, or pairs of `match` that are not on it.
    """
    if not isinstance(a, Chain) and not isinstance(b, Chain):
        return StatedBases(a, b, options)
    if isinstance(a, Chain) and isinstance(b, Chain) and (rims := facing_rims(a, b, options)):
        return _as_rims(*rims, options)
    facing = facing_chains(a, b, options.flip) if isinstance(a, Chain) and isinstance(b, Chain) else None
    strips: list[Strip | None] = [None, None]
    for k, one in enumerate(facing or (a, b)):
        if isinstance(one, Chain):
            lengths = strips[0].lengths if facing and strips[0] is not None else None
            strips[k] = one.strip(order_of_contact(options.continuities[k], "ab"[k]), lengths)
    if isinstance(options.match, tuple):
        options = replace(options, match=_pairs_along(strips, options.match, facing is not None))
    base_a, base_b = (cast("Base", x) if strip is None else strip.base for x, strip in zip((a, b), strips, strict=True))
    chains = tuple(x if isinstance(x, Chain) else None for x in facing or (a, b))
    matched = Correspondence(flipped=False) if facing else None
    return StatedBases(base_a, base_b, options, chains, tuple(strips), matched)


def _as_rims(a: Chain, b: Chain, options: BlendOptions) -> StatedBases:
    """Return rims whose joints answer each other, as they are."""
    orders = [order_of_contact(wanted, name) for wanted, name in zip(options.continuities, "ab", strict=True)]
    one = a.rim(orders[0])
    other = b.rim(orders[1], one.spans)
    options = replace(options, middle_curves=0)
    return StatedBases(
        one.base, other.base, options, (a, b), (one, other), Correspondence(flipped=False), lines_answer=True
    )


def _pairs_along(
    strips: Sequence[Strip | None], pairs: Sequence[tuple[float, float]], facing: bool
) -> tuple[tuple[float, float], ...]:
    """Return pairs of what answers what with places on a chain, k + s, as parameters of its strip."""
    if facing:
        raise OptionError("match: found pairs for chains whose corners answer each other, expected affine or length")
    ways: list[Callable[[float], float]] = [(lambda x: x) if strip is None else strip.place for strip in strips]
    return tuple((ways[0](x), ways[1](y)) for x, y in pairs)


def on_chains(result: BlendResult, stated: StatedBases) -> BlendResult:
    """Return the blend with its contacts measured on the faces of the chains.

    Raises
    ------
    ContactError
        On a face the contact misses its limits.
    """
    contacts = [
        None
        if one is None or strip is None
        else chain_contact(one, strip, result.surface, which, wanted, stated.options.limits, whole)
        for one, strip, which, wanted, whole in zip(
            stated.chains, stated.strips, "ab", result.continuity, (result.contact_a, result.contact_b), strict=True
        )
    ]
    if contacts == [None, None]:
        return result
    corners = [0 if one is None else one.corners for one in contacts]
    fades = corners[0] != corners[1]
    chain_a, chain_b = (None if one is None else replace(one, fades=fades) for one in contacts)
    names = [edge if one is None else "+".join(one.edges) for edge, one in zip(result.edges, contacts, strict=True)]
    return replace(result, edges=(names[0], names[1]), chain_a=chain_a, chain_b=chain_b)
