"""One fillet of a file, or a chain of them, replaced as `semispline blend FILE --replace FACE[,FACE..]` does."""

from __future__ import annotations

import importlib
import time
from pathlib import Path
from tempfile import TemporaryDirectory
from typing import Any

from semispline import BlendResult, SemisplineError, replace_face
from semispline.solver.io import foreign
from semispline.solver.topology.solid_blends import SolidBlend

# What `BandContact` calls the measures of `Contact`.
_SHORT = {"curvature_jump_relative": "curvature"}


def work(path: str, faces: str, keep: str) -> dict[str, Any]:
    """Return what came of it, for JSON; in a process of its own, that reads and changes the file itself."""
    foreign.call = lambda module, words, _, __: importlib.import_module(module).work(*words)  # type: ignore[assignment]
    numbers, started = tuple(map(int, faces.split(","))), time.process_time()
    try:
        with TemporaryDirectory() as folder:
            found = replace_face(path, numbers, Path(folder, "solid.step"), keep_ends=keep == "keep")
    except SemisplineError as error:
        return {"error": f"{type(error).__name__}: {error}", "seconds": time.process_time() - started}
    except Exception as error:
        return {"error": f"FAULT {type(error).__name__}: {error}", "seconds": time.process_time() - started}
    return _measures(found) | {"seconds": time.process_time() - started}


def _measures(found: SolidBlend) -> dict[str, Any]:
    report, blend = found.gate, found.blend
    had, has = report.volume
    return {
        "kept": len(found.kept),
        "length_kept": max((end.length for end in found.kept), default=0.0),
        "crease": max((end.crease_degrees for end in found.kept), default=0.0),
        "share": abs(has - had) / report.volume_limit,
        "tolerance": report.largest_tolerance,
        "read_back": found.read_back.largest_tolerance,
        "was": max((edge.was or 0.0 for edge in report.border), default=0.0),
        "gap": max(edge.gap for edge in report.border),
        "angle": max(_worst(blend, "angle_degrees")),
        "curvature": max(_worst(blend, "curvature_jump_relative")),
        "warnings": list(blend.warnings),
    }


def _worst(blend: BlendResult, name: str) -> list[float]:
    """Return a measure of each contact, on the faces themselves."""
    found = []
    for contact, band, chain in (
        (blend.contact_a, blend.band_a, blend.chain_a),
        (blend.contact_b, blend.band_b, blend.chain_b),
    ):
        met = [(contact, band)] if chain is None else [(face.contact, face.band) for face in chain.faces]
        for own, on_face in met:
            found.append(getattr(own, name) if on_face is None else getattr(on_face, _SHORT.get(name, name)))
    return [float(x) for x in found]
