"""How many functions and knots there are, and where a domain ends: for every order, by the steps of the recurrence."""

from __future__ import annotations

from functools import cache
from typing import Any

import sympy as sp

from semispline.derivations.properties import basis_table


@cache
def functions_of_order(last: Any, order: Any) -> Any:
    """Return how many functions of an order the knots 0 .. `last` have.

    Of order 1 there are `last`. Each step of the recurrence makes one function of two neighbours.
    """
    functions, r = sp.Function("c"), sp.Symbol("r", integer=True)
    number = sp.rsolve(functions(r + 1) - functions(r) + 1, functions(r), {functions(1): last})
    return sp.expand(number.subs(r, order))


@cache
def last_knot(count: Any, order: Any) -> Any:
    """Return the index of the last knot that `count` + 1 functions of an order need."""
    last = sp.Symbol("L")
    (solution,) = sp.solve(functions_of_order(last, order) - (count + 1), last)
    return sp.expand(solution)


@cache
def support_end(first: Any, order: Any) -> Any:
    """Return the index of the knot at which function `first` of an order ends; it starts at knot `first`.

    Order 1 ends one knot on; each step of the recurrence takes in the next function (`locality`).
    """
    end, r = sp.Function("e"), sp.Symbol("r", integer=True)
    return sp.expand(sp.rsolve(end(r + 1) - end(r) - 1, end(r), {end(1): first + 1}).subs(r, order))


def domain_ends(count: Any, order: Any) -> tuple[Any, Any]:
    """Return the indices of the first and the last knot of the domain.

    One step of the recurrence turns the sum of all functions of an order into that of the next lower one, but for its
    first and last function, which enter with a factor: so the sum is 1 where these two vanish, from the end of the
    first one on, up to the start of the last one, which is the knot of its own index.
    """
    last_below = functions_of_order(last_knot(count, order), order - 1) - 1
    return support_end(sp.Integer(0), order - 1), sp.expand(last_below)


@cache
def functions_on(n_knots: int, order: int) -> int:
    """Return how many basis functions of an order live on n distinct knots, by running Cox-de Boor.

    On fewer knots than twice the order, too few for a span where the functions sum to 1, it is 0.
    """
    table = basis_table(order - 1, list(range(n_knots))) if n_knots >= 2 * order else {}
    return len(next(iter(table.values()))) if table else 0
