"""Which two bases the command blend was asked for: edges of two surfaces, or the faces beside one to be replaced.

Heavy imports wait inside the functions, so that `--help` answers fast.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import TYPE_CHECKING, Any

from semispline.solver.cli.words import check_word, check_words
from semispline.solver.errors import OptionError

if TYPE_CHECKING:
    from semispline.solver.topology import Resolved


def face_numbers(word: str | None) -> tuple[int, ...] | None:
    """Return the faces that are to be replaced, "12" or "12,13,15"; None where nothing was said.

    Raises
    ------
    OptionError

    Examples
    --------
    >>> face_numbers("12,13,15")
    (12, 13, 15)
    """
    if word is None:
        return None
    parts = [part.strip() for part in word.split(",")]
    if not all(part.isascii() and part.isdecimal() for part in parts):
        raise OptionError(
            f"--replace: found {word!r}, expected a face, 12, or several that go on into each other, 12,13"
        )
    return tuple(map(int, parts))


@dataclass(frozen=True)
class WantedBases:
    """What was said of the bases on the command line."""

    a: str
    b: str | None
    edge_a: str | None
    edge_b: str | None
    replaced: tuple[int, ...] | None
    cuts: tuple[str | None, str | None] = (None, None)

    @property
    def specs(self) -> list[str]:
        """The files that are read, with or without a number."""
        return [self.a] if self.b is None else [self.a, self.b]

    @property
    def record(self) -> dict[str, Any]:
        """What a report holds of it, beside the edges."""
        return {} if self.replaced is None else {"replaced": list(self.replaced)}

    def gives_solid(self, out: str) -> bool:
        """Tell whether a solid comes back: one can be read and written, and a face of it is replaced."""
        return self.replaced is not None and self.holds_solids(out)

    def is_added(self, out: str) -> bool:
        """Tell whether a 3dm file comes back with a fillet or an edge of it blended: it holds no new solid."""
        from pathlib import Path

        from semispline.solver.io import split_spec

        files = [split_spec(spec)[0] for spec in self.specs]
        if any(Path(x).suffix.lower() != ".3dm" for x in (*files, out)) or len(set(files)) > 1:
            return False
        return self.replaced is not None or None not in self.cuts

    def holds_solids(self, out: str) -> bool:
        """Tell whether a solid can be read and written."""
        from semispline.solver.io import split_spec
        from semispline.solver.topology import can_hold_a_solid

        return can_hold_a_solid(split_spec(self.a)[0]) and can_hold_a_solid(out, written=True)

    def sharp_edge(self) -> tuple[str, int, str] | None:
        """Return file, face and name of the sharp edge of a solid from which both contacts are cut; None without one.

        Raises
        ------
        EdgeError, FileError, ComputationError
        """
        from semispline.solver.io import split_spec
        from semispline.solver.topology import can_hold_a_solid, sharp_edge_between

        if self.replaced is not None or self.b is None or None in self.cuts:
            return None
        if not can_hold_a_solid(split_spec(self.a)[0]):
            return None
        return sharp_edge_between((self.a, self.b), (self.edge_a, self.edge_b))

    def check(self) -> None:
        """Refuse what does not go together before a file is read.

        Raises
        ------
        OptionError, EdgeError
        """
        if self.replaced is not None:
            self._check_replace()
        elif self.b is not None and self.cuts != (None, None):
            self._check_cuts()
        elif self.b is None or self.edge_a is None or self.edge_b is None:
            missing = [
                name
                for name, said in (("B", self.b), ("--edge-a", self.edge_a), ("--edge-b", self.edge_b))
                if said is None
            ]
            raise OptionError(
                f"blend: {', '.join(missing)} missing, expected A B --edge-a EDGE --edge-b EDGE, FILE --replace FACE, "
                "or PATH#N PATH#M --cut-a D --cut-b D"
            )
        else:
            check_words(self.edge_a, self.edge_b)

    def resolved(self) -> tuple[Sequence[Resolved], str]:
        """Return both edges as `Base` knows them, and what is said of the place.

        Raises
        ------
        EdgeError, FileError, ComputationError
        """
        from semispline.solver.topology import moved_edges, replaced_run, resolve_edges

        if self.replaced is not None:
            run = replaced_run(self.a, self.replaced, self.edge_a, self.edge_b)
            return [run.a, run.b], run.said
        assert self.b is not None
        if self.cuts != (None, None):
            return moved_edges((self.a, self.b), (self.edge_a, self.edge_b), self.cuts), ""
        assert self.edge_a is not None
        assert self.edge_b is not None
        return resolve_edges([(self.a, self.edge_a), (self.b, self.edge_b)]), ""

    def _check_replace(self) -> None:
        from semispline.solver.io import split_spec
        from semispline.solver.topology import is_near, is_of_a_face

        assert self.replaced is not None
        face = self.replaced[0]
        if self.cuts != (None, None):
            raise OptionError("--replace: found it together with --cut-a or --cut-b, expected one of them")
        if self.b is not None:
            raise OptionError(f"--replace: found a second file {self.b!r}, expected the one that holds the face")
        path, number = split_spec(self.a)
        if number is not None:
            raise OptionError(
                f"--replace: found {self.a!r}, expected the file alone, {path!r}: --replace says which face"
            )
        if (self.edge_a is None) != (self.edge_b is None):
            raise OptionError(f"--edge-a and --edge-b: found one of them, expected none or two edges of face {face}")
        for name, word in (("--edge-a", self.edge_a), ("--edge-b", self.edge_b)):
            if word is not None and is_near(word):
                raise OptionError(
                    f"{name}: found {word!r} together with --replace, expected an edge of face {face}, as "
                    "e1; two points say themselves which face lies between: FILE FILE --edge-a near=x,y,z "
                    "--edge-b near=x,y,z"
                )
            if word is not None and not is_of_a_face(word):
                raise OptionError(
                    f"{name}: found {word!r}, expected an edge of face {face}, as e1: "
                    f"`semispline list {path} --edges {face}` lists them"
                )

    def _check_cuts(self) -> None:
        from semispline.solver.topology import parse_cut

        for name, word in zip(("--cut-a", "--cut-b"), self.cuts, strict=True):
            if word is not None:
                parse_cut(word, name)
        for name, word in (("--edge-a", self.edge_a), ("--edge-b", self.edge_b)):
            if word is not None:
                check_word(word, name)
