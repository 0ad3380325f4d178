"""What the commands say of contacts, blends and files: records for JSON, and tables on the terminal.

Heavy imports wait inside the functions, so that `--help` answers fast.
"""

from __future__ import annotations

from collections.abc import Iterator, Mapping, Sequence
from dataclasses import asdict
from math import isfinite
from typing import TYPE_CHECKING, Any, cast

import typer

from semispline.solver.options import Continuity

if TYPE_CHECKING:
    from semispline.solver.blending import BandContact, BlendResult, ChainContact, LinearInV
    from semispline.solver.io import SurfaceEntry
    from semispline.solver.judge import Contact, FaceContact, Meets, ShapeReport


def contact_record(contact: Contact | BandContact | FaceContact) -> dict[str, Any]:
    """Return what a JSON file holds of a measured contact: nothing of what was not asked for."""
    return {name: finite(value) for name, value in asdict(contact).items() if value is not None}


def finite(value: Any) -> Any:
    """Return a value or record for JSON, which knows neither NaN nor infinity: what cannot be told is null."""
    if isinstance(value, dict):
        return {name: finite(part) for name, part in value.items()}
    if isinstance(value, list):
        return [finite(part) for part in value]
    return None if isinstance(value, float) and not isfinite(value) else value


def reports_record(results: Sequence[BlendResult]) -> dict[str, Any]:
    """Return what `blend --report` writes: of one blend, or of those of the parts of an edge."""
    if len(results) == 1:
        return report_record(results[0])
    return {
        "format": "semispline/1",
        "kind": "blend_reports",
        "parts": [report_record(result) for result in results],
    }


def report_record(result: BlendResult) -> dict[str, Any]:
    """Return what `blend --report` writes of one blend."""
    record: dict[str, Any] = {
        "format": "semispline/1",
        "kind": "blend_report",
        "edge_a": result.edges[0],
        "edge_b": result.edges[1],
        "continuity": list(result.continuity),
        "method": result.method,
        "options": {name: value for name, value in asdict(result.options).items() if value is not None},
        "objective": asdict(result.objective),
        "candidates": [asdict(candidate) for candidate in result.candidates],
        "energy": result.energy,
        "energy_rounding": result.energy_rounding,
        "quadrature_error": result.quadrature_error,
        "cures": [None if cure is None else asdict(cure) for cure in result.cures],
        "weights": None if result.weights == (None, None) else [asdict(w) for w in result.weights if w is not None],
        "alpha2": result.alpha2,
        "beta2": result.beta2,
    }
    for name in ("alpha2_bounds", "beta2_bounds"):
        bounds = getattr(result, name)
        if bounds is not None:
            record[name] = list(bounds)
    return record | {
        "active_bounds": list(result.active_bounds),
        "flipped": result.flipped,
        "seam_shift": result.seam_shift,
        "seam": None if result.seam is None else contact_record(result.seam),
        "warnings": list(result.warnings),
        "control_points": result.surface.n_control_points,
        "rows_stored": result.rows_stored,
        "rows_converted": result.rows_converted,
        "iterations": result.iterations,
        "status": result.status,
        "search_excess": result.search_excess,
        "kkt_residual": result.kkt_residual,
        "proven_gap": result.proven_gap,
        "p2": list(result.p2),
        "constraint_rank": result.constraint_rank,
        "regularity": asdict(result.regularity),
        "creases": [asdict(crease) for crease in result.creases],
        **shape_record(result.shape),
        "seconds": result.seconds,
        "contact_a": contact_record(result.contact_a),
        "contact_b": contact_record(result.contact_b),
        **{
            name: contact_record(contact)
            for name, contact in (("band_a", result.band_a), ("band_b", result.band_b))
            if contact is not None
        },
        **{
            name: chain_record(chain)
            for name, chain in (("chain_a", result.chain_a), ("chain_b", result.chain_b))
            if chain is not None
        },
    }


