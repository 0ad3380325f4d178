"""What a user should look at in the shape of a blend before it is used, in the words of the trade, and what to try."""

from __future__ import annotations

from collections.abc import Iterator, Sequence

from semispline.solver.blending.cures import Cure
from semispline.solver.judge import FOLD_DEGREES, LOOP_DEGREES, Crease, Regularity, ShapeReport
from semispline.solver.options import BlendOptions

# A normal that turns this far within one window is well on its way to a fold.
STEEP_DEGREES = 60.0
# A U-turn whose normal turns this far within one window has a tip to be looked at.
SHARP_TIP_DEGREES = 30.0
# An area element this far below its mean is as good as none.
PINCH = 1e-3
# A blend between closed rims is pinched below this part of the waist of straight rulings.
WAIST = 0.5
# A normal that turns this far across a knot of full multiplicity, in degrees, makes a crease: well below what CAD
# systems take for tangent (0.01 and more), well above the rounding of a surface that is smooth there.
SHARP = 1e-3
# Jumps of curvature above this, relative, are seen in reflections; CAD systems take less for continuous.
BENT = 0.02
_NAMED = 5


def shape_warnings(
    shape: ShapeReport,
    regularity: Regularity,
    creases: Sequence[Crease],
    *,
    options: BlendOptions | None = None,
    cures: tuple[Cure | None, Cure | None] = (None, None),
    inherited: Sequence[Crease] = (),
) -> tuple[str, ...]:
    """Return a warning for each thing that a surface modeller would not keep without a look.

    What is `inherited` from corners and creases of a chain is said with the chain; it explains a turn all the same.

    Options, where they are known, tell what to try first: what was asked for and may be the cause, and alpha fair only
    where it is not that already.
    """
    cause = "" if options is None else _asked_for(options)
    fair = cause + ("alpha fair, " if options is None or set(options.decided().alphas) != {"fair"} else "")
    return (
        *_turns(shape, max((crease.angle_degrees for crease in (*creases, *inherited)), default=0.0), fair),
        *_pinches(shape, regularity, fair),
        *_exits(shape, fair),
        *_meetings(shape, cause),
        *_creased([crease for crease in creases if crease.angle_degrees >= SHARP], cures),
        *_bent([crease for crease in creases if crease.angle_degrees < SHARP]),
    )


def _asked_for(options: BlendOptions) -> str:
    """Return what to try first where a bulge or p2 was given."""
    least, most = min(options.bulges), max(options.bulges)
    tries = ["a smaller bulge"] if most > 1 else ["a larger bulge"] if least < 1 else []
    if not isinstance(options.p2, str) and any(options.p2):
        tries.append("p2 nearer to zero")
    return "".join(f"{one}, " for one in tries)


def _turns(shape: ShapeReport, crease: float, fair: str) -> Iterator[str]:
    turn = shape.turn
    along = "v" if turn.section == "u" else "u"
    where = (
        f"its normal turns by {turn.degrees:.0f} degrees within {turn.window:.3g}, a fiftieth of its length, at "
        f"{turn.section} = {turn.at:.3g}, {along} = {turn.between[0]:.3g}, near {_point(turn.point)}"
    )
    # A turn that a crease explains is no fold.
    if turn.degrees - crease > FOLD_DEGREES:
        yield f"the blend folds: {where}; try {fair}a smaller alpha, the other direction of B, or other edges"
    elif turn.degrees - crease > STEEP_DEGREES:
        yield f"the blend turns steeply: {where}; try {fair}a smaller alpha, or a wider gap there"


def _pinches(shape: ShapeReport, regularity: Regularity, fair: str) -> Iterator[str]:
    if regularity.least_area_ratio < PINCH:
        yield (
            f"the blend is pinched: its area element falls to {regularity.least_area_ratio:.1e} of the mean; try "
            f"{fair}another alpha, or edges that are apart everywhere"
        )
    waist = shape.waist
    if waist is not None and waist.distance < WAIST * waist.of_rulings:
        yield (
            f"the blend is pinched between its rims: opposite points come as close as {waist.distance:.3g} at "
            f"u = {waist.u:.3g}, near {_point(waist.points[0])}, where straight rulings keep {waist.of_rulings:.3g}; "
            f"try {fair}a smaller alpha, or no middle curve"
        )


def _exits(shape: ShapeReport, fair: str) -> Iterator[str]:
    exits, loop = shape.exits, shape.loop
    if exits.must_loop:
        yield (
            "the blend is a U-turn that has to loop: its two exits leave to opposite sides of the line that joins the "
            f"contacts, {exits.theta_0:.0f} and {exits.theta_1:.0f} degrees away from it; turn one of the bases, name "
            "another edge, or blend in two steps"
        )
        return
    # A U-turn of even bend is what was asked for.
    if exits.is_u_turn and shape.turn.degrees > SHARP_TIP_DEGREES:
        yield (
            f"the blend is a U-turn: it leaves its bases {exits.theta_0:.0f} and {exits.theta_1:.0f} degrees away from "
            f"the straight way between the contacts, and turns by {shape.turn.degrees:.0f} degrees at its tip; look at "
            "it, or name edges that face each other"
        )
    if loop.degrees > LOOP_DEGREES:
        yield (
            f"the blend loops or waves: its section v = {loop.v:.3g} turns by {loop.turning_degrees:.0f} degrees, and "
            f"its exits need {loop.needed_degrees:.0f}; try {fair}a smaller alpha, or a box that ends lower"
        )


def _meetings(shape: ShapeReport, cause: str) -> Iterator[str]:
    for meeting in shape.meets.found[:_NAMED]:
        yield f"the blend {meeting}; try {cause}a smaller alpha, or edges with more room between them"
    if (more := len(shape.meets.found) - _NAMED) > 0:
        yield f"the blend meets itself or its bases in {more} more place(s)"


def _creased(sharp: Sequence[Crease], cures: tuple[Cure | None, Cure | None]) -> Iterator[str]:
    if not sharp:
        return
    places = ", ".join(f"{crease.parameter} = {crease.at:g}" for crease in sharp[:_NAMED])
    more = f" and {len(sharp) - _NAMED} more" if len(sharp) > _NAMED else ""
    sharpest = max(crease.angle_degrees for crease in sharp)
    yield (
        f"the blend is creased at {places}{more}, by up to {sharpest:.2g} degrees: knots of full multiplicity, "
        "across which the energy counts nothing; try bases without such knots"
    )
    for name, cure in zip("ab", cures, strict=True):
        for jump in () if cure is None else cure.left:
            if jump.degrees >= SHARP:
                yield f"base {name} itself is creased by {jump.degrees:.2g} degrees at v = {jump.v:.6g}: split it there"


def _bent(smooth: Sequence[Crease]) -> Iterator[str]:
    """Say where the normal does not turn, but curvature jumps inside."""
    bent = [crease for crease in smooth if crease.curvature_jump_relative > BENT]
    if bent:
        worst = max(bent, key=lambda crease: crease.curvature_jump_relative)
        yield (
            f"G1 inside: curvature jumps by up to {100 * worst.curvature_jump_relative:.2g} % at {worst.parameter} = "
            f"{worst.at:g}, from a knot line where a base is no smoother; split the base there, or make it G2"
        )


def _point(point: tuple[float, float, float]) -> str:
    return "(" + ", ".join(f"{x:.4g}" for x in point) + ")"
