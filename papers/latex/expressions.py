"""Expressions: sums of terms, terms of factors, read against the table of names.

What may be read in two ways is refused: a slash before more than one factor, a word that is no name, a power between a
function and its bracket, a term beside a sum that has the sum's index.
"""

from __future__ import annotations

from dataclasses import dataclass

from semispline.papers.latex.ellipsis import elided
from semispline.papers.latex.errors import Trouble, UnreadableError
from semispline.papers.latex.matrices import cases, matrix
from semispline.papers.latex.names import Names, head_of
from semispline.papers.latex.resolving import cut, is_integer, resolve, scripts_after
from semispline.papers.latex.tokens import MATRICES, Item, Items, split
from semispline.papers.latex.trees import (
    BigSum,
    Binomial,
    Call,
    Components,
    Derived,
    Factorial,
    Integral,
    Interval,
    Labelled,
    Listing,
    Matrix,
    Named,
    Number,
    Power,
    Product,
    Quotient,
    Root,
    Statement,
    Sum,
    Transpose,
    Tree,
    parts,
    walk,
)

_BARS = {"||": "abs", "||||": "norm"}
# What no term can begin behind a sign or a slash with.
_NO_FACTOR = ("sign", "dot", "slash", "big")
_NAMES = ("run", "upright", "letter", "accent", "text")


def expression(items: Items, names: Names, at: int = 0) -> Tree:
    """Read items that are one expression.

    Raises
    ------
    UnreadableError
    """
    return _Expressions(names).sum(items, at)


def chain(items: Items, names: Names, at: int) -> Statement:
    """Read sides with relations between them.

    Raises
    ------
    UnreadableError
    """
    relations = tuple(item.text for item in items if item.kind == "relation")
    sides = split(items, "relation")
    trees = tuple(side_of(side, relation, names, at) for side, relation in zip(sides, ("", *relations), strict=True))
    return Statement(trees, relations)


def side_of(items: Items, relation: str, names: Names, at: int) -> Tree:
    """Read one side behind a relation, which tells an interval from a point.

    Raises
    ------
    UnreadableError
    """
    if relation == "\\in" and len(items) == 1 and items[0].kind == "fence" and items[0].text[0] in "([":
        ends = split(items[0].parts[0])
        if len(ends) == 2:
            return Interval(items[0].text, *(expression(end, names, items[0].at) for end in ends))
    return expression(items, names, items[0].at if items else at)


