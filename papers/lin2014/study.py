"""The pairs of bases on which the method is run: one made, one from a real CAD model."""

from __future__ import annotations

from importlib.util import find_spec
from pathlib import Path

from papers.lin2014.consequences import made_pair
from papers.lin2014.figures import draw_figure_1, draw_figure_2, draw_trimmed_patch
from papers.reproduction import Drawing, Example

IMPELLER_FACES = (102, 131)


def examples() -> list[Example]:
    """Return the examples; the real pair only where the package `pyiges`, which brings the model, is installed."""
    made = Example(
        "made",
        "Made pair: two bicubic patches with mismatched, non-uniform knots",
        *made_pair(),
        "Our own geometry (examples/made-pair.json): 3 inner knots on one contact curve, 4 others on the other one.",
    )
    path = impeller_path()
    if path is None:
        return [made]
    return [made, _impeller(path)]


def impeller_path() -> Path | None:
    """Return the IGES model in the installed package `pyiges`, or None where it or the `cad` extra is missing."""
    spec = find_spec("pyiges")
    if spec is None or not spec.submodule_search_locations or find_spec("OCP") is None:
        return None
    path = Path(spec.submodule_search_locations[0]) / "examples" / "impeller.igs"
    return path if path.is_file() else None


def _impeller(path: Path) -> Example:
    from solver.base import Base
    from solver.io.surface_files import read_surfaces

    loaded = read_surfaces([f"{path}#{face}" for face in IMPELLER_FACES])
    first, second = (Base(surface.surface, "u0") for surface in loaded)
    title = f"Real pair: impeller.igs, faces {IMPELLER_FACES[0]} and {IMPELLER_FACES[1]}, edges u0 and u0"
    note = (
        "Two neighbouring blades of an impeller, seen on the model that the package pyiges ships. Nobody would "
        "manufacture this web between two leading edges; it is a test on real data, whose parameter speeds and knots "
        "nobody chose for us."
    )
    return Example("impeller", title, first, second, note)


def drawings() -> list[Drawing]:
    """Return the figures of section 2, remade."""
    return [
        Drawing("figure-1", "Fig. 1: control points of each v-control curve", draw_figure_1),
        Drawing("figure-2", "Fig. 2: a Bezier patch divided by a Bezier function", draw_figure_2),
        Drawing(
            "figure-3", "Fig. 3: the trimmed patch as four semi-structured and four Bezier patches", draw_trimmed_patch
        ),
    ]
