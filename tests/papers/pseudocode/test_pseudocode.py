"""Pseudo-code: each rule on a few lines, exact values, and what must not run to its end."""

import re
from fractions import Fraction

import pytest
import sympy as sp

from semispline.papers.pseudocode import (
    CodeError,
    CodeFaultError,
    CodeLimitError,
    Limits,
    OpenConditionError,
    read_code,
    run_code,
)

HALF, THIRD = Fraction(1, 2), Fraction(1, 3)


def value(text, *arguments, call="f", **given):
    names = [f"argument{n}" for n in range(len(arguments))]
    return run_code(text, f"{call}({', '.join(names)})", dict(zip(names, arguments, strict=True)) | given).value


def point(*entries):
    return dict(zip("xyz", entries, strict=False))


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
        ("x ** 2", 9),
        ("1 < x < 3", False),
        ("1 < x <= 3", True),
        ("min(x, 2) + max(x, 2)", 5),
        ("0^(1/2)", 0),
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
    u, v = point(1, 2, 3), point(0, 1, 1)
    given = {"u": u, "v": v}
    assert value(body("return v * 2/x * v · u"), 2, **given) == point(0, 5, 5)
    assert value(body("return u × v"), 0, **given) == point(-1, -1, 1)
    assert value(body("return (u - v).y + new point(1, 2).x"), 0, **given) == 2


def test_records_and_things_with_methods():
    text = body("r = { o: c.at(x), t: 1 }", "r.t = r.o.x", "return r.t")
    assert value(text, 3, c={"at": lambda s: point(s, s * s)}) == 3


def test_names_may_begin_with_a_digit_and_lines_with_a_remark():
    assert value(body("// first", "2a = 2*x, 3b = 1  // second", "return 2a + 3b"), 3) == 7


def test_push_in_square_brackets_appends_what_is_in_them():
    assert value(body("all = []", "all.push[x, 2*x]", "return all"), 3) == [3, 6]


def test_variables_outside_of_functions_are_kept_and_own_ones_are_not():
    text = "found = []\ncount = 0\nfunction f(x):\n  own = x\n  count += 1\n  found.add(own)\n"
    outcome = run_code(text, "f(5)")
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
    outcome = run_code(text, given={"domain": [1, 3], "knots": [9, 8, 7, 6], "t": 7})
    assert outcome.variables == {"s": 2}


def test_the_rules_that_were_used_are_kept_with_their_lines():
    program = read_code("function f(2,x) {\n  if x=0:\n    return n!\n  return new array(size=x^2)\n}")
    assert program.rules == (
        (1, "blocks are told by braces where there are some"),
        (1, "f is given for the value 2"),
        (2, "= in a condition compares"),
        (3, "! is a factorial"),
        (4, "^ is a power"),
        (4, "new is dropped"),
        (4, "size= only names an argument"),
    )


def test_rules_that_say_more_than_signs_are_kept_too():
    lines = ("y <- 2x", "for i = 1 to 3:", "  if 0 < i <= x:", "    y += z[i, 0]", "z.push[y]")
    assert read_code("g(x) -> z:\n  " + "\n  ".join(lines)).rules == (
        (1, "z begins empty and is what the function gives"),
        (2, "a number before a name multiplies it"),
        (2, "an arrow or := assigns"),
        (3, "a loop to a number includes that"),
        (4, "of comparisons in a row all must hold"),
        (5, "[i, j] is [i][j]"),
        (6, "push[..] is push(..)"),
    )


def test_what_no_rule_reads_is_replaced_and_said():
    text = "v = copy of points\n"
    with pytest.raises(CodeError, match=r"^line 1: "):
        read_code(text)
    replace = {"copy of points": "copy(points)"}
    assert read_code(text, replace).rules == ((1, "'copy of points' is replaced by 'copy(points)'"),)
    assert run_code(text, given={"points": [1]}, replace=replace).variables == {"v": [1]}
    with pytest.raises(CodeError, match="found 'copy of curves' 0 times, expected it once"):
        read_code(text, {"copy of curves": "copy(points)"})