@dataclass(frozen=True)
class _Expressions:
    """The rules of expressions under one table of names; each takes items and gives a tree, and where it ends."""

    names: Names

    def sum(self, items: Items, at: int) -> Tree:
        if not items:
            raise UnreadableError(Trouble.TEX, "found nothing, expected an expression", at)
        if len(items) == 1 and items[0].kind == "group":
            return self.sum(items[0].parts[0], at)
        terms: list[tuple[str, Tree | None]] = []
        i = 0
        while i < len(items):
            sign = "+"
            if items[i].kind == "sign":
                sign = items[i].text
                i += 1
            if i < len(items) and items[i].kind == "dots":
                terms.append((sign, None))
                i += 1
            else:
                term, i = self.term(items, i)
                terms.append((sign, term))
            if i < len(items) and items[i].kind != "sign":
                raise UnreadableError(Trouble.TEX, f"found {items[i].text!r}, which continues no term", items[i].at)
        return self._added(terms, at)

    def _added(self, terms: list[tuple[str, Tree | None]], at: int) -> Tree:
        printed = [(sign, term) for sign, term in terms if term is not None]
        if len(printed) > 1:
            _check_scope([term for _, term in printed], at)
        if len(printed) < len(terms):
            places = [k for k, (_, term) in enumerate(terms) if term is None]
            if {sign for sign, _ in terms} != {"+"} or places != [len(terms) - 2]:
                raise UnreadableError(Trouble.ELLIPSIS, "dots that are not the last but one of terms to be added", at)
            return elided(tuple(term for _, term in printed[:-1]), printed[-1][1], self.names, at)
        return printed[0][1] if len(printed) == 1 and printed[0][0] == "+" else Sum(tuple(printed))

    def term(self, items: Items, i: int, integral: bool = False) -> tuple[Tree, int]:
        """Read a product, up to a sign, the end, or the differential of an integral."""
        factors: list[Tree] = []
        # Whether a dot was printed before what comes next.
        dotted = True
        at = items[min(i, len(items) - 1)].at
        while i < len(items):
            item = items[i]
            if (item.kind == "sign" and not (dotted and factors)) or (integral and _is_differential(items, i)):
                break
            if item.kind in ("dot", "slash") and dotted:
                raise UnreadableError(Trouble.TEX, f"found {item.text}, expected a factor", item.at)
            at = item.at
            if item.kind == "dot":
                dotted, i = True, i + 1
                continue
            if item.kind == "slash":
                return self._over(_product(factors, self.names, at), items, i)
            if self._is_operator(item):
                return self._differentiated(factors, items, i)
            found, i = self._next(items, i, factors, dotted)
            factors += found
            dotted = False
        if dotted:
            raise UnreadableError(Trouble.TEX, "found no factor where one is expected", at)
        return _product(factors, self.names, at), i

    def _next(self, items: Items, i: int, before: list[Tree], dotted: bool) -> tuple[list[Tree], int]:
        """Read what comes next in a product."""
        item = items[i]
        if item.kind == "sign":
            return self._signed(items, i)
        if item.kind == "big":
            big, end = self._big(items, i)
            if isinstance(big, BigSum) and any(big.index in walk(factor) for factor in before):
                raise UnreadableError(Trouble.SUM_SCOPE, "a factor before the sum has its index", item.at)
            return [big], end
        if item.kind == "number" and not dotted:
            raise UnreadableError(Trouble.NUMERAL, f"the numeral {item.text} stands right behind a factor", item.at)
        found, end = self.factors(items, i)
        if not dotted and item.kind == "fraction" and isinstance(before[-1], Number) and _is_numeric(found[0]):
            raise UnreadableError(Trouble.NUMERAL, "a number before a fraction of numbers has two readings", item.at)
        return found, end

    def _signed(self, items: Items, i: int) -> tuple[list[Tree], int]:
        r"""Read the sign of a single factor, as in `b \cdot -1`."""
        sign = items[i].text
        if sign not in "+-" or i + 1 == len(items) or items[i + 1].kind in _NO_FACTOR:
            raise UnreadableError(Trouble.TEX, f"found {sign}, expected a factor", items[i].at)
        found, end = self.factors(items, i + 1)
        if len(found) > 1:
            raise UnreadableError(Trouble.TEX, "a sign within a product, before several factors", items[i].at)
        return [Sum(((sign, found[0]),)) if sign == "-" else found[0]], end

    def _over(self, above: Tree, items: Items, i: int) -> tuple[Tree, int]:
        slash = items[i]
        if i + 1 == len(items) or items[i + 1].kind in _NO_FACTOR:
            raise UnreadableError(Trouble.SLASH, "found a slash, expected a factor behind it", slash.at)
        below, i = self.factors(items, i + 1)
        if len(below) > 1 or (i < len(items) and items[i].kind != "sign"):
            raise UnreadableError(Trouble.SLASH, "more than one factor behind a slash has two readings", slash.at)
        return Quotient(above, below[0]), i

    def _big(self, items: Items, i: int) -> tuple[Tree, int]:
        """Read a sum or an integral: both limits, and the rest of the term."""
        sign = items[i]
        limits = scripts_after(items, i + 1)
        if len(limits.below) != 1 or len(limits.above) != 1 or limits.primes:
            raise UnreadableError(Trouble.OPERATOR, f"{sign.text} needs both limits", sign.at)
        below, upper = limits.below[0], self.sum(limits.above[0], sign.at)
        i = limits.end
        if i == len(items) or items[i].kind in ("sign", "dot"):
            raise UnreadableError(Trouble.OPERATOR, f"{sign.text} needs something behind it", sign.at)
        if sign.text == "\\int":
            lower = self.sum(below, sign.at)
            body, i = self.term(items, i, integral=True)
            if i == len(items) or not _is_differential(items, i):
                raise UnreadableError(Trouble.OPERATOR, "an integral without its differential", sign.at)
            variable, i = (items[i + 1], i + 2) if items[i].text == "d" else (_behind_d(items[i]), i + 1)
            return Integral(self._declared(variable), lower, upper, body), i
        if [item.text for item in below if item.kind == "relation"] != ["="]:
            raise UnreadableError(Trouble.OPERATOR, "below a sum is expected: index = lower limit", sign.at)
        index, lower = (self.sum(side, sign.at) for side in split(below, "relation"))
        if not isinstance(index, Named) or not is_integer(index, self.names):
            raise UnreadableError(Trouble.KINDS, "the index of a sum is a declared integer", sign.at)
        body, i = self.term(items, i)
        return BigSum(index, lower, upper, body), i

    def _declared(self, letter: Item) -> Named:
        found, _ = self.factors((letter,), 0)
        if len(found) != 1 or not isinstance(found[0], Named):
            raise UnreadableError(Trouble.OPERATOR, f"no differential of a declared name: {letter.text!r}", letter.at)
        return found[0]

    # Derivatives: d/dt before or behind what is differentiated, dx/dt, ∂E/∂C.

    def _is_operator(self, item: Item) -> bool:
        """Whether a fraction is d/dt, to some order, without what it differentiates above it."""
        if item.kind != "fraction" or not item.parts[0] or _by(item) is None:
            return False
        first, *rest = item.parts[0]
        return (first.kind == "partial" or first.text == "d") and all(x.kind == "sup" for x in rest)

    def _derivative_by(self, item: Item) -> tuple[Tree, Tree]:
        """Return variable and order of a derivative."""
        found = _by(item)
        assert found is not None
        if item.parts[1][0].kind != "partial":
            self._check_d(item.at)
        variable = self.sum(found[0], item.at)
        if not isinstance(variable, Named):
            raise UnreadableError(Trouble.OPERATOR, "a derivative is by a declared name", item.at)
        return variable, self.sum(found[1], item.at) if found[1] else Number("1")

    def _check_d(self, at: int) -> None:
        if "d" in self.names.by_head:
            raise UnreadableError(Trouble.OPERATOR, "d is a declared name: a fraction with d has two readings", at)

    def _differentiated(self, factors: list[Tree], items: Items, i: int) -> tuple[Tree, int]:
        item = items[i]
        variable, order = self._derivative_by(item)
        raised = [x for x in item.parts[0] if x.kind == "sup"]
        if (self.sum(raised[0].parts[0], item.at) if raised else Number("1")) != order:
            raise UnreadableError(Trouble.OPERATOR, "the orders above and below are not the same", item.at)
        if i + 1 == len(items) or items[i + 1].kind == "sign":
            if not (factors and self.names.postfix):
                raise UnreadableError(Trouble.OPERATOR, "a derivative of nothing", item.at)
            return Derived(_product(factors, self.names, item.at), variable, order), i + 1
        body, end = self.factors(items, i + 1)
        if len(body) != 1 or (end < len(items) and items[end].kind != "sign"):
            raise UnreadableError(Trouble.OPERATOR, "how far the derivative reaches has two readings", item.at)
        return _product([*factors, Derived(body[0], variable, order)], self.names, item.at), end

    def _fraction(self, item: Item) -> Tree:
        above = item.parts[0]
        by = _by(item) if above else None
        if by is not None and above[0].kind == "partial" and len(above) > 1:
            return Derived(self.sum(above[1:], item.at), *self._derivative_by(item))
        if by is not None and _is_d_of_letter(above[0]) and len(above) == 1:
            return Derived(self._declared(_behind_d(above[0])), *self._derivative_by(item))
        return Quotient(self.sum(above, item.at), self.sum(item.parts[1], item.at))

    # Factors.

    def factors(self, items: Items, i: int) -> tuple[list[Tree], int]:
        """Read one factor with its scripts; a run of letters may be several."""
        item = items[i]
        if item.kind in _NAMES:
            return self._named(items, i)
        if item.kind == "group":
            return self._grouped(items, i)
        if item.kind == "function":
            tree, i = self._standard(item.text[1:], items, i)
        else:
            tree, i = self._atom(items, i), i + 1
        return self._behind(tree, None, items, i)

    def _named(self, items: Items, i: int) -> tuple[list[Tree], int]:
        item = items[i]
        if _is_leibniz(items, i):
            self._check_d(item.at)
            of, by = (self._declared(_behind_d(x)) for x in (item, items[i + 2]))
            return [Derived(of, by, Number("1"))], i + 3
        *first, head = cut(item, self.names) if item.kind == "run" else [head_of(item)]
        if item.kind in ("upright", "text") and head not in self.names.by_head:
            raise UnreadableError(Trouble.WORD, f"the text {item.text!r} is no declared name", item.at)
        alone = scripts_after((item,), 1)
        before = [resolve(letter, item.at, (item,), alone, self.names, self.sum)[0] for letter in first]
        if any(d.kind == "standard function" for d in self.names.by_head.get(head, ())):
            tree, i = self._standard(head, items, i)
            found, i = self._behind(tree, None, items, i)
        else:
            tree, left, i = resolve(head, item.at, items, scripts_after(items, i + 1), self.names, self.sum)
            found, i = self._behind(tree, left, items, i)
            self._check_call(items, i, tree)
        return [*before, *found], i

    def _check_call(self, items: Items, i: int, tree: Tree) -> None:
        """Refuse a name before a bracket that holds a single name, or a list: that looks like an argument."""
        if i == len(items) or items[i].kind != "fence" or items[i].text != "()":
            return
        content = items[i].parts[0]
        applied = isinstance(tree, Named) and tree.arguments is not None
        single = bool(content) and bool(head_of(content[0])) and all(_is_script(x) for x in content[1:])
        if not applied and (single or len(split(content)) > 1):
            raise UnreadableError(Trouble.APPLICATION, "looks like a function that is not declared", items[i].at)

    def _behind(self, tree: Tree, left: Items | None, items: Items, i: int) -> tuple[list[Tree], int]:
        """Read what stands behind a factor: an exponent, factorials, a label."""
        if left is not None:
            tree = self._raised(tree, left)
        while i < len(items):
            item = items[i]
            if item.kind == "sup" and left is None:
                left = item.parts[0]
                tree = self._raised(tree, left)
            elif item.kind == "bang":
                if isinstance(tree, Factorial):
                    raise UnreadableError(Trouble.OPERATOR, "n!! has two readings", item.at)
                tree = Factorial(tree)
            elif item.kind == "sub" and isinstance(tree, Matrix):
                label = "".join(x.text for x in item.parts[0])
                if label not in self.names.labels:
                    raise UnreadableError(
                        Trouble.UNDECLARED, f"{label!r} below a bracket is no declared label", item.at
                    )
                tree = Labelled(tree, label)
            elif _is_script(item):
                raise UnreadableError(Trouble.SCRIPT, f"found {item.text!r} where nothing takes it", item.at)
            else:
                break
            i += 1
        return [tree], i

    def _raised(self, base: Tree, content: Items) -> Tree:
        if len(content) == 1 and content[0].text == "T" and kind_of(base, self.names) == "matrix":
            return Transpose(base)
        return Power(base, self.sum(content, content[0].at if content else 0))

    def _grouped(self, items: Items, i: int) -> tuple[list[Tree], int]:
        """Read braces that a script follows: `{x}'`, `{P_1}_x`, a matrix in braces."""
        item = items[i]
        content = item.parts[0]
        if i + 1 == len(items) or not _is_script(items[i + 1]):
            raise UnreadableError(Trouble.TEX, "braces round a sum print no brackets", item.at)
        head = head_of(content[0]) if content else ""
        if head in self.names.by_head and all(_is_script(x) for x in content[1:]):
            flat = (*content, *items[i + 1 :])
            scripts = scripts_after(flat, 1, layered=True)
            tree, left, end = resolve(head, item.at, flat, scripts, self.names, self.sum)
            found, end = self._behind(tree, left, flat, end)
            self._check_call(flat, end, tree)
            return found, end - len(content) + i + 1
        if len(content) != 1:
            raise UnreadableError(Trouble.SCRIPT, "a script on braces that hold more than one thing", item.at)
        return self._behind(self._atom(content, 0), None, items, i + 1)

    def _standard(self, name: str, items: Items, i: int) -> tuple[Tree, int]:
        """Read sin, cos and the like: a bracket, or one letter that nothing else follows."""
        at = items[i].at
        scripts = scripts_after(items, i + 1)
        if scripts.below or scripts.primes:
            raise UnreadableError(Trouble.SCRIPT, f"{name} takes no index and no prime", at)
        i = scripts.end
        power = self.sum(scripts.above[0], at) if scripts.above else None
        if power is not None and not (isinstance(power, Number) and is_integer(power, self.names)):
            raise UnreadableError(Trouble.FUNCTION_POWER, f"a power of {name} that is no whole number", at)
        item = items[i] if i < len(items) else Item("", "", at)
        if item.kind == "fence" and item.text == "()":
            argument, i = self.sum(item.parts[0], item.at), i + 1
        elif item.kind in ("run", "letter", "fraction") and _ends(items, i + 1):
            found, i = self.factors(items, i)
            if len(found) != 1:
                raise UnreadableError(Trouble.FUNCTION_ARGUMENT, f"how far {name} reaches has two readings", item.at)
            argument = found[0]
        else:
            raise UnreadableError(Trouble.FUNCTION_ARGUMENT, f"what {name} is of has no brackets", item.at)
        tree = Call(name, argument)
        return (Power(tree, power) if power is not None else tree), i

    def _atom(self, items: Items, i: int) -> Tree:
        """Read a factor that is one item and no name."""
        item = items[i]
        if item.kind == "number":
            return Number(item.text)
        if item.kind == "fence":
            return self._fence(item)
        if item.kind == "fraction":
            return self._fraction(item)
        if item.kind in ("binomial", "root"):
            return self._pair(item)
        if item.kind == "rows" and item.text in ("bmatrix", "pmatrix"):
            return matrix(item, self.names, self.sum)
        raise _no_factor(item)

    def _pair(self, item: Item) -> Tree:
        one, other = item.parts
        if item.kind == "binomial":
            return Binomial(self.sum(one, item.at), self.sum(other, item.at))
        under = self.sum(other, item.at)
        return Root(self.sum(one, item.at), under) if one else Call("sqrt", under)

    def _fence(self, item: Item) -> Tree:
        content = item.parts[0]
        if item.text == "\\{.":
            return cases(item, self.sum, lambda condition, at: chain(condition, self.names, at))
        if (
            item.text in ("()", "[]")
            and len(content) == 1
            and content[0].kind == "rows"
            and content[0].text in MATRICES
        ):
            return matrix(content[0], self.names, self.sum)
        entries = split(content)
        if len(entries) == 1 and item.text in ("()", "[]", *_BARS):
            value = self.sum(content, item.at)
            if item.text in _BARS and isinstance(value, Listing) and value.brackets == "{}":
                raise UnreadableError(Trouble.KINDS, "bars round a list", item.at)
            return Call(_BARS[item.text], value) if item.text in _BARS else value
        if item.text not in ("()", "{}", "\\{\\}"):
            raise UnreadableError(Trouble.DELIMITERS, f"found {item.text} round a list", item.at)
        if any(len(entry) == 1 and entry[0].kind == "dots" for entry in entries):
            raise UnreadableError(Trouble.ELLIPSIS, "dots in a list", item.at)
        values = tuple(self.sum(entry, item.at) for entry in entries)
        return Listing("()" if item.text == "()" else "{}", values)


