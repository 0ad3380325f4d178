"""What a reader of formulas refuses, and where."""

from __future__ import annotations

from enum import StrEnum

from semispline.solver.errors import InputError


class Trouble(StrEnum):
    """Why a formula is not read. What is not read is transcribed by hand, and marked with its class."""

    UNDECLARED = "undeclared"
    TWO_NAMES = "two names"
    WORD = "word"
    SCRIPT = "one-token script"
    ELLIPSIS = "ellipsis"
    SLASH = "slash"
    FUNCTION_POWER = "function power"
    FUNCTION_ARGUMENT = "function argument"
    APPLICATION = "application"
    OPERATOR = "operator"
    SUM_SCOPE = "sum scope"
    KINDS = "kinds"
    LAYOUT = "layout"
    NUMERAL = "numeral"
    DELIMITERS = "delimiters"
    TEX = "TeX"


class UnreadableError(InputError):
    """A formula that is not read: it fits no declared name, or two, or has two readings, or is not known TeX.

    Attributes
    ----------
    trouble : Trouble
    at : int
        Offset of the token in the formula, from 0.
    reason : str
    place : str
        `file:line:column` or `line:column`, both from 1; empty until the text is known.
    """

    def __init__(self, trouble: Trouble, reason: str, at: int, place: str = "") -> None:
        self.trouble, self.reason, self.at, self.place = trouble, reason, at, place
        super().__init__(f"{place}: {trouble}: {reason}" if place else f"{trouble}: {reason}")

    def placed(self, text: str, source: str = "", line: int = 1) -> UnreadableError:
        """Return the same with its place in a text that begins at this line of its source."""
        before = text[: self.at]
        column = self.at - (before.rfind("\n") + 1) + 1
        place = f"{line + before.count(chr(10))}:{column}"
        return UnreadableError(self.trouble, self.reason, self.at, f"{source}:{place}" if source else place)


class NamesError(InputError):
    """A table of names that is not well formed: the message has its line."""


class ConversionError(InputError):
    """A formula that is read, and has no form in SymPy: the message says what is missing."""


class DocumentError(InputError):
    """A file of formulas that is not well formed: the message has its line."""
