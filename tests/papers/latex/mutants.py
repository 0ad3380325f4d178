"""Formulas with one token dropped, changed or exchanged with the next, and the places where that changes nothing.

Tokens are found here by a pattern of their own, and neutral places by what stands in the text there: the reader that is
tested has no part in either.
"""

import random
import re

TOKEN = re.compile(r"\\(?:[A-Za-z]+|.|\n)|[^\W\d_]+\d*|\d+(?:\.\d+)?|\.\.+|\|\||\S", re.DOTALL)
MACROS = (
    r"\frac \cdot \sqrt \sum \int \cos \sin \pi \phi \tau \alpha \left \right \\ \leq \binom \pm \prime \partial \text"
).split()
SIGNS = "+ - = / ! ' ^ _ & , ( ) [ ] { } |".split()
LETTERS = tuple("abcdijkmnpqrstuvwxyzABCDEMNPQSTVZ")
# What carries nothing: labels under braces, widths, letters of columns, names of environments' columns.
SILENT = re.compile(
    r"\\underset\s*\{[^{}]*\}|\\hspace\{[^{}]*\}|\\kern\s*[\d.]+\s*em|\\begin\{array\}\{[^{}]*\}|\\text(?:it)?(?=\{)"
)


def mutants(latex, seed):
    """Yield (offset, kind, formula) for each token: dropped, changed, exchanged with the next."""
    rng = random.Random(seed)
    found = list(TOKEN.finditer(latex))
    for k, token in enumerate(found):
        start, end = token.span()
        # A macro before a letter needs its space.
        yield start, "drop", f"{latex[:start]} {latex[end:]}"
        yield start, "change", f"{latex[:start]}{other(token[0], rng)} {latex[end:]}"
        if k + 1 < len(found):
            after = found[k + 1]
            text = f"{latex[:start]}{after[0]} {latex[end : after.start()]}{token[0]} {latex[after.end() :]}"
            if after[0] != token[0]:
                yield start, "exchange", text


def other(token, rng):
    """Return another token of the same sort, most of the time."""
    if rng.random() < 0.1:
        pool = (*MACROS, *SIGNS, *LETTERS, "2")
    elif token.startswith("\\"):
        pool = MACROS
    elif token[0].isdigit():
        pool = tuple(str(n) for n in range(13))
    elif token[0].isalpha():
        pool = LETTERS
    else:
        pool = tuple(SIGNS)
    return rng.choice([text for text in pool if text != token])
