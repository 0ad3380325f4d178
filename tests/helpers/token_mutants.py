"""Formulas with one token dropped, changed or exchanged with the next, and the places where that changes nothing.

Tokens are found here by a pattern of their own, and neutral places by what stands in the text there: the reader that is
tested has no part in either.
"""

import random
import re

TOKEN = re.compile(r"\\(?:[A-Za-z]+|.|\n)|[^\W\d_]+\d*|\d+(?:\.\d+)?|\.\.+|\|\||\S", re.DOTALL)
MACROS = TOKEN.findall(
    r"\frac \cdot \sqrt \sum \int \cos \sin \pi \phi \tau \alpha \left \right \\ \leq \binom \pm \prime \partial \text"
)
SIGNS = TOKEN.findall("+ - = / ! ' ^ _ & , ( ) [ ] { } |")
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


COLOURS = {"BLUE", "RED", "MAGENTA"}
SPACES = {r"\ ", r"\,", "\\\n"}
ROW = r"\\"
ALONE = r"(?:[^\W\d_]|\d+|\\[a-z]+)"
# Lines go on where one begins with a sign or a relation, maybe behind column marks or dots.
GOES_ON = re.compile(r"\\\\[\s&]*(?:\.\.+[\s&]*)?(?:[-+=]|\\simeq|\\end\b)")
# Before these a comma says nothing that they do not say.
COMMA_SAID = re.compile(r",(?:\s|\\[\s,])*(?:\\\\|\\textit\{ ?where|with\b|\\\{ )")
# A sign that opens a line or a side, or one of two that stand for one.
PLUS_SAID = re.compile(r"\+\s*(?:&\s*[-+]|\d|\\frac)")


def in_matrix(latex, at):
    """Tell whether a place is a cell of a matrix, where column marks count."""
    opened = []
    for found in re.finditer(r"(\\left\s*[\[(]\s*)?\\begin\{(\w+)\}|\\end\{\w+\}", latex[:at]):
        if found[2]:
            opened.append(found[2] in ("bmatrix", "pmatrix") or bool(found[1]))
        else:
            opened.pop()
    return bool(opened) and opened[-1]


def neutral(latex, at, kind):
    """Tell whether a change of the token at this offset may say the same: what is there prints nothing of its own."""
    if any(m.start() <= at < m.end() for m in SILENT.finditer(latex)):
        return True
    token = TOKEN.match(latex, at)[0]
    before, rest = latex[:at].rstrip(), latex[at:]
    if kind == "exchange":
        return may_change_places(latex, at, token, TOKEN.search(latex, at + len(token)).group())
    places = {
        "&": not in_matrix(latex, at),
        r"\cdot": kind == "drop",
        # A comma or an arrow before the end of a line parts the statements too.
        ROW: GOES_ON.match(rest) or before.endswith((",", "⇓")),
        ",": COMMA_SAID.match(rest),
        "..": re.match(r"\.\.+[\s&]*=", rest),
        "+": before.endswith(("=", "&")) and PLUS_SAID.match(rest),
        "^": re.match(r"\^\{?\\prime", rest),
    }
    same = token in SPACES | COLOURS or (kind == "change" and token in ("'", "sin", "cos", "tan"))
    return same or bool(places.get(".." if token.startswith("..") else token, False))


def may_change_places(latex, at, token, after):
    """Tell whether two tokens may change places: column marks, spaces, ends of lines, braces that print nothing."""
    if "&" in (token, after):
        return not in_matrix(latex, at)
    before, rest = latex[:at].rstrip(), latex[at:]
    behind = rest[len(token) :].lstrip()
    in_colour = re.search(r"(?:BLUE|RED|MAGENTA)\[[^\]]*$", before)
    # Braces round a letter that no script and no macro has before it.
    alone = token.isalpha() and re.search(r"[-+({'\s]\{$", before)
    return bool(
        {token, after} & SPACES
        or {token, after} in ({",", ROW}, {"⇓", ROW})
        or (token == ROW and (GOES_ON.match(rest) or before.endswith(",")))
        or (after == ROW and GOES_ON.match(behind))
        or (token == "{" and re.match(rf"\{{{ALONE}\}}|\{{(?:\\prime)+\}}", rest))
        or (after == "{" and re.match(rf"\\(?:sqrt|hat|vec)\{{{ALONE}\}}|\\(?:sin|cos)\{{|,\s*\{{\\ \}}", rest))
        or (token == "}" and (after == "'" or before.endswith("{\\")))
        or (after == "}" and (alone or token in (r"\prime", "where") or re.search(r"\{\\ ,[^{}]*$", before)))
        or ("]" in (token, after) and in_colour)
        or (after == "(" and token.lstrip("\\") in ("sin", "cos", "tan"))
    )
