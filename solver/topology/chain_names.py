"""Words for several edges of faces in a file: e3+e4, e3..e9, e3*, 12:e3+13:e1."""

from __future__ import annotations

import re
from dataclasses import dataclass

from semispline.solver.errors import EdgeError
from semispline.solver.topology.near import NEAR

_MEMBER = re.compile(
    r"(?:(?P<face>[0-9]{1,9}):)?(?P<edge>e[0-9]{1,9})(?P<part>\[[0-9]{1,9}\])?(?:\.\.(?P<last>e[0-9]{1,9})|(?P<all>\*))?"
)
# What nobody would write for a single edge.
_SEVERAL = re.compile(r"[0-9]+:|e[0-9]+\s*(?:\[[0-9]+\])?\s*(?:\+|\.\.|\*)|near=.*\*$")
_FORMS = "edges of faces that run end to end, as e3+e4, e3..e9, e3*, or with their faces, 12:e3+13:e1"


@dataclass(frozen=True)
class ChainWord:
    """One of the words that are joined by +.

    Attributes
    ----------
    edge : str
        "e3", "e3[0]", or "near=x,y,z".
    face : int or None
        Its face, where it is said: N of `PATH#N`.
    last : str or None
        Where a run in walking order ends.
    all : bool
        All edges that go on smoothly from it are meant.
    """

    edge: str
    face: int | None = None
    last: str | None = None
    all: bool = False


def names_several(word: str) -> bool:
    """Tell whether a word is one for several edges of faces, or says of which face an edge is.

    Examples
    --------
    >>> [names_several(word) for word in ("e3+e4", "e3..e9", "e3*", "12:e3", "near=1,2,3*")]
    [True, True, True, True, True]
    >>> [names_several(word) for word in ("e3", "e3[0]", "u=0.3+", "near=1,2,3")]
    [False, False, False, False]
    """
    return bool(_SEVERAL.match(word.strip()))


def parse_chain(word: str, name: str = "edge") -> tuple[ChainWord, ...]:
    """Return what is joined in a word; messages call it `name`.

    Raises
    ------
    EdgeError
        No such word.

    Examples
    --------
    >>> parse_chain("12:e3..e5+13:e1")
    (ChainWord(edge='e3', face=12, last='e5', all=False), ChainWord(edge='e1', face=13, last=None, all=False))
    """
    text = word.strip()
    if text.startswith(NEAR):
        return (ChainWord(text.removesuffix("*"), all=True),)
    found = []
    for one in text.split("+"):
        match = _MEMBER.fullmatch(one.strip())
        if match is None or (match["part"] and (match["last"] or match["all"])):
            raise EdgeError(f"{name}: found {word!r}, expected {_FORMS}")
        face = None if match["face"] is None else int(match["face"])
        found.append(ChainWord(match["edge"] + (match["part"] or ""), face, match["last"], bool(match["all"])))
    return tuple(found)