def test_braces_within_blocks_of_a_colon_and_blocks_of_a_colon_within_braces():
    inner = "function f(x):\n  if (x > 2) {\n    x = 1\n  }\n  return x\ny = 5"
    assert run_code(inner, "f(3)").value == 1
    assert run_code(inner).variables == {"y": 5}
    outer = "function f(x) {\n  if x > 2:\n    x = 1\n    x += 1\n  else if (x == 2) x = 7\n  return x\n}"
    assert [value(outer, x) for x in (1, 2, 3)] == [1, 7, 2]


def test_an_else_without_braces_is_that_of_the_if_above_it():
    text = "function f(x) {\n  if (x > 1)\n    if (x > 2)\n      return 3\n  else\n    return 1\n  return 2\n}"
    assert [value(text, x) for x in (1, 2, 3)] == [1, 2, 3]


def test_braces_count_where_indentation_says_something_else():
    text = "function f(x) {\n  if(x > 1) {\n    x = 7\n}\n  return x\n  }"
    assert [value(text, x) for x in (1, 2)] == [1, 7]


def test_a_declared_name_is_the_functions_own():
    text = "n = 1\nm = 1\nfunction f(x):\n  var n = x, k\n  m = x\n  return n"
    outcome = run_code(text, "f(4)")
    assert (outcome.value, outcome.variables) == (4, {"n": 1, "m": 4})


def test_an_assignment_in_an_assignment_runs_its_value_once():
    assert (
        value("n = []\n" + body("n.add(x)", "return 0", head="g(x):") + "\n" + body("a = b = g(x)", "return n.size"), 1)
        == 1
    )


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
        body("return x @ 1"),
        body("return (x"),
        body("return x)"),
        body("return g(a=1, b=2)"),
        body("1 = x"),
        body("if x"),
        body("else:"),
        body("for(i=0; i<3):"),
        "function f(x):\nreturn x",
        "function f(x):\n  return x\n    return 1",
        "function f(x) {\n  return x",
        "function f(x) {\n  if(x)\n    y = 1\n    z = 1\n}",
        "function f(x) {\n  if(x)\n}",
        "function f(x) {\n  {\n    y = 1\n  }\n}",
        "if x:\n    y = 1\n  z = 1",
        body("y = 1 = x"),
        body("1++"),
        "function f(x + 1):\n  return x",
        "  y = 1\n y = 2\n  y = 3",
        body("return " + "(" * 5000 + "x" + ")" * 5000),
        body("return " + "-" * 5000 + "x"),
    ],
)
def test_what_is_no_code_is_refused(text):
    with pytest.raises(CodeError):
        read_code(text)


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        (["return y"], "line 2: found y, which has no value"),
        (["y = 1", "return x[3]"], "line 3: found the index 3, expected 0 .. 1"),
        (["return x[0-1]"], "line 2: found the index -1, expected 0 .. 1"),
        (["return x[1/2]"], "line 2: found 1/2 for an index, expected a whole number"),
        (["x[2] = 1"], "line 2: found the index 2, expected 0 .. 1"),
        (["y = array(2)", "return y[0]"], "line 3: found a place of a list or a record that has no value yet"),
        (["var y", "return y"], "line 3: found y, which has no value yet"),
        (["y", "y = 1"], "line 2: found y, which has no value"),
        (["return 1/(x[0]-1)"], "line 2: found 1 divided by 0"),
        (["return 0^-1"], "line 2: found 0 to a negative power"),
        (["return 0^(-1/2)"], "line 2: found 0 to the power -1/2"),
        (["return 1 % 0"], "line 2: found the remainder of 1 divided by 0"),
        (["return (1/2)!"], "line 2: found 1/2 for a factorial, expected a whole number"),
        (["return (0-1)!"], "line 2: found the factorial of -1, expected 0 .. 1000"),
        (["return x + 1"], "line 2: found [1, 2] + 1, expected numbers, or vectors of one size"),
        (["return abs(x)"], "line 2: found the size of [1, 2], expected a number"),
        (["return min(x, 1)"], "line 2: found [1, 2], 1, expected numbers"),
        (["return max(1, x)"], "line 2: found [1, 2] > 1, expected numbers"),
        (["return 'text' + 1"], "line 2: found text with +, expected numbers"),
        (["if(x):", "  return 1"], "line 2: found [1, 2] as a condition, expected true or false"),
        (["break"], "line 2: found break, expected a loop around it"),
        (["return x.__class__"], "line 2: found the field __class__ of [1, 2], which has none of that name"),
        (["return x.clear()"], "line 2: found clear of a list, expected add, push, append, pop or filter"),
        (["return eval(1)"], "line 2: found eval, which has no value"),
        (["return __import__(1)"], "line 2: found __import__, which has no value"),
        (["return f(1, 2)"], "line 2: found f of 1, 2, for which it is not defined"),
        (["return x()"], "line 2: found a call of [1, 2], expected a function"),
        (["return array(1000000)"], "line 2: found the size 1000000, expected 0 .. 10000"),
    ],
)
def test_what_does_not_run_is_said_with_the_printed_line(lines, message):
    with pytest.raises(CodeFaultError, match=f"^{re.escape(message)}$"):
        value(body(*lines), [1, 2])