def chain_record(chain: ChainContact) -> dict[str, Any]:
    """Return what a JSON file holds of how a blend meets a chain: of each face, and of each joint."""
    return {
        "edges": list(chain.edges),
        "closed": chain.closed,
        "degree": chain.degree,
        "control_points": chain.control_points,
        "corners_fade": chain.fades,
        "limits": chain.limits,
        "joints": [
            finite(asdict(joint)) | {"v": at, "curvature_jumps": joint.bends}
            for joint, at in zip(chain.joints, chain.places, strict=True)
        ],
        "faces": [
            {"edge": face.edge, "range": list(face.range), "contact": contact_record(face.contact)}
            | ({} if face.band is None else {"band": contact_record(face.band)})
            for face in chain.faces
        ],
        "notes": list(chain.notes()),
    }


def shape_record(shape: ShapeReport) -> dict[str, Any]:
    """Return what a JSON file holds of the measures of shape; places beside their figures."""
    turn, waist = asdict(shape.turn), shape.waist
    record: dict[str, Any] = {
        "turn_degrees": turn.pop("degrees"),
        "turn_at": turn,
        "fairness": shape.fairness.value,
        "fairness_jumps": shape.fairness.jumps,
        "fairness_settled": shape.fairness.settled,
        "principal_curvatures": [shape.curvatures.least.value, shape.curvatures.largest.value],
        "principal_curvatures_at": [
            {name: value for name, value in asdict(at).items() if name != "value"}
            for at in (shape.curvatures.least, shape.curvatures.largest)
        ],
        "waist": None if waist is None else waist.distance,
        "waist_of_rulings": None if waist is None else waist.of_rulings,
        "loop_degrees": shape.loop.degrees,
        "loop_at": shape.loop.v,
        "exits": {
            "degrees": [shape.exits.theta_0, shape.exits.theta_1],
            "u_turn": shape.exits.is_u_turn,
            "sides": shape.exits.sides,
        },
        "meets": meets_record(shape.meets),
    }
    return {name: finite(value) for name, value in record.items()}


def meets_record(meets: Meets) -> dict[str, Any]:
    """Return what is known of meetings: true, false, or null where it is not known; what was searched stands beside."""
    return {
        **{what: meets.answer(what) for what in meets.asked},
        "searched": list(meets.searched),
        "places": [asdict(meeting) for meeting in meets.found],
        "unconfirmed": meets.unconfirmed,
        "deflection": meets.deflection,
        "seen_from": meets.seen_from,
        "seen_from_with_bases": meets.seen_from_with_bases,
    }


def print_result(result: BlendResult) -> None:
    """Print what a blend came to."""
    from semispline.solver.judge import worst_inside

    def shape(value: LinearInV | None, bounds: tuple[LinearInV, LinearInV] | None) -> str:
        if value is None:
            return "none"
        if isinstance(value, tuple):
            # At both ends of v.
            each = [None, None] if bounds is None else zip(*cast("tuple[Any, Any]", bounds), strict=True)
            return " to ".join(shape(x, ends) for x, ends in zip(value, each, strict=True))
        low_high = "" if bounds is None else f" (between {bounds[0]:.4g} and {bounds[1]:.4g})"
        return f"{value:.6g}{low_high}"

    rows = [
        ("edges", f"{result.edges[0]} of A, {result.edges[1]} of B"),
        ("continuity", " and ".join(result.continuity)),
        ("method", result.method),
        ("layout", f"degree {result.options.degree_u} across, {result.options.middle_curves} middle curve(s)"),
        ("minimised", _objective(result)),
        ("free rows", result.objective.rows),
        ("energy (11)", f"{result.energy:.6g}" + _quadrature(result)),
        *((f"weights of {name}", str(weights)) for name, weights in zip("AB", result.weights, strict=True) if weights),
        *((f"cured {name}", cure.words) for name, cure in zip("AB", result.cures, strict=True) if cure and cure.words),
        ("alpha\u00b2", shape(result.alpha2, result.alpha2_bounds)),
        ("beta\u00b2", shape(result.beta2, result.beta2_bounds)),
        ("active bounds", ", ".join(result.active_bounds) or "none"),
        ("edge B runs against A", "yes" if result.flipped else "no"),
        ("p2", ", ".join(shape(x, None) for x in result.p2)),
        ("control points", f"{result.rows_stored}, {result.rows_converted} as an ordinary B-spline"),
        ("seconds", f"{result.seconds:.3f}"),
    ]
    rows += [
        ("tried, not taken", f"degree {c.degree_u}, {c.middle_curves} middle curve(s), alpha {c.alpha_v}: {c.verdict}")
        for c in result.candidates
        if c.verdict != "chosen"
    ]
    if result.seam_shift:
        rows.append(("seam of B moved by", f"{result.seam_shift:.6g} in B's parameter"))
    at_a, at_b = result.continuity
    rows.append(("contact A", ", ".join(_figures(result.contact_a, at_a))))
    rows.append(("contact B", ", ".join(_figures(result.contact_b, at_b))))
    for name, band, wanted in zip("AB", (result.band_a, result.band_b), result.continuity, strict=True):
        rows += [] if band is None else _band_rows(name, band, wanted)
    for name, chain, wanted in zip("AB", (result.chain_a, result.chain_b), result.continuity, strict=True):
        rows += [] if chain is None else _chain_rows(name, chain, wanted)
    if result.seam is not None:
        rows.append(("seam", ", ".join(_figures(result.seam, None))))
    if (worst := worst_inside(result.creases)) is not None:
        rows.append(("inside", str(worst)))
    rows += _shape_rows(result.shape)
    print_table(rows)
    print_warnings(result.warnings)


