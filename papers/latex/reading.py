"""From LaTeX to what it says: read, echoed, in steps."""

from __future__ import annotations

import unicodedata
from dataclasses import dataclass

from semispline.papers.latex.errors import Trouble, UnreadableError
from semispline.papers.latex.names import Names
from semispline.papers.latex.statements import statements
from semispline.papers.latex.tokens import nest
from semispline.papers.latex.trees import BigSum, Integral, Named, Statement, Tree, parts


@dataclass(frozen=True)
class Step:
    """One relation of a formula.

    Attributes
    ----------
    left, right : Tree or None
        None on the left where the formula continues the display before.
    relation : str
    after : str
        The arrow that leads to the statement, where it is its first step.
    conditions : tuple of Statement
        What is said to hold: names given up to here, and limits of this statement.
    """

    left: Tree | None
    relation: str
    right: Tree
    after: str = ""
    conditions: tuple[Statement, ...] = ()


@dataclass(frozen=True)
class Formula:
    """A printed formula, read.

    Attributes
    ----------
    latex : str
        As printed, NFC.
    names : Names
    statements : tuple of Statement
    """

    latex: str
    names: Names
    statements: tuple[Statement, ...]

    @property
    def steps(self) -> tuple[Step, ...]:
        """The relations of all statements, in their order."""
        found: list[Step] = []
        known: list[Statement] = []
        for statement in self.statements:
            found += _steps(statement, known)
            known += [c.statement for c in statement.conditions if c.word == "where"]
        return tuple(found)


def read_formula(latex: str, names: Names, source: str = "", line: int = 1) -> Formula:
    """Read a formula against a table of names.

    Parameters
    ----------
    latex : str
    names : Names
    source : str
        The file that it stands in, for messages.
    line : int
        Its first line there.

    Raises
    ------
    UnreadableError
        It fits no declared name, or two, has two readings, or is not known TeX; the message has the place.

    Examples
    --------
    >>> from semispline.papers.latex.names import read_names
    >>> names = read_names("x, a : real").of("eq-1")
    >>> read_formula("x^2 = a", names).statements[0].relations
    ('=',)
    """
    latex = unicodedata.normalize("NFC", latex)
    try:
        return Formula(latex, names, statements(nest(latex, names.colours), names))
    except UnreadableError as error:
        raise error.placed(latex, source, line) from None
    except RecursionError:
        raise UnreadableError(Trouble.TEX, "too many brackets in each other", 0).placed(latex, source, line) from None


def _steps(statement: Statement, known: list[Statement]) -> list[Step]:
    found: list[Step] = []
    sides: tuple[Tree | None, ...] = ((None,) if statement.continues else ()) + statement.sides
    for k, relation in enumerate(statement.relations):
        right = sides[k + 1]
        assert right is not None
        # Sides are counted without the one of the display before.
        place = k + 1 - statement.continues
        holds = [c.statement for c in statement.conditions if c.word == "when" or c.since <= place]
        after = statement.after if k == 0 else ""
        found.append(Step(sides[k], relation, right, after, (*known, *holds)))
    return found


def free_names(node: object) -> list[str]:
    r"""Return the declared names in a tree that no sum and no integral of it binds, in their order.

    Examples
    --------
    >>> from semispline.papers.latex.names import read_names
    >>> names = read_names("n, i : integer >= 0\nw_i : real").of("eq-1")
    >>> free_names(read_formula(r"\sum_{i=0}^{n} w_i", names).statements)
    ['n', 'w_i']
    """
    found: dict[str, None] = {}

    def collect(node: object, bound: frozenset[str]) -> None:
        if isinstance(node, tuple):
            for entry in node:
                collect(entry, bound)
            return
        if isinstance(node, Named) and node.name not in bound:
            found[node.name] = None
        if isinstance(node, BigSum | Integral):
            collect((node.lower, node.upper), bound)
            own = node.index if isinstance(node, BigSum) else node.variable
            collect(node.body, bound | {own.name})
            return
        for part in parts(node):
            collect(part, bound)

    collect(node, frozenset())
    return list(found)