def kind_of(tree: Tree, names: Names) -> str:
    """Return what a tree is: real, integer, point, matrix, list; real where nothing says more."""
    if isinstance(tree, Named):
        value = names.by_pattern[tree.name].value
        return "point" if value == "plane point" else value
    if isinstance(tree, Matrix | Transpose | Labelled | Components):
        return "matrix"
    if isinstance(tree, Listing):
        return "point" if tree.brackets == "()" else "list"
    if isinstance(tree, Power):
        return kind_of(tree.base, names)
    if isinstance(tree, Sum | Product | Quotient | Derived | BigSum):
        kinds = {kind_of(part, names) for part in parts(tree)}
        return next((kind for kind in ("matrix", "point", "list") if kind in kinds), "real")
    return "real"


def _product(factors: list[Tree], names: Names, at: int) -> Tree:
    if len(factors) == 1:
        return factors[0]
    if sum(kind_of(factor, names) in ("point", "list") for factor in factors) > 1:
        raise UnreadableError(Trouble.KINDS, "a product of two points: which one is not told", at)
    return Product(tuple(factors))


def _check_scope(terms: list[Tree], at: int) -> None:
    """Refuse a term beside a sum that has the sum's index: it may belong below the sum."""
    for k, term in enumerate(terms):
        for big in (node for node in walk(term) if isinstance(node, BigSum)):
            others = (other for m, other in enumerate(terms) if m != k)
            if any(not _is_bound(other, big.index) for other in others):
                raise UnreadableError(
                    Trouble.SUM_SCOPE, f"a term beside the sum over {big.index.name} has that index too", at
                )


