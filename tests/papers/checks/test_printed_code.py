"""Printed code against formulas: as it stands, whatever it does, and with each sign and number mistaken in turn."""

import pickle

import pytest
import sympy as sp

from semispline.papers.checks.carrying_out import UnsuitableError
from semispline.papers.checks.printed_code import Code, code
from semispline.papers.ledger.mutation import try_mutants
from semispline.papers.ledger.records import CheckFailedError, EndlessError, Part
from semispline.papers.ledger.writing import formula
from semispline.papers.pseudocode.values import Limits
from semispline.papers.recheck import NotExpressibleError
from semispline.papers.recheck.by_fractions import agrees

n, k = sp.symbols("n k", integer=True)
t, x = sp.symbols("t x")
w = sp.IndexedBase("w")
CURVE = sp.Sum(w[k] * sp.binomial(n, k) * t**k * (1 - t) ** (n - k), (k, 0, n))
TRIANGLE = """
function curve(points[], t):
  if(points.length==1):
    return points[0]
  else:
    newpoints=array(points.size-1)
    for(i=0; i<newpoints.length; i++):
      newpoints[i] = (1-t) * points[i] + t * points[i+1]
    return curve(newpoints, t)
"""


def points(at):
    return {"P": [w[j] for j in range(int(at[n]) + 1)]}


def claim(expression, text, call, **more):
    return formula(sp.Eq(expression, Code(text, call, **more), evaluate=False))


def test_a_recursion_is_a_formula_for_each_degree():
    check = code(each={n: range(4)}, given=points)
    printed = claim(CURVE, TRIANGLE, "curve(P, t)")
    assert [case.true for case in check.cases(printed)] == [True] * 4
    statements = list(check.export(printed))
    assert all(statement.true and agrees(statement) for statement in statements)
    # What a second system is told is what the code did, not what it comes to.
    assert statements[2].right == "(1 - t)*((1 - t)*w_0_ + t*w_1_) + t*((1 - t)*w_1_ + t*w_2_)"
    assert try_mutants(Part(check, printed)).survivors == ()


def test_a_loop_that_stops_too_early_is_false_at_the_smallest_degree():
    text = "f(n, t):\n  s = 0\n  for(i=0; i<n; i++):\n    s += t^i\n  return s"
    check = code(each={n: range(3)})
    printed = claim(sp.Sum(t**k, (k, 0, n)), text, "f(n, t)")
    assert [case.true for case in check.cases(printed)] == [False] * 3
    assert str(check.search(printed)) == "n = 0: printed 0, true 1"
    assert all(not statement.true and agrees(statement) for statement in check.export(printed))


def test_points_lists_and_truths_are_compared_part_by_part():
    text = "f(a):\n  return [point(a, 2*a), a > 1]"
    check = code(each={n: (1, 2)})
    printed = claim(sp.Tuple(n, 2 * n, sp.Symbol("big")), text, "f(n)")
    by_instance = code(each={n: (1, 2)}, where=lambda at: {sp.Symbol("big"): sp.true if at[n] > 1 else sp.false})
    assert [case.true for case in by_instance.cases(printed)] == [True, True]
    assert not any(case.true for case in check.cases(claim(sp.Tuple(n, n), text, "f(n)")))
    (case,) = code(each={n: [3]}).cases(claim(sp.Tuple(n, 3 * n, sp.true), text, "f(n)"))
    assert case.label == "n = 3, value 2"
    with pytest.raises(NotExpressibleError):
        list(by_instance.export(printed))


def test_what_code_leaves_behind_is_asked_for_by_more_code():
    text = "left = []\nfunction cut(a):\n  left.add(a)\n  if(a < 3):\n    cut(a + 1)"
    check = code(each={n: (1, 2)})
    assert all(case.true for case in check.cases(claim(3 * sp.Min(1, n), text, "cut(n)\nleft.last * 1")))


@pytest.mark.parametrize(
    ("text", "problem"),
    [
        ("f(n):\n  return a[n]", "found the index 1, expected 0 .. 0"),
        ("f(n):\n  return b", "line 2: found b, which has no value"),
        ("f(n):\n  return n / (n - n)", "divided by 0"),
    ],
)
def test_code_that_cannot_run_is_false_and_says_where(text, problem):
    (case,) = code(each={n: [1]}, given={"a": [1]}).cases(claim(n, text, "f(n)"))
    assert not case.true
    assert problem in str(case.residual)


def test_code_that_does_not_end_gives_no_answer():
    endless = claim(n, "f(n):\n  while(true):\n    n = n", "f(n)")
    with pytest.raises(EndlessError, match=r"line \d: found more than 100 steps"):
        list(code(each={n: [1]}, limits=Limits(steps=100)).cases(endless))
    # A change that makes a loop endless is noticed all the same.
    loop = claim(n, "f(n):\n  i = 0\n  while(i < n):\n    i += 1\n  return i", "f(n)")
    result = try_mutants(Part(code(each={n: range(4)}, limits=Limits(steps=500)), loop))
    assert result.survivors == ()
    assert result.undefined > 0


def test_a_condition_on_letters_gives_no_answer():
    with pytest.raises(CheckFailedError, match="which letters leave open"):
        list(code().cases(claim(x, "f(x):\n  if(x < 1):\n    return x\n  return x", "f(x)")))


def test_words_that_are_no_code_are_replaced_openly():
    text = "let v = copy of points\nv[0] = 7"
    printed = claim(sp.Integer(1), text, "points[0]", replace={"copy of points": "copy(points)"})
    assert [case.true for case in code(given={"points": [1, 2]}).cases(printed)] == [True]
    assert printed.relation.rhs.replaced == {"copy of points": "copy(points)"}
    with pytest.raises(UnsuitableError, match="found 'clone' 0 times"):
        Code(text, "v", replace={"clone": "copy"})


def test_a_formula_without_code_is_refused():
    with pytest.raises(UnsuitableError, match="found no code"):
        list(code().cases(formula(sp.Eq(x, t))))


def test_code_travels_between_processes():
    made = Code("f(n):\n  return clone n", "f(n)", {"clone n": "n"}, "line 2")
    again = pickle.loads(pickle.dumps(made))
    assert (again, again.replaced, again.note) == (made, {"clone n": "n"}, "line 2")
