"""Pseudo-code: each rule on a few lines, exact values, and what must not run to its end."""

from fractions import Fraction

import pytest
import sympy as sp

from semispline.papers.pseudocode import UnreadableCodeError, load, run
from semispline.papers.pseudocode.errors import FaultError, LimitError
from semispline.papers.pseudocode.running import Limits
from semispline.papers.pseudocode.values import Vector

HALF, THIRD = Fraction(1, 2), Fraction(1, 3)


def value(text, *arguments, call="f", **given):
    return run(load(text), call, arguments, given).value


def body(*lines, head="function f(x):"):
    return "\n".join((head, *(f"  {line}" for line in lines)))


@pytest.mark.parametrize(
    ("expression", "expected"),
    [
        ("1/3", THIRD),
        ("0.1 + 0.2", Fraction(3, 10)),
        ("2^3^2", 512),
        ("-2^2", -4),
        ("2^-1", HALF),
        ("2*x^2", 18),
        ("3! / (1!*(3-1)!)", 3),
        ("x!", 6),
        ("x - 1 - 1", 1),
        ("12 / 2 / 3", 2),
        ("12 / 2 * 3", 18),
        ("7 % 4", 3),
        ("x > 2 ? 1 : 2", 1),
        ("x < 2 ? 1 : x > 5 ? 2 : 3", 3),
        ("!(x == 3) || x >= 3 && true", True),
        ("x === 3 && x !== 4", True),
        ("pow(8, 1/3)", 2),
        ("sqrt(9/4)", Fraction(3, 2)),
        ("abs(-x)", 3),
        ("[1, [2, 3]][1][0]", 2),
        ("{a: 1, b: x}.b", 3),
        ("[4, 5, 6].length + [4].size", 4),
        ("[4, 5].last", 5),
        ("+x", 3),
    ],
)
def test_expressions_are_exact(expression, expected):
    assert value(body(f"return {expression}"), 3) == expected


def test_roots_stay_roots():
    assert value(body("return sqrt(x)"), 2) == sp.sqrt(2)
    assert value(body("return sqrt(x) < 1.42 && cos(pi/3) == 1/2"), 2) is True


def test_straight_lines_take_symbols():
    t = sp.Symbol("t")
    assert sp.expand(value(body("y = 1 - x", "return x*x + 2*x*y + y^2"), t)) == 1


HEADS = ("function f(x):", "f(x):", "f = function(x):", "function f(x) {")


@pytest.mark.parametrize("head", HEADS)
def test_heads_of_functions(head):
    ending = "\n}" if head.endswith("{") else ""
    assert value(body("return 2*x", head=head) + ending, 4) == 8


def test_a_head_may_name_its_result():
    assert value(body("found.add(x)", "found.push(2*x)", head="f(x) -> found:"), 4) == [4, 8]


def test_a_number_among_the_parameters_chooses():
    text = body("return t", head="function f(2,t):") + "\n" + body("return 0", head="function f(n,t):")
    assert (value(text, 2, 7), value(text, 3, 7)) == (7, 0)


@pytest.mark.parametrize(
    "loop",
    [
        "for(k=1; k<=x; k++):",
        "for(let k = 1; k <= x; k++) {",
        "for k = 1, k <= x, k += 1:",
    ],
)
def test_loops(loop):
    ending = "\n  }" if loop.endswith("{") else ""
    text = "\n".join(("function f(x):", "  sum = 0", f"  {loop}", f"    sum += k{ending}", "  return sum"))
    assert value(text, 4) == 10


def test_a_loop_with_two_beginnings_and_a_break_that_skips_the_step():
    text = "\n".join(
        (
            "function f(x):",
            "  for(i=1, last=x-1; i<last; i++):",
            "    if(i == 3) break;",
            "    if(i == 2):",
            "      continue",
            "  return i",
        )
    )
    assert (value(text, 9), value(text, 3)) == (3, 2)