def _chain_rows(name: str, chain: ChainContact, wanted: Continuity) -> Iterator[tuple[str, str]]:
    """Yield what there is to say of a chain, and how a blend meets each face of it."""
    yield f"chain at {name}", str(chain)
    for note in chain.notes():
        yield f"joint of {name}", note.removeprefix("joint ")
    for face in chain.faces:
        low, high = face.range
        figures = ", ".join(_figures(face.contact, wanted)) if face.band is None else _band_figures(face.band, wanted)
        yield f"face at {name}", f"{face.edge}, v in [{low:.4g}, {high:.4g}]: {figures}"


def _band_figures(band: BandContact, wanted: Continuity) -> str:
    """Return how a blend meets the face of a band."""
    figures = [
        f"{words} {value:.2g}{unit} ({band.allowed[measure]:.2g} allowed)"
        for measure, words, unit in (
            ("gap", "gap to the face", ""),
            ("off", "off the trim curve", ""),
            ("angle_degrees", "angle", " degrees"),
            ("curvature", "relative curvature jump", ""),
            ("rate", "relative jump of its rate", ""),
            ("second_rate", "relative jump of its second rate", ""),
        )
        if (value := getattr(band, measure)) is not None
    ]
    counted = f"; {wanted}, which is of parameters, counts as G{wanted[1]}" if wanted in ("C1", "C2") else ""
    return f"{', '.join(figures)}; {band.limits} limits{counted}"


def _band_rows(name: str, band: BandContact, wanted: Continuity) -> Iterator[tuple[str, str]]:
    """Yield how a blend meets the face of a band, and of which curve that is one."""
    yield f"face at {name}", _band_figures(band, wanted)
    of = "feet of the edge in space" if band.source == "foot" else "curve in the face's parameters"
    apart = [
        f"edge {distance:.2g} from the {other}"
        for other, distance in (("face", band.edge_to_face), ("curve in the parameters", band.edge_to_pcurve))
        if distance is not None
    ]
    notes = [
        *apart,
        *([f"moved by {band.smoothed_by:.2g} to be smooth"] if band.smoothed_by else []),
        *([f"{band.left_out:.2g} of {band.length:.4g} left out at ends without a normal"] if band.left_out else []),
    ]
    yield f"band at {name}", "; ".join([f"{band.edge}, {band.control_points} points along the {of}", *notes])


def _shape_rows(shape: ShapeReport) -> Iterator[tuple[str, str]]:
    """Yield what shape came out, and where."""
    turn, fairness, waist, exits = shape.turn, shape.fairness, shape.waist, shape.exits
    along = "v" if turn.section == "u" else "u"
    yield (
        "turn",
        f"{turn.degrees:.3g} degrees within {turn.window:.3g}, at {turn.section} = {turn.at:.3g}, "
        f"{along} = {turn.between[0]:.3g}",
    )
    jumps = f", {fairness.jumps:.3g} of it jumps of curvature" if fairness.jumps > 1e-3 * fairness.value else ""
    settled = "" if fairness.settled else ", not settled: sharper than can be measured"
    yield "fairness", f"{fairness.value:.4g}{jumps}{settled}"
    yield (
        "principal curvatures",
        " to ".join(f"{at.value:.4g}" for at in (shape.curvatures.least, shape.curvatures.largest)),
    )
    if waist is not None:
        yield (
            "waist",
            f"{waist.distance:.4g}, of straight rulings {waist.of_rulings:.4g}, of the rims {waist.of_rims:.4g}",
        )
    u_turn = ", a U-turn" if exits.is_u_turn else ""
    sides = "" if exits.sides is None else f", to {'one side' if exits.sides == 'same' else 'opposite sides'}"
    yield "exits off the straight way", f"{exits.theta_0:.3g} and {exits.theta_1:.3g} degrees{sides}{u_turn}"
    yield (
        "turning beyond its exits",
        f"{max(shape.loop.degrees, 0.0):.3g} degrees at v = {shape.loop.v:.3g}"
        + (": a loop or a wave" * shape.loop.is_loop),
    )
    for sentence in shape.meets.sentences:
        yield "meets", sentence