def test_what_is_wrong_in_the_call_is_said_of_the_call():
    with pytest.raises(CodeFaultError, match=r"^the call, line 2: found b, which has no value$"):
        run_code(body("return x"), "a = 1\nf(b)")
    with pytest.raises(CodeFaultError, match=r"^line 2: found y, which has no value$"):
        run_code(body("return y"), "a = 1\nf(a)")
    with pytest.raises(CodeError, match=r"^the call, line 1: "):
        run_code(body("return x"), "f(1")


def test_a_condition_on_symbols_is_not_decided():
    with pytest.raises(OpenConditionError, match="line 2: found the condition on t and 1, which letters leave open"):
        value(body("if(x < 1) return 1"), sp.Symbol("t", real=True))


@pytest.mark.parametrize(
    ("lines", "message"),
    [
        (["while(true):", "  x = x"], "line [23]: found more than 20000 steps, expected an end before"),
        (["return f(x)"], "line 2: found calls 60 deep, expected an end before"),
        (["for(i=0; i<99; i++):", "  x = x*x"], "line 3: found a number of \\d+ bits, expected at most 20000"),
        (["for(i=0; i<99; i++):", "  x = x^x"], "line 3: found (the exponent|a power of more than 20000 bits)"),
        (["return 2^1001"], "line 2: found the exponent 1001, expected at most 1000"),
        (["return (2^900)^900"], "line 2: found a power of more than 20000 bits"),
        (["return 2000!"], "line 2: found the factorial of 2000, expected 0 .. 1000"),
        (["y = []", "while(true):", "  y.add(1)"], "(more than 20000 steps|a list of more than 10000)"),
        (["y = []", "y.add(y)", "return y"], "line .*: found calls and brackets too deep in each other"),
    ],
)
def test_what_takes_too_much_is_ended(lines, message):
    with pytest.raises(CodeLimitError, match=message):
        value(body(*lines), 3)


@pytest.mark.parametrize(
    "lines", [["for(i=0; i<99; i++):", "  x = x*x"], ["for(i=0; i<99; i++):", "  x = (x+1)*(x+i)"]]
)
def test_symbols_that_grow_are_ended(lines):
    with pytest.raises(CodeLimitError):
        value(body(*lines), sp.Symbol("t"))


def test_calls_within_brackets_are_ended_before_python_is():
    text = body("return " + "(1 + " * 30 + "f(x)" + ")" * 30)
    with pytest.raises(CodeLimitError):
        run_code(text, "f(1)", limits=Limits(steps=10**6, depth=10**6))


@pytest.mark.parametrize("given", [0.5, object(), {1.5}, 1j, [1, 0.5], {"x": 0.5}, 0.5 * sp.Symbol("t"), sp.Float(1)])
def test_what_is_not_exact_is_not_taken(given):
    with pytest.raises(CodeFaultError, match="expected an exact number"):
        value(body("return x"), given)
    with pytest.raises(CodeFaultError, match=r"^line 2: found .*, expected an exact number"):
        value(body("return g(x)"), 1, g=lambda x: given)
