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


SPACES = {r"\ ", r"\,", "\\\n"}
NUMBERED = r"[^\W\d_]|\d+|\\[a-z]+"
# Lines go on where one begins with a sign or a relation, maybe behind column marks or dots.
GOES_ON = re.compile(r"\\\\[\s&]*(?:\.\.+[\s&]*)?(?:[-+=]|\\simeq|\\end\b)")
# Before these a comma says nothing that they do not say.
COMMA_SAID = re.compile(r",(?:\s|\\[\s,])*(?:\\\\|\\textit\{ ?where|with\b|\\\{ )")


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
    """Tell whether a change of the token at this offset may say the same: what stands there prints nothing of its own."""
    if any(m.start() <= at < m.end() for m in SILENT.finditer(latex)):
        return True
    token = TOKEN.match(latex, at)[0]
    before, rest = latex[:at].rstrip(), latex[at:]
    if kind == "exchange":
        return may_change_places(latex, at, token, TOKEN.search(latex, at + len(token)).group())
    if token in SPACES or token in ("BLUE", "RED", "MAGENTA"):
        return True
    if token == "&":
        return not in_matrix(latex, at)
    if token == r"\cdot":
        return kind == "drop"
    if token == r"\\":
        # A comma or an arrow before it parts the statements too.
        return bool(GOES_ON.match(rest)) or before.endswith((",", "⇓"))
    if token == ",":
        return bool(COMMA_SAID.match(rest))
    if token.startswith(".."):
        return bool(re.match(r"\.\.+[\s&]*=", rest))
    if token == "+":
        # A sign that opens a line or a side, or one of two that stand for one.
        return before.endswith(("=", "&")) and bool(re.match(r"\+\s*(?:&\s*[-+]|\d|\\frac)", rest))
    if token == "^":
        return bool(re.match(r"\^\{?\\prime", rest))
    return kind == "change" and token in ("'", "sin", "cos", "tan")


def may_change_places(latex, at, token, after):
    """Tell whether two tokens may change places: column marks, spaces, braces that print nothing."""
    before, rest = latex[:at].rstrip(), latex[at:]
    pair = {token, after}
    if "&" in pair:
        return not in_matrix(latex, at)
    if pair & SPACES or pair in ({",", r"\\"}, {"⇓", r"\\"}):
        return True
    if token == r"\\":
        return bool(GOES_ON.match(rest)) or before.endswith(",")
    if after == r"\\":
        return bool(GOES_ON.match(rest[len(token) :].lstrip()))
    if token == "{":
        return bool(re.match(rf"\{{(?:{NUMBERED})\}}|\{{(?:\\prime)+\}}", rest))
    if after == "{":
        return bool(re.match(rf"\\(?:sqrt|hat|vec)\{{(?:{NUMBERED})\}}|\\(?:sin|cos)\{{|,\s*\{{\\ \}}", rest))
    if token == "}":
        return after == "'" or before.endswith("{\\")
    if after == "}":
        # Braces round a letter that no script and no macro has before it, round `, with ..`, round a word.
        alone = bool(re.search(r"[-+({'\s]\{$", before)) and token.isalpha()
        return alone or token in (r"\prime", "where") or bool(re.search(r"\{\\ ,[^{}]*$", before))
    if "]" in pair:
        return bool(re.search(r"(?:BLUE|RED|MAGENTA)\[[^\]]*$", before))
    return after == "(" and token.lstrip("\\") in ("sin", "cos", "tan")