def test_while_else_if_and_lists_of_names():
    text = "\n".join(
        (
            "function f(x):",
            "  var n = 0, big = [],",
            "      last;",
            "  while(x > 1):",
            "    if (x % 2 == 0) {",
            "      x /= 2;",
            "    } else if (x = 27) {",
            "      big.push(x); ",
            "      x = 3*x + 1;",
            "    } else {",
            "      x = 3*x + 1;",
            "    }",
            "    last = x, n++",
            "  return [n, last, big]",
        )
    )
    assert value(text, 6) == [8, 1, []]
    assert value(text, 27)[2] == [27]


def test_dot_and_cross_bind_before_other_products():
    u, v = Vector((1, 2, 3)), Vector((0, 1, 1))
    given = {"u": u, "v": v}
    assert value(body("return v * 2/x * v · u"), 2, **given) == Vector((0, 5, 5))
    assert value(body("return u × v"), 0, **given) == Vector((-1, -1, 1))
    assert value(body("return (u - v).y + new point(1, 2).x"), 0, **given) == 2


def test_records_and_things_with_methods():
    text = body("r = { o: c.at(x), t: 1 }", "r.t = r.o.x", "return r.t")
    assert value(text, 3, c={"at": lambda s: Vector((s, s * s))}) == 3


def test_names_may_begin_with_a_digit_and_lines_with_a_remark():
    assert value(body("// first", "2a = 2*x, 3b = 1  // second", "return 2a + 3b"), 3) == 7


def test_push_in_square_brackets_appends_what_is_in_them():
    assert value(body("all = []", "all.push[x, 2*x]", "return all"), 3) == [[3, 6]]


def test_variables_outside_of_functions_are_kept_and_own_ones_are_not():
    text = "found = []\ncount = 0\nfunction f(x):\n  own = x\n  count += 1\n  found.add(own)\n"
    outcome = run(load(text), "f", [5])
    assert outcome.variables == {"found": [5], "count": 1}


def test_the_callers_lists_are_not_touched():
    mine = [1, 2]
    assert value(body("x[0] = 7", "return x"), mine) == [7, 2]
    assert mine == [1, 2]


def test_a_filter_takes_a_printed_function():
    text = "function ok(v) {\n  return 0 <= v && v <= 1;\n}\n" + body("return [x, x/4, -x].filter(ok)")
    assert value(text, 2) == [HALF]


def test_code_without_a_function():
    text = "for(s=domain[0]; s < domain[1]; s++) {\n  if(knots[s] <= t) break;\n}"
    outcome = run(load(text), given={"domain": [1, 3], "knots": [9, 8, 7, 6], "t": 7})
    assert outcome.variables == {"s": 2}


def test_the_rules_that_were_used_are_kept_with_their_lines():
    program = load("function f(2,x) {\n  if x=0:\n    return n!\n  return new array(size=x^2)\n}")
    assert program.rules == (
        (1, "braces are dropped: blocks are told by indentation"),
        (1, "f is given for the value 2"),
        (2, "= in a condition compares"),
        (3, "! is a factorial"),
        (4, "^ is a power"),
        (4, "new is dropped"),
        (4, "size= only names an argument"),
    )


def test_what_no_rule_translates_is_replaced_and_said():
    text = "v = copy of points\n"
    with pytest.raises(UnreadableCodeError, match=r"^line 1: "):
        load(text)
    program = load(text, {"copy of points": "copy(points)"})
    assert program.rules == ((1, "'copy of points' is replaced by 'copy(points)'"),)
    assert run(program, given={"points": [1]}).variables == {"v": [1]}
    with pytest.raises(UnreadableCodeError, match="found 0 times, expected once"):
        load(text, {"copy of curves": "copy(points)"})


