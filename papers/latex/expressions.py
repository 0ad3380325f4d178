"""Expressions: sums of terms, terms of factors, read against the table of names.

What may be read in two ways is refused: a slash before more than one factor, a word that is no name, a power between a
function and its bracket, a term beside a sum that has the sum's index.
"""

from __future__ import annotations

from semispline.papers.latex.errors import Trouble, UnreadableError
from semispline.papers.latex.names import Names
from semispline.papers.latex.resolving import cut, head_of, is_integer, resolve, scripts_after
from semispline.papers.latex.tokens import MATRICES, Item, Items, split
from semispline.papers.latex.trees import (
    BigSum,
    Binomial,
    Call,
    Cases,
    Components,
    Derived,
    Elided,
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
_DEPTH = 60


def expression(items: Items, names: Names, at: int = 0) -> Tree:
    """Read items that are one expression.

    Raises
    ------
    UnreadableError
    """
    return _Expressions(names).sum(items, at)


class _Expressions:
    """The rules of expressions under one table of names; `depth` says how many brackets are open."""

    def __init__(self, names: Names, depth: int = 0) -> None:
        self.names, self.depth = names, depth

    def inner(self, items: Items, at: int) -> Tree:
        """Read what stands in a bracket, an index, a cell."""
        if self.depth > _DEPTH:
            raise UnreadableError(Trouble.TEX, f"more than {_DEPTH} brackets in each other", at)
        return _Expressions(self.names, self.depth + 1).sum(items, at)

    def sum(self, items: Items, at: int) -> Tree:
        if not items:
            raise UnreadableError(Trouble.TEX, "found nothing, expected an expression", at)
        if len(items) == 1 and items[0].kind == "group":
            return self.inner(items[0].parts[0], at)  # type: ignore[arg-type]
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
        printed = [term for _, term in terms if term is not None]
        for k, term in enumerate(printed):
            for big in _big_sums(term):
                if any(
                    big.index in walk(other)
                    for m, other in enumerate(printed)
                    if m != k and not _bound(other, big.index)
                ):
                    raise UnreadableError(
                        Trouble.SUM_SCOPE, f"a term beside the sum over {big.index.name} has that index too", at
                    )
        if len(printed) < len(terms):
            return self._elided_sum(terms, at)
        if len(terms) == 1 and terms[0][0] == "+":
            return printed[0]
        return Sum(tuple((sign, term) for sign, term in terms if term is not None))

    def _elided_sum(self, terms: list[tuple[str, Tree | None]], at: int) -> Tree:
        signs = {sign for sign, _ in terms}
        values = [term for _, term in terms]
        if signs != {"+"} or [k for k, value in enumerate(values) if value is None] != [len(values) - 2]:
            raise UnreadableError(Trouble.ELLIPSIS, "dots that are not the last but one of terms that are added", at)
        before = tuple(value for value in values[:-2] if value is not None)
        last = values[-1]
        assert last is not None
        return self._elided(before, last, at)

    def _elided(self, before: tuple[Tree, ...], last: Tree, at: int) -> Elided:
        """Read dots between terms: first and last differ in one integer expression, and what is between follows."""
        if not before:
            raise UnreadableError(Trouble.ELLIPSIS, "dots without a beginning", at)
        found = _one_difference(before[0], last)
        if found is None or not all(is_integer(side, self.names) for side in found):
            raise UnreadableError(Trouble.ELLIPSIS, "first and last term differ in more than one integer", at)
        start, end = found
        steps = [_one_difference(before[0], term) for term in before[1:]]
        if any(step is None or step[1] != _plus(start, k) for k, step in enumerate(steps, 1)):
            raise UnreadableError(Trouble.ELLIPSIS, "the terms before the dots do not go on one by one", at)
        if len(before) == 1 and not _differ_in_slots(before[0], last):
            raise UnreadableError(Trouble.ELLIPSIS, "one term before the dots, and not only indices change", at)
        return Elided(before[0], last, start, end, before)

    def term(self, items: Items, i: int, integral: bool = False) -> tuple[Tree, int]:
        """Read a product, up to a sign or the end."""
        factors: list[Tree] = []
        explicit = True
        last_at = items[i].at if i < len(items) else (items[-1].at if items else 0)
        while i < len(items):
            item = items[i]
            if item.kind == "sign":
                if not (explicit and factors):
                    break
                factor, i = self._signed(items, i)
                factors.append(factor)
            elif item.kind == "dot":
                if explicit:
                    raise UnreadableError(Trouble.TEX, f"found {item.text}, expected a factor", item.at)
                explicit, i, last_at = True, i + 1, item.at
                continue
            elif item.kind == "slash":
                if explicit:
                    raise UnreadableError(Trouble.SLASH, "found a slash, expected a factor", item.at)
                return self._over(_product(factors, self.names, last_at), items, i)
            elif integral and _is_differential(items, i):
                break
            elif item.kind == "big":
                big, i = self._big(items, i)
                if isinstance(big, BigSum) and any(big.index in walk(factor) for factor in factors):
                    raise UnreadableError(Trouble.SUM_SCOPE, "a factor before the sum has its index", item.at)
                factors.append(big)
            elif self._is_operator(items, i):
                return self._differentiated(factors, items, i)
            else:
                if item.kind == "number" and not explicit:
                    raise UnreadableError(
                        Trouble.NUMERAL, f"the numeral {item.text} stands right behind a factor", item.at
                    )
                found, i = self.factors(items, i)
                mixed = not explicit and isinstance(factors[-1], Number) and item.kind == "fraction"
                if mixed and _is_numeric(found[0]):
                    raise UnreadableError(
                        Trouble.NUMERAL, "a number before a fraction of numbers has two readings", item.at
                    )
                factors += found
            explicit, last_at = False, item.at
        if explicit:
            raise UnreadableError(Trouble.TEX, "found no factor where one is expected", last_at)
        return _product(factors, self.names, last_at), i

    def _signed(self, items: Items, i: int) -> tuple[Tree, int]:
        """Read the sign of a single factor, as in `b \\cdot -1`."""
        sign = items[i].text
        if sign not in "+-" or i + 1 == len(items) or items[i + 1].kind in ("sign", "dot", "slash", "big"):
            raise UnreadableError(Trouble.TEX, f"found {sign}, expected a factor", items[i].at)
        found, end = self.factors(items, i + 1)
        if len(found) > 1:
            raise UnreadableError(Trouble.TEX, "a sign within a product, before several factors", items[i].at)
        return (Sum(((sign, found[0]),)) if sign == "-" else found[0]), end

    def _over(self, above: Tree, items: Items, i: int) -> tuple[Tree, int]:
        slash = items[i]
        if i + 1 == len(items) or items[i + 1].kind in ("sign", "dot", "slash", "big"):
            raise UnreadableError(Trouble.SLASH, "found a slash, expected a factor behind it", slash.at)
        below, i = self.factors(items, i + 1)
        if len(below) > 1 or (i < len(items) and items[i].kind != "sign"):
            raise UnreadableError(Trouble.SLASH, "more than one factor behind a slash has two readings", slash.at)
        return Quotient(above, below[0]), i

    def _big(self, items: Items, i: int) -> tuple[Tree, int]:
        sign = items[i]
        limits = scripts_after(items, i + 1)
        if len(limits.below) != 1 or len(limits.above) != 1 or limits.primes:
            raise UnreadableError(Trouble.OPERATOR, f"{sign.text} needs both limits", sign.at)
        below, above = limits.below[0], limits.above[0]
        i = limits.end
        if i == len(items) or items[i].kind in ("sign", "dot"):
            raise UnreadableError(Trouble.OPERATOR, f"{sign.text} needs something behind it", sign.at)
        if sign.text == "\\int":
            lower, upper = self.inner(below, sign.at), self.inner(above, sign.at)
            body, i = self.term(items, i, integral=True)
            if i == len(items) or not _is_differential(items, i):
                raise UnreadableError(Trouble.OPERATOR, "an integral without its differential", sign.at)
            letter = items[i + 1] if items[i].text == "d" else Item("run", items[i].text[1:], items[i].at + 1)
            return Integral(self._declared(letter), lower, upper, body), i + (2 if items[i].text == "d" else 1)
        sides = split(below, "relation")
        relation = [item.text for item in below if item.kind == "relation"]
        if relation != ["="]:
            raise UnreadableError(Trouble.OPERATOR, "below a sum is expected: index = lower limit", sign.at)
        index = self.inner(sides[0], sign.at)
        if not isinstance(index, Named) or not is_integer(index, self.names):
            raise UnreadableError(Trouble.KINDS, "the index of a sum is a declared integer", sign.at)
        lower, upper = self.inner(sides[1], sign.at), self.inner(above, sign.at)
        body, i = self.term(items, i)
        return BigSum(index, lower, upper, body), i

    def _differential(self, item: Item) -> Named:
        return self._declared(Item("run", item.text[1:], item.at + 1))

    def _declared(self, letter: Item) -> Named:
        variable, end = self.factors((letter,), 0)
        if end != 1 or len(variable) != 1 or not isinstance(variable[0], Named):
            raise UnreadableError(Trouble.OPERATOR, f"no differential of a declared name: {letter.text!r}", letter.at)
        return variable[0]

    def _is_operator(self, items: Items, i: int) -> bool:
        """Whether a fraction is d/dt, to some order, without what it differentiates above it."""
        item = items[i]
        if item.kind != "fraction":
            return False
        above = item.parts[0]
        return (
            bool(above) and _is_d(above[0]) and all(x.kind == "sup" for x in above[1:]) and self._by(item) is not None
        )  # type: ignore[union-attr]

    def _by(self, item: Item) -> tuple[Items, Items] | None:
        """Return variable and order below a fraction `d../dt`, `∂../∂C`; None where it is no such fraction."""
        below: Items = item.parts[1]  # type: ignore[assignment]
        if not below:
            return None
        first = below[0]
        if first.kind == "run" and first.text[0] == "d" and len(first.text) == 2:
            below = (Item("run", first.text[1:], first.at + 1), *below[1:])
        elif first.kind == "partial" or (first.text == "d" and len(below) > 1 and below[1].kind == "letter"):
            below = below[1:]
        else:
            return None
        if not below or not head_of(below[0]):
            return None
        orders = [x for x in below[1:] if x.kind == "sup"]
        return tuple(x for x in below if x.kind != "sup"), orders[0].parts[0] if orders else ()  # type: ignore[return-value]

    def _check_d(self, at: int) -> None:
        if "d" in self.names.by_head:
            raise UnreadableError(Trouble.OPERATOR, "d is a declared name: a fraction with d has two readings", at)

    def _derivative_by(self, item: Item) -> tuple[Tree, Tree]:
        found = self._by(item)
        assert found is not None
        if item.parts[1][0].kind != "partial":  # type: ignore[union-attr]
            self._check_d(item.at)
        variable = self.inner(found[0], item.at)
        if not isinstance(variable, Named):
            raise UnreadableError(Trouble.OPERATOR, "a derivative is by a declared name", item.at)
        return variable, self.inner(found[1], item.at) if found[1] else Number("1")

    def _differentiated(self, factors: list[Tree], items: Items, i: int) -> tuple[Tree, int]:
        item = items[i]
        variable, order = self._derivative_by(item)
        above: Items = item.parts[0]  # type: ignore[assignment]
        own = self.inner(above[1].parts[0], item.at) if len(above) > 1 else Number("1")  # type: ignore[arg-type]
        if own != order:
            raise UnreadableError(Trouble.OPERATOR, "the orders above and below are not the same", item.at)
        at_end = i + 1 == len(items) or items[i + 1].kind == "sign"
        if at_end and factors and self.names.postfix:
            return Derived(_product(factors, self.names, item.at), variable, order), i + 1
        if at_end:
            raise UnreadableError(Trouble.OPERATOR, "a derivative of nothing", item.at)
        body, end = self.factors(items, i + 1)
        if len(body) != 1 or (end < len(items) and items[end].kind != "sign"):
            raise UnreadableError(Trouble.OPERATOR, "how far the derivative reaches has two readings", item.at)
        return _product([*factors, Derived(body[0], variable, order)], self.names, item.at), end

    def factors(self, items: Items, i: int) -> tuple[list[Tree], int]:
        """Read one factor with its scripts; a run of letters may be several."""
        item = items[i]
        before: list[Tree] = []
        left: Items | None = None
        is_name = False
        if item.kind in ("run", "upright", "letter", "accent", "text"):
            if self._is_leibniz(items, i):
                return [self._leibniz(items, i)], i + 3
            *first, head = cut(item, self.names) if item.kind == "run" else [head_of(item)]
            if item.kind in ("upright", "text") and head not in self.names.by_head:
                raise UnreadableError(Trouble.WORD, f"the text {item.text!r} is no declared name", item.at)
            for letter in first:
                tree, _, _ = resolve(letter, item.at, (item,), scripts_after((item,), 1), self.names, self.inner)
                before.append(tree)
            if any(d.kind == "standard function" for d in self.names.by_head.get(head, ())):
                tree, i = self._standard(head, items, i)
            else:
                tree, left, i = resolve(head, item.at, items, scripts_after(items, i + 1), self.names, self.inner)
                is_name = True
        elif item.kind == "group":
            return self._grouped(items, i)
        elif item.kind == "function":
            tree, i = self._standard(item.text[1:], items, i)
        else:
            tree, i = self._atom(items, i)
        found, i = self._behind(tree, left, items, i, is_name)
        return [*before, *found], i

    def _behind(self, tree: Tree, left: Items | None, items: Items, i: int, is_name: bool) -> tuple[list[Tree], int]:
        """Read what stands behind a factor: exponents, factorials, labels."""
        if left is not None:
            tree = self._raised(tree, left)
        while i < len(items):
            item = items[i]
            if item.kind == "sup" and left is None:
                left = item.parts[0]  # type: ignore[assignment]
                tree = self._raised(tree, left)  # type: ignore[arg-type]
            elif item.kind == "bang":
                if isinstance(tree, Factorial):
                    raise UnreadableError(Trouble.OPERATOR, "n!! has two readings", item.at)
                tree = Factorial(tree)
            elif item.kind == "sub" and isinstance(tree, Matrix):
                label = "".join(x.text for x in item.parts[0])  # type: ignore[union-attr]
                if label not in self.names.labels:
                    raise UnreadableError(
                        Trouble.UNDECLARED, f"{label!r} below a bracket is no declared label", item.at
                    )
                tree = Labelled(tree, label)
            elif item.kind in ("sub", "prime", "sup"):
                raise UnreadableError(Trouble.SCRIPT, f"found {item.text!r} where nothing takes it", item.at)
            else:
                break
            i += 1
        if is_name and i < len(items) and _is_call(items[i], tree, self.names):
            raise UnreadableError(Trouble.APPLICATION, "looks like a function that is not declared", items[i].at)
        return [tree], i

    def _raised(self, base: Tree, content: Items) -> Tree:
        at = content[0].at if content else 0
        if self._kind(base) == "matrix" and len(content) == 1 and content[0].text == "T":
            return Transpose(base)
        return Power(base, self.inner(content, at))

    def _kind(self, tree: Tree) -> str:
        return kind_of(tree, self.names)

    def _grouped(self, items: Items, i: int) -> tuple[list[Tree], int]:
        """Read braces that scripts follow: `{x}'`, `{P_1}_x`, a matrix in braces; or braces round a sum that is alone."""
        item = items[i]
        content: Items = item.parts[0]  # type: ignore[assignment]
        following = items[i + 1].kind if i + 1 < len(items) else ""
        if following not in ("sub", "sup", "prime"):
            raise UnreadableError(Trouble.TEX, "braces round a sum print no brackets", item.at)
        head = head_of(content[0]) if content else ""
        if head and head in self.names.by_head and all(x.kind in ("sub", "sup", "prime") for x in content[1:]):
            flat = (*content, *items[i + 1 :])
            scripts = scripts_after(flat, 1, layered=True)
            tree, left, end = resolve(head, item.at, flat, scripts, self.names, self.inner)
            found, end = self._behind(tree, left, flat, end, is_name=True)
            return found, end - len(content) + i + 1
        if len(content) != 1:
            raise UnreadableError(Trouble.SCRIPT, "a script on braces that hold more than one thing", item.at)
        tree, end = self._atom(content, 0)
        return self._behind(tree, None, items, i + 1, is_name=False)

    def _standard(self, name: str, items: Items, i: int) -> tuple[Tree, int]:
        """Read sin, cos and the like: a bracket, or one letter that nothing else follows."""
        at = items[i].at
        scripts = scripts_after(items, i + 1)
        if scripts.below or scripts.primes or len(scripts.above) > 1:
            raise UnreadableError(Trouble.SCRIPT, f"{name} takes no index and no prime", at)
        i = scripts.end
        power: Tree | None = None
        if scripts.above:
            power = self.inner(scripts.above[0], at)
            if not (isinstance(power, Number) and is_integer(power, self.names)):
                raise UnreadableError(Trouble.FUNCTION_POWER, f"a power of {name} that is no whole number", at)
        if i == len(items):
            raise UnreadableError(Trouble.FUNCTION_ARGUMENT, f"{name} without an argument", at)
        item = items[i]
        if item.kind == "fence" and item.text == "()":
            argument = self.inner(item.parts[0], item.at)  # type: ignore[arg-type]
            i += 1
        elif item.kind in ("run", "letter", "fraction") and (
            i + 1 == len(items) or items[i + 1].kind in ("sign", "dot", "function")
        ):
            found, i = self.factors(items, i)
            if len(found) != 1:
                raise UnreadableError(Trouble.FUNCTION_ARGUMENT, f"how far {name} reaches has two readings", item.at)
            argument = found[0]
        else:
            raise UnreadableError(Trouble.FUNCTION_ARGUMENT, f"how far {name} reaches has two readings", item.at)
        tree: Tree = Call(name, argument)
        return (Power(tree, power) if power is not None else tree), i

    def _is_leibniz(self, items: Items, i: int) -> bool:
        three = items[i : i + 3]
        return (
            len(three) == 3
            and [x.kind for x in three] == ["run", "slash", "run"]
            and all(x.text[0] == "d" and len(x.text) == 2 for x in (three[0], three[2]))
        )

    def _leibniz(self, items: Items, i: int) -> Tree:
        self._check_d(items[i].at)
        return Derived(self._differential(items[i]), self._differential(items[i + 2]), Number("1"))

    def _atom(self, items: Items, i: int) -> tuple[Tree, int]:
        item = items[i]
        if item.kind == "number":
            return Number(item.text), i + 1
        if item.kind == "fence":
            return self._fence(item, items[i - 1].text if i else ""), i + 1
        if item.kind == "fraction":
            return self._fraction(item), i + 1
        if item.kind == "binomial":
            return Binomial(*(self.inner(part, item.at) for part in item.parts)), i + 1  # type: ignore[arg-type]
        if item.kind == "root":
            degree, radicand = item.parts
            under = self.inner(radicand, item.at)  # type: ignore[arg-type]
            return (Root(self.inner(degree, item.at), under) if degree else Call("sqrt", under)), i + 1  # type: ignore[arg-type]
        if item.kind == "rows" and item.text in ("bmatrix", "pmatrix"):
            return self._matrix(item), i + 1
        if item.kind == "rows":
            raise UnreadableError(Trouble.LAYOUT, "rows without brackets within a formula", item.at)
        if item.kind == "word":
            raise UnreadableError(Trouble.WORD, f"found the word {item.text!r} within an expression", item.at)
        trouble = Trouble.ELLIPSIS if item.kind == "dots" else Trouble.TEX
        raise UnreadableError(trouble, f"found {item.text!r}, expected a factor", item.at)

    def _fraction(self, item: Item) -> Tree:
        above: Items = item.parts[0]  # type: ignore[assignment]
        by = self._by(item) if above else None
        if by is not None and above[0].kind == "partial" and len(above) > 1:
            variable, order = self._derivative_by(item)
            return Derived(self.inner(above[1:], item.at), variable, order)
        if by is not None and above[0].kind == "run" and above[0].text[0] == "d" and len(above[0].text) == 2:
            variable, order = self._derivative_by(item)
            return Derived(self._differential(above[0]), variable, order)
        return Quotient(self.inner(above, item.at), self.inner(item.parts[1], item.at))  # type: ignore[arg-type]

    def _fence(self, item: Item, before: str) -> Tree:
        content: Items = item.parts[0]  # type: ignore[assignment]
        if item.text == "\\{.":
            return self._cases(item)
        if item.text in _BARS:
            value = self.inner(content, item.at)
            if isinstance(value, Listing):
                raise UnreadableError(Trouble.KINDS, "bars round a list", item.at)
            return Call(_BARS[item.text], value)
        if (
            item.text in ("()", "[]")
            and len(content) == 1
            and content[0].kind == "rows"
            and content[0].text in MATRICES
        ):
            return self._matrix(content[0])
        entries = split(content)
        if before == "\\in" and len(entries) == 2 and item.text[0] in "([":
            return Interval(item.text, *(self.inner(entry, item.at) for entry in entries))
        if len(entries) == 1 and item.text in ("()", "[]"):
            return self.inner(content, item.at)
        if item.text not in ("()", "{}", "\\{\\}"):
            raise UnreadableError(Trouble.DELIMITERS, f"found {item.text} round a list", item.at)
        if any(len(entry) == 1 and entry[0].kind == "dots" for entry in entries):
            raise UnreadableError(Trouble.ELLIPSIS, "dots in a list", item.at)
        values = tuple(self.inner(entry, item.at) for entry in entries)
        return Listing("()" if item.text == "()" else "{}", values)

    def _matrix(self, item: Item) -> Tree:
        rows: list[tuple[Tree, ...]] = []
        cells: list[tuple[Items, ...]] = list(item.parts)  # type: ignore[arg-type]
        named = [any(x.kind == "relation" for x in cell) for row in cells for cell in row]
        if any(named):
            return self._components(cells, item.at)
        flat = [cell for row in cells for cell in row]
        if any(len(cell) == 1 and cell[0].kind == "dots" for cell in flat):
            return self._elided_matrix(cells, item.at)
        for row in cells:
            rows.append(tuple(self.inner(cell, cell[0].at if cell else item.at) for cell in row))
            if len(rows[-1]) != len(rows[0]):
                raise UnreadableError(
                    Trouble.LAYOUT, f"a matrix with rows of {len(rows[0])} and {len(rows[-1])}", item.at
                )
        if not rows:
            raise UnreadableError(Trouble.LAYOUT, "a matrix without rows", item.at)
        return Matrix(tuple(rows))

    def _elided_matrix(self, cells: list[tuple[Items, ...]], at: int) -> Tree:
        """Read one row, or one column, with dots before its last entry."""
        is_row = len(cells) == 1
        flat = list(cells[0]) if is_row else [row[0] for row in cells if len(row) == 1]
        if not is_row and len(flat) != len(cells):
            raise UnreadableError(Trouble.ELLIPSIS, "dots in a matrix of rows and columns", at)
        places = [k for k, cell in enumerate(flat) if len(cell) == 1 and cell[0].kind == "dots"]
        if places != [len(flat) - 2]:
            raise UnreadableError(Trouble.ELLIPSIS, "dots that are not the last but one of the entries", at)
        *before, _, last = flat
        sequence = self._elided(tuple(self.inner(c, at) for c in before), self.inner(last, at), at)
        return Matrix(((sequence,),)) if is_row else Transpose(Matrix(((sequence,),)))

    def _components(self, cells: list[tuple[Items, ...]], at: int) -> Tree:
        entries: list[tuple[Tree, Tree]] = []
        for row in cells:
            cell = tuple(x for part in row for x in part)
            relations = [x.text for x in cell if x.kind == "relation"]
            if relations != ["="]:
                raise UnreadableError(Trouble.LAYOUT, "a relation in a matrix, where not every row is name = ..", at)
            name, value = (self.inner(side, at) for side in split(cell, "relation"))
            if not isinstance(name, Named):
                raise UnreadableError(Trouble.LAYOUT, "a relation in a matrix, where not every row is name = ..", at)
            entries.append((name, value))
        return Components(tuple(entries))

    def _cases(self, item: Item) -> Tree:
        content: Items = item.parts[0]  # type: ignore[assignment]
        if len(content) != 1 or content[0].kind != "rows":
            raise UnreadableError(Trouble.LAYOUT, "a brace with no rows behind it", item.at)
        found: list[tuple[Tree, Statement | None]] = []
        for row in content[0].parts:
            cells: tuple[Items, ...] = row  # type: ignore[assignment]
            if len(cells) != 2 or not cells[1] or cells[1][0].kind != "word":
                raise UnreadableError(Trouble.LAYOUT, "cases are: value & if condition, or value & otherwise", item.at)
            word, *condition = cells[1]
            value = self.inner(cells[0], item.at)
            if word.text == "otherwise" and not condition:
                found.append((value, None))
            elif word.text == "when" and condition:
                found.append((value, chain(tuple(condition), self.names, item.at)))
            else:
                raise UnreadableError(Trouble.LAYOUT, "cases are: value & if condition, or value & otherwise", item.at)
        return Cases(tuple(found))


def chain(items: Items, names: Names, at: int) -> Statement:
    """Read sides with relations between them."""
    relations = tuple(item.text for item in items if item.kind == "relation")
    return Statement(tuple(_side(items, k, names, at) for k in range(len(relations) + 1)), relations)


def _side(items: Items, k: int, names: Names, at: int) -> Tree:
    side = split(items, "relation")[k]
    places = [m for m, item in enumerate(items) if item.kind == "relation"]
    # What stands before a bracket tells an interval from a point.
    if k and items[places[k - 1]].text == "\\in" and len(side) == 1 and side[0].kind == "fence":
        return _Expressions(names)._fence(side[0], "\\in")
    return expression(side, names, side[0].at if side else at)


def kind_of(tree: Tree, names: Names) -> str:
    """Return what a tree is: real, integer, point, matrix, list; real where nothing says more."""
    if isinstance(tree, Named):
        declaration = names.by_pattern.get(tree.name)
        value = declaration.value if declaration else "real"
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


def _is_d(item: Item) -> bool:
    return item.kind == "partial" or (item.kind == "run" and item.text == "d")


def _is_differential(items: Items, i: int) -> bool:
    """Whether `dt`, or d and a Greek letter, stand at the end of a term."""
    item = items[i]
    width = 2 if item.text == "d" and i + 1 < len(items) and items[i + 1].kind == "letter" else 1
    ends = i + width == len(items) or items[i + width].kind == "sign"
    return ends and item.kind == "run" and item.text[0] == "d" and len(item.text) + width == 3


def _is_numeric(tree: Tree) -> bool:
    return isinstance(tree, Quotient) and isinstance(tree.numerator, Number) and isinstance(tree.denominator, Number)


def _is_call(item: Item, tree: Tree, names: Names) -> bool:
    """Whether a bracket behind a name holds a single name, or a list: then it looks like an argument."""
    if item.kind != "fence" or item.text != "()" or (isinstance(tree, Named) and tree.arguments is not None):
        return False
    content: Items = item.parts[0]  # type: ignore[assignment]
    single = bool(content) and bool(head_of(content[0])) and all(x.kind in ("sub", "sup", "prime") for x in content[1:])
    return single or len(split(content)) > 1


def _big_sums(tree: Tree) -> list[BigSum]:
    return [node for node in walk(tree) if isinstance(node, BigSum)]


def _bound(tree: Tree, index: Named) -> bool:
    """Whether an index stands in a tree only where a sum of its own binds it."""
    if isinstance(tree, BigSum) and tree.index == index:
        return index not in walk(tree.lower) and index not in walk(tree.upper)
    if tree == index:
        return False
    return all(_bound(part, index) for part in parts(tree))


def _one_difference(one: Tree, other: Tree) -> tuple[Tree, Tree] | None:
    """Return the only pair of integers in which two trees differ, however often; None where there is no such pair."""
    found = set(_differences(one, other))
    return next(iter(found)) if len(found) == 1 else None


def _differences(one: object, other: object) -> list[tuple[Tree, Tree]]:
    if one == other:
        return []
    whole = isinstance(one, Number | Sum | Named) and isinstance(other, Number | Sum | Named)
    same = isinstance(one, Named) and isinstance(other, Named) and one.name == other.name
    if (
        whole
        and not same
        and not (isinstance(one, Sum) and isinstance(other, Sum) and len(one.terms) == len(other.terms))
    ):
        return [(one, other)]  # type: ignore[list-item]
    if type(one) is not type(other):
        return [(one, other)]  # type: ignore[list-item]
    mine, yours = list(parts(one)), list(parts(other))
    if len(mine) != len(yours) or not mine:
        return [(one, other)]  # type: ignore[list-item]
    return [pair for a, b in zip(mine, yours, strict=True) for pair in _differences(a, b)]


def _differ_in_slots(one: Tree, other: Tree) -> bool:
    """Whether two trees differ only within the indices of names."""
    if one == other:
        return True
    if isinstance(one, Named) and isinstance(other, Named) and one.name == other.name:
        return one.arguments == other.arguments or all(
            _differ_in_slots(a, b) for a, b in zip(one.arguments or (), other.arguments or (), strict=True)
        )
    mine, yours = list(parts(one)), list(parts(other))
    return (
        type(one) is type(other) and bool(mine) and len(mine) == len(yours) and all(map(_differ_in_slots, mine, yours))
    )


def _plus(tree: Tree, k: int) -> Tree:
    return Number(str(int(tree.text) + k)) if isinstance(tree, Number) else Sum((("+", tree), ("+", Number(str(k)))))
