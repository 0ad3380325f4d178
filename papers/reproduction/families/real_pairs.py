"""Pairs of faces in public CAD files: polynomial neighbours of a face that is taken away, and two of the report."""

from __future__ import annotations

from dataclasses import dataclass
from importlib.util import find_spec
from pathlib import Path

from semispline.papers.reproduction.families.problems import ShapeProblem, measure_pair
from semispline.solver.io import read_surfaces
from semispline.solver.judge import Base
from semispline.solver.splines import NaturalEdge

IMPELLER = "impeller.igs"


@dataclass(frozen=True)
class RealPair:
    """Two faces of a file, numbered as `semispline list` does, and their edges.

    Attributes
    ----------
    file : str
        Within the folder of shared files; the impeller is that of the package pyiges.
    face_a, face_b : int
    edge_a, edge_b : {"u0", "u1", "v0", "v1"}
    between : int or None
        The face that lies between them, on opposite sides of which they are.
    kind : str
    """

    file: str
    face_a: int
    edge_a: NaturalEdge
    face_b: int
    edge_b: NaturalEdge
    between: int | None
    kind: str

    @property
    def name(self) -> str:
        """File and faces."""
        return f"{Path(self.file).name} {self.face_a} {self.edge_a}, {self.face_b} {self.edge_b}"


_SALT, _CAD = "data/v4_SaltAndPepper.3dm", "data/cad/"
_SHELL, _PART = f"{_CAD}occt_shell1.brep", f"{_CAD}v4_MechPartA.3dm"
_FILLETS, _WING = f"{_CAD}demos_face_recognition_sample_part.stp", f"{_CAD}tigl_simplewing.brep"
REAL_PAIRS = (
    RealPair(IMPELLER, 102, "u0", 131, "u0", None, "two blades"),
    RealPair(_SALT, 0, "u1", 54, "u0", None, "two free forms"),
    RealPair(_SALT, 70, "u1", 69, "u0", 71, "a round"),
    RealPair(f"{_CAD}build123d_M6-1x12-countersunk-screw.step", 12, "v1", 8, "v0", 9, "flanks of a thread"),
    RealPair(_FILLETS, 14, "u1", 17, "u0", 19, "planes beside a fillet"),
    RealPair(_FILLETS, 15, "u1", 14, "u0", 20, "planes beside a fillet"),
    RealPair(_FILLETS, 17, "u1", 16, "u0", 21, "planes beside a fillet"),
    RealPair(_SHELL, 2, "v1", 0, "v0", 1, "patches of a shell"),
    RealPair(_SHELL, 4, "u1", 18, "u0", 7, "patches of a shell"),
    RealPair(_SHELL, 12, "v1", 62, "u0", 13, "patches of a shell"),
    RealPair(_SHELL, 24, "u1", 47, "v0", 25, "patches of a shell"),
    RealPair(_WING, 2, "u1", 1, "u0", 0, "trailing edge and lower skin of a wing"),
    RealPair(_WING, 5, "u1", 4, "u0", 3, "trailing edge and lower skin of a wing"),
    RealPair(f"{_CAD}v4_DinerMug.3dm", 2, "v0", 1, "v1", 3, "roundings at both ends of a mug's handle"),
    RealPair(_PART, 6, "v0", 7, "v1", 5, "sides of a bar"),
    RealPair(_PART, 5, "v0", 8, "v1", 6, "sides of a bar"),
)


def real_pair(number: int, shared: Path | None) -> ShapeProblem | None:
    """Return a pair of `REAL_PAIRS`; None where its file is not here.

    Parameters
    ----------
    number : int
    shared : Path or None
        The folder that holds `data`; None where there is none.

    Raises
    ------
    FileError
        The file is not what it was.

    Examples
    --------
    >>> real_pair(1, None) is None
    True
    """
    pair = REAL_PAIRS[number]
    path = impeller_path() if pair.file == IMPELLER else shared and shared / pair.file
    if path is None or not path.is_file():
        return None
    first, second = read_surfaces([f"{path}#{pair.face_a}", f"{path}#{pair.face_b}"])
    a, b = Base(first.surface, pair.edge_a), Base(second.surface, pair.edge_b)
    return ShapeProblem(pair.name, "real", pair.kind, number, a, b, measure_pair(a, b))


def impeller_path() -> Path | None:
    """Return the IGES model in the installed package `pyiges`, or None where it or the `cad` extra is missing."""
    spec = find_spec("pyiges")
    if spec is None or not spec.submodule_search_locations or find_spec("OCP") is None:
        return None
    path = Path(spec.submodule_search_locations[0]) / "examples" / IMPELLER
    return path if path.is_file() else None