def _is_bound(tree: Tree, index: Named) -> bool:
    """Whether an index stands in a tree only where a sum of its own binds it."""
    if isinstance(tree, BigSum) and tree.index == index:
        return index not in walk(tree.lower) and index not in walk(tree.upper)
    return tree != index and all(_is_bound(part, index) for part in parts(tree))


def _by(item: Item) -> tuple[Items, Items] | None:
    """Return variable and order below a fraction `d../dt`, `∂../∂C`; None where it is no such fraction."""
    below = item.parts[1]
    if not below:
        return None
    first, *rest = below
    if _is_d_of_letter(first):
        below = (_behind_d(first), *rest)
    elif first.kind == "partial" or (first.text == "d" and rest and rest[0].kind == "letter"):
        below = tuple(rest)
    else:
        return None
    if not below or not head_of(below[0]):
        return None
    order = next((x.parts[0] for x in below[1:] if x.kind == "sup"), ())
    return tuple(x for x in below if x.kind != "sup"), order


def _is_d_of_letter(item: Item) -> bool:
    return item.kind == "run" and len(item.text) == 2 and item.text[0] == "d"


def _behind_d(item: Item) -> Item:
    return Item("run", item.text[1:], item.at + 1)


def _is_differential(items: Items, i: int) -> bool:
    """Whether `dt`, or d and a Greek letter, stand at the end of a term."""
    greek = items[i].text == "d" and i + 1 < len(items) and items[i + 1].kind == "letter"
    end = i + 1 + greek
    return (greek or _is_d_of_letter(items[i])) and (end == len(items) or items[end].kind == "sign")


def _is_leibniz(items: Items, i: int) -> bool:
    three = items[i : i + 3]
    return len(three) == 3 and three[1].kind == "slash" and _is_d_of_letter(three[0]) and _is_d_of_letter(three[2])


def _is_script(item: Item) -> bool:
    return item.kind in ("sub", "sup", "prime")


def _ends(items: Items, i: int) -> bool:
    """Whether an argument without brackets ends here without a doubt."""
    return i == len(items) or items[i].kind in ("sign", "dot", "function")


def _is_numeric(tree: Tree) -> bool:
    return isinstance(tree, Quotient) and isinstance(tree.numerator, Number) and isinstance(tree.denominator, Number)


def _no_factor(item: Item) -> UnreadableError:
    if item.kind == "rows":
        return UnreadableError(Trouble.LAYOUT, "rows without brackets within a formula", item.at)
    if item.kind == "word":
        return UnreadableError(Trouble.WORD, f"found the word {item.text!r} within an expression", item.at)
    trouble = Trouble.ELLIPSIS if item.kind == "dots" else Trouble.TEX
    return UnreadableError(trouble, f"found {item.text!r}, expected a factor", item.at)