@pytest.mark.parametrize(
    "text",
    [
        "",
        "// nothing",
        "{\n  o: the origin,\n  t: a vector\n}",
        body("import os"),
        body("return lambda y: y"),
        body("return [y for y in x]"),
        body("return x if x else 1"),
        body("return x ** 2"),
        body("return 'text'"),
        body("return x @ 1"),
        body("return (x"),
        body("return x)"),
        body("return 1 < x < 3"),
        body("return g(a=1, b=2)"),
        body("x + 1"),
        body("1 = x"),
        body("if x"),
        body("else:"),
        body("for(i=0; i<3):"),
        "function f(x):\nreturn x",
        "function f(x):\n  return x\n    return 1",
        "function f(x) {\n  return x",
        "function f(x) {\n  if(x) {\n    y = 1\n}\n  }",
        "function f(x + 1):\n  return x",
        "  y = 1\n y = 2\n  y = 3",
        body("return " + "(" * 5000 + "x" + ")" * 5000),
        body("return " + "-" * 5000 + "x"),
    ],
)
def test_what_is_no_code_is_refused(text):
    with pytest.raises(UnreadableCodeError):
        load(text)


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        (["return y"], "line 2: y has no value"),
        (["y = 1", "return x[3]"], "line 3: the index 3 of a list of 2"),
        (["return x[0-1]"], "line 2: the index -1 of a list of 2"),
        (["return x[1/2]"], "line 2: the index 1/2 of a list of 2"),
        (["x[2] = 1"], "line 2: the index 2 of a list of 2"),
        (["y = array(2)", "return y[0]"], "line 3: a place of a list or a record that has no value yet"),
        (["var y", "return y"], "line 3: y has no value yet"),
        (["return 1/(x[0]-1)"], "line 2: a division by zero"),
        (["return 0^-1"], "line 2: a division by zero"),
        (["return 1 % 0"], "line 2: a division by zero"),
        (["return (1/2)!"], "line 2: the factorial of 1/2, which is no whole number from 0 on"),
        (["return x + 1"], "line 2: \\+ of a list and a number"),
        (["if(x):", "  return 1"], "line 2: a condition that is neither true nor false"),
        (["return x.__class__"], "line 2: .__class__ of what has none"),
        (["return x.append(1)"], "line 2: .append of a list"),
        (["return eval(1)"], "line 2: eval is no function that is printed or given"),
        (["return __import__(1)"], "line 2: __import__ is no function that is printed or given"),
        (["return f(1, 2)"], "line 2: f is not printed for these 2 values"),
        (["return x()"], "line 2: a call of what is no function"),
        (["return array(1000000)"], "line 2: the index 1000000 of a list of 10000"),
    ],
)
def test_what_does_not_run_is_said_with_the_printed_line(lines, message):
    with pytest.raises(FaultError, match=f"^{message}$"):
        value(body(*lines), [1, 2])


def test_a_condition_on_symbols_is_not_decided():
    with pytest.raises(FaultError, match="line 2: a condition that is not decided"):
        value(body("if(x < 1) return 1"), sp.Symbol("t", real=True))


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        (["while(true):", "  x = x"], "more than 20000 steps"),
        (["return f(x)"], "more than 60 calls in each other"),
        (["for(i=0; i<99; i++):", "  x = x*x"], "a number of more than 20000 bits"),
        (["for(i=0; i<99; i++):", "  x = x^x"], "(an exponent above 1000|a number of more than 20000 bits)"),
        (["return 2^1001"], "an exponent above 1000"),
        (["return 2000!"], "the factorial of a number above 1000"),
        (["y = []", "while(true):", "  y.add(1)"], "(more than 20000 steps|a list of more than 10000)"),
    ],
)
def test_what_takes_too_much_is_ended(lines, message):
    with pytest.raises(LimitError, match=message):
        value(body(*lines), 3)


@pytest.mark.parametrize(
    "lines", [["for(i=0; i<99; i++):", "  x = x*x"], ["for(i=0; i<99; i++):", "  x = (x+1)*(x+i)"]]
)
def test_symbols_that_grow_are_ended(lines):
    with pytest.raises(LimitError):
        value(body(*lines), sp.Symbol("t"))


def test_calls_within_brackets_are_ended_before_python_is():
    text = body("return " + "(1 + " * 30 + "f(x)" + ")" * 30)
    with pytest.raises(LimitError):
        run(load(text), "f", [1], limits=Limits(steps=10**6, depth=10**6))


@pytest.mark.parametrize("given", [0.5, "text", object(), {1.5}])
def test_what_is_not_exact_is_not_taken(given):
    with pytest.raises(FaultError, match="expected an exact number, a list, a point, a record"):
        value(body("return x"), given)
    with pytest.raises(FaultError):
        value(body("return g(x)"), 1, g=lambda x: given)
