"""What the process of its own does that changes a solid in a file: reads, operates, gates, writes, reads again."""

from __future__ import annotations

import pickle
from dataclasses import replace
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

import numpy as np

# Loaded before the limits of the process count.
import OCP  # noqa: F401

from semispline.solver.arrays import FloatArray
from semispline.solver.errors import ComputationError, SemisplineError
from semispline.solver.io import MILLIMETRES
from semispline.solver.splines import BSplineSurface, transform
from semispline.solver.topology.occ_parts import PartFile, open_parts
from semispline.solver.topology.occ_replacing import change_of, opening, put_in
from semispline.solver.topology.occ_rounding import rounded
from semispline.solver.topology.occ_shapes import copy_of, parts
from semispline.solver.topology.solid_gate import Change, GateReport, gate
from semispline.solver.topology.solid_orders import Outcome, Replacement, Rounding


def work(path: str, order: str, suffix: str) -> Outcome:
    """Return what came of changing a solid; `order` is a file with the pickled `Replacement` or `Rounding`."""
    # Our own process wrote this.
    wanted = pickle.loads(Path(order).read_bytes())
    try:
        return _changed(open_parts(path), wanted, suffix)
    except (SemisplineError, MemoryError):
        raise
    except Exception as error:
        # Each failure of the kernel has a class of its own.
        said = (str(error).splitlines() or [type(error).__name__])[0]
        raise ComputationError(f"{path}#{wanted.face}: Open CASCADE cannot put the blend in ({said})") from None


def _changed(file: PartFile, wanted: Replacement | Rounding, suffix: str) -> Outcome:
    part = file.part_of(wanted.face)
    copy, image = copy_of(part.shape)
    back = part.place.Inverted()
    if isinstance(wanted, Replacement):
        news = [replace(x, face=file.part_of(x.face).face, surface=_moved(x.surface, back)) for x in wanted.faces]
        places = [opening(copy, x.face, x.contacts) for x in news]
        change = change_of(places)
        after, became = put_in(copy, places, news)
    else:
        surface = _moved(wanted.surface, back)
        after, became, change = rounded(copy, part.face, wanted.edge, surface, grows=wanted.grows)
    millimetres = None if file.unit is None else MILLIMETRES[file.unit]
    report = gate(part.shape, after, change, millimetres=millimetres)
    touched = tuple(sorted(set(change.touched) - set(change.old)))
    if not report.is_sound:
        return Outcome(report, None, None, touched, change.new, part.times)
    before = part.shape
    whole = file.with_part(part, after, lambda piece: became(image(piece)))
    made, there = parts(after, "FACE"), parts(whole.root, "FACE")
    numbers = tuple(next(n for n, face in enumerate(there) if face.IsPartner(made[new])) for new in change.new)
    content = whole.content(suffix)
    again = _read_back(content, suffix, numbers[0], before, change, millimetres)
    return Outcome(report, again, content if again.is_sound else None, touched, numbers, part.times)


def _read_back(
    content: bytes, suffix: str, face: int, before: Any, change: Change, millimetres: float | None
) -> GateReport:
    with TemporaryDirectory() as folder:
        path = Path(folder, f"written{suffix}")
        path.write_bytes(content)
        part = open_parts(path).part_of(face)
        return gate(before, part.shape, change, millimetres=millimetres, read_back=True)


def _moved(surface: BSplineSurface, trsf: Any) -> BSplineSurface:
    if trsf.Form().name == "gp_Identity":
        return surface
    matrix: FloatArray = np.array([[trsf.Value(i, j) for j in range(1, 5)] for i in range(1, 4)])
    return transform(surface, matrix[:, :3], matrix[:, 3])