def _quadrature(result: BlendResult) -> str:
    """Say how well the energy of a rational blend is known."""
    if result.quadrature_error is None:
        return ""
    return f", by quadrature, error {result.quadrature_error:.1e}"


def _objective(result: BlendResult) -> str:
    objective = result.objective
    value = "" if objective.value is None else f", {objective.value:.6g}"
    before = " before the bulge" if value and result.options.bulges != (1.0, 1.0) else ""
    return f"{objective.name}{value}{before}: {objective.known}"


def _figures(contact: Contact, asked: Continuity | None) -> Iterator[str]:
    """Yield what was measured, with what was allowed where the continuity that was asked for requires it."""
    from semispline.solver.judge import required_limits

    allowed = {} if asked is None else {name: limit for name, _, limit in required_limits(contact, asked)}
    for name, words, unit in (
        ("gap", "gap", ""),
        ("angle_degrees", "angle", " degrees"),
        ("curvature_jump_relative", "relative curvature jump", ""),
        ("rate_jump_relative", "relative jump of its rate", ""),
        ("second_rate_jump_relative", "relative jump of its second rate", ""),
    ):
        if getattr(contact, name) is None:
            continue
        limit = f" ({allowed[name]:.2g} allowed)" if name in allowed else ""
        yield f"{words} {getattr(contact, name):.2g}{unit}{limit}"
    if contact.corresponds == "foot points":
        yield "by foot points"


def print_warnings(warnings: Sequence[str]) -> None:
    """Print warnings on standard error."""
    for warning in warnings:
        typer.echo(f"warning: {warning}", err=True)


def print_entries(entries: Sequence[SurfaceEntry], others: Mapping[str, int]) -> None:
    """Print the surfaces of a file, and what else it holds."""
    from semispline.solver.io import counted, without_surfaces

    if not entries:
        typer.echo(without_surfaces(others))
        return

    def word(value: bool | None, yes: str) -> str:
        return "?" if value is None else yes if value else "-"

    rows = [("#", "kind", "degrees", "control points", "rational", "trimmed", "closed")]
    notes = []
    for entry in entries:
        closed = "".join(name for name, is_closed in (("u", entry.closed_u), ("v", entry.closed_v)) if is_closed)
        degrees = "?" if entry.degree_u is None else f"{entry.degree_u}, {entry.degree_v}"
        count = "?" if entry.n_u is None else f"{entry.n_u} x {'various' if entry.n_v is None else entry.n_v}"
        flags = (word(entry.rational, "rational"), word(entry.trimmed, "trimmed"), closed or "-")
        rows.append((str(entry.number), entry.kind, degrees, count, *flags))
        if entry.problem:
            notes.append(f"cannot be used: {entry.problem}")
        if entry.deviation is not None:
            off = f"about {entry.deviation:.3g} off at worst, in the unit of the file"
            notes.append(f"#{entry.number} has no exact B-spline form: the surface taken for it is {off}")
    print_table(rows)
    for note in notes:
        typer.echo(note)
    if others:
        typer.echo(f"cannot be used: {counted(others)}")


def print_table(rows: Sequence[Sequence[str]]) -> None:
    """Print rows with their columns aligned."""
    widths = [max(len(row[k]) for row in rows) for k in range(len(rows[0]))]
    for row in rows:
        typer.echo("  ".join(cell.ljust(width) for cell, width in zip(row, widths, strict=True)).rstrip())
