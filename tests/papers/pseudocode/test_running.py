"""Printed code is read by rules and run exactly; what is no code, or does what it must not, is told by its line."""

from fractions import Fraction

import pytest
import sympy as sp

from semispline.papers.pseudocode.errors import CodeError, CodeFaultError, CodeLimitError, OpenConditionError
from semispline.papers.pseudocode.running import run_code

x = sp.Symbol("x")


@pytest.mark.parametrize(
    ("text", "call", "value"),
    [
        # Heads of functions.
        ("function f(a, b):\n  return a - b", "f(5, 2)", 3),
        ("f = function(a):\n  return a^2", "f(3)", 9),
        ("f(a):\n  return a!", "f(4)", 24),
        ("def f(a):\n  return a", "f(2)", 2),
        ("f(n) -> s:\n  s = n + 1", "f(1)", 2),
        ("function f(a) {\n  return 2*a;\n}", "f(3)", 6),
        ("function f(2, t):\n  return t\nfunction f(3, t):\n  return 10*t", "f(3, 4)", 40),
        # Loops.
        ("s=0\nfor(i=0; i<4; i++):\n  s += i", "s + 0", 6),
        ("s=0\nfor i = 1, i <= 4, i += 1:\n  s = s + i", "s + 0", 10),
        ("s=0\nfor i = 1 to 4 do\n  s = s + i\nend", "s + 0", 10),
        ("s=0\nfor i = 4 downto 2 step 2:\n  s = s + i", "s + 0", 6),
        ("s=0\nfor i in 1..4:\n  s = s + i", "s + 0", 10),
        ("s=0\nfor i from 1 to 3:\n  s = s + i", "s + 0", 6),
        ("s=0\nfor each a in [1, 2, 4]:\n  s += a", "s + 0", 7),
        ("s=1\nwhile s < 100:\n  s *= 3", "s + 0", 243),
        ("s=1\nrepeat:\n  s *= 3\nuntil s > 100", "s + 0", 243),
        ("s=0;\nfor (var i = 0; i < 9; i++) {\n  if (i == 2) continue;\n  if (i > 3) break;\n  s += i\n}", "s + 0", 4),
        # Expressions.
        ("", "2 + 3 * 4^2 / 8 - 1", 7),
        ("", "-2^2", -4),
        ("", "2^-1 + 2^3^0", Fraction(5, 2)),
        ("", "7 mod 4 + 7 div 4", 4),
        ("", "0.1 + 0.2", Fraction(3, 10)),
        ("", "1.5e2", 150),
        ("a = 3", "2a + 2(a + 1)", 14),
        ("2a = 5\nb = 2a * 2", "b + 0", 10),
        ("a = 1\nb = a <- 1 ? 4 : 5", "b + 0", 5),
        ("a = 2", "1 < a <= 2 ? 1 : 0", 1),
        ("a = 1", "(a = 1 && !(a = 2) || false) ? 8 : 9", 8),
        ("a = sqrt(16/9) + pow(8, 1/3)", "a + 0", Fraction(10, 3)),
        ("", "floor(7/2) + ceil(7/2) + abs(-1) + min(3, 2) + max(3, 2)", 13),
        ("a ← 3\nb := a", "b + 0", 3),
        # Lists, records, vectors.
        ("a = [1, 2, [3, 4]]", "a[2][1] + a.length", 7),
        ("a = []\na.add(1)\na.push[2, 3]\na.append(4)", "a.size * a.last + a.first", 17),
        ("a = new array(size=3)\na[1] = 5", "a[1] + a.length", 8),
        ("p = {o: 1, t: [2, 3]}\np.o = 4", "p.o + p.t[1]", 7),
        ("v = [1, 2] + 2 * [3, 4] - [1, 1] / 2", "v[0] * 2 + v[1]", Fraction(45, 2)),
        ("v = [1, 2, 3] × [4, 5, 6]", "v · [1, 10, 100]", -3 + 60 - 300),
        ("p = new point(1, 2)\nq = 3 * p", "q.x + q.y", 9),
        ("", "[1, 2, 3, 4].filter(big).length", 2),
        ("a = 1, b = a + 1, c", "b + 0", 2),
        ("a = b = 4", "a + b", 8),
        # Layout.
        ("// nothing\na = 1 // one\n/* a = 2\n*/\n# a = 3", "a + 0", 1),
        ("a = [1,\n     2]\nb = a[0] +\n    a[1]", "b + 0", 3),
        ("if a = 1 then\n  b = 1\nelse if a = 2 then\n  b = 2\nelse\n  b = 3\nend", "b + 0", 2),
        ("if(a==1) b = 1\nelif(a==2): b = 20\nelse: b = 3", "b + 0", 20),
        ("if (a === 1) {\n  b = 1;\n} else if (a !== 2) { b = 2 }\nelse { b = 7; }", "b + 0", 7),
    ],
)  # fmt: skip
def test_what_papers_print_is_run(text, call, value):
    given = {"a": 2, "big": lambda item: item > 2}
    if any(text.startswith(word) for word in ("a =", "a ←", "2a", "p =", "v =")) or "a =" in text.split("if")[0]:
        del given["a"]
    assert run_code(text or "nothing = 0", call, given).value == value


def test_values_stay_exact_or_letters():
    assert run_code("f(t):\n  return (1-t)^2 / 3", "f(x)", {"x": x}).value == (1 - x) ** 2 / 3
    assert run_code("nothing = 0", "cos(pi/3) + acos(1)").value == sp.Rational(1, 2)
    assert run_code("nothing = 0", "sqrt(2)^2 + 1").value == 3
    outcome = run_code("a = 1\nb = a + 1")
    assert (outcome.value, outcome.variables, outcome.steps) == (None, {"a": 1, "b": 2}, 6)


def test_functions_and_records_of_a_claim_are_called():
    curve = {"getX": lambda t: t * t, "left": [1, 2]}
    assert run_code("f(c, t):\n  return c.getX(t) + c.left[1]", "f(c, 1/2)", {"c": curve}).value == Fraction(9, 4)


def test_a_name_of_the_whole_program_is_assigned_to_within_functions():
    text = "count = 0\nlocal(n):\n  here = n\n  count += 1\nlocal(1)\nlocal(2)"
    outcome = run_code(text)
    assert outcome.variables == {"count": 2}


@pytest.mark.parametrize(
    ("text", "line", "message"),
    [
        ("a = 1\nimport os", 2, "found 'os'"),
        ("x = lambda: 3", 1, "found ':'"),
        ("y = [a for a in b]", 1, "found 'for'"),
        ("a = (1", 1, "expected the rest of it"),
        ("a = 1)", 1, "closing bracket"),
        ("a = 1\n  b = 2", 2, "found it indented"),
        ("else:\n  a = 1", 1, "expected the if before it"),
        ("if(a):\nb = 1", 1, "expected a block"),
        ("a = 3 $ 4", 1, "found '$'"),
        ("let v = copy of points;", 1, "found 'of'"),
        ("for(i = 0; i < 3):\n  a = 1", 1, "expected"),
        ("a = 'x\n", 1, 'found "\'"'),
    ],
)
def test_what_is_no_code_is_refused_by_its_line(text, line, message):
    with pytest.raises(CodeError, match=message.replace("$", r"\$")) as error:
        run_code(text)
    assert str(error.value).startswith(f"line {line}: ")


@pytest.mark.parametrize(
    ("text", "line", "message"),
    [
        ("z = a.__class__", 1, "found the field __class__ of 3"),
        ('eval("1")', 1, "found eval, which has no value"),
        ("open('/etc/passwd')", 1, "found open, which has no value"),
        ("b = [1]\nc = b[1]", 2, "found the index 1, expected 0 .. 0"),
        ("b = [1]\nc = b[-1]", 2, "found the index -1"),
        ("b = [1]\nc = b[1/2]", 2, "expected a whole number"),
        ("b = 1/0", 1, "divided by 0"),
        ("b = 0^-1", 1, "0 to a negative power"),
        ("b = sqrt(-1)", 1, "the root of -1"),
        ("b = 'a' + 1", 1, "expected numbers"),
        ("b = [1, 2] + [1]", 1, "vectors of one size"),
        ("if a:\n  b = 1", 1, "expected true or false"),
        ("a.b = 3", 1, "no variable"),
        ("f(p):\n  return p\nf(1, 2)", 3, "for which it is not defined"),
        ("a(1)", 1, "expected a function"),
        ("g(1, 2)", 1, "found 2 arguments"),
        ("break", 1, "expected a loop around it"),
        ("for each p in 3:\n  b = p", 1, "expected a list"),
        ("b = (-8)^(1/3)", 1, "expected a base that is not negative"),
    ],
)
def test_what_must_not_be_is_told_by_its_line(text, line, message):
    with pytest.raises(CodeFaultError, match=message) as error:
        run_code(text, given={"a": 3, "g": lambda p: p})
    assert str(error.value).startswith(f"line {line}: ")
    assert not isinstance(error.value, CodeLimitError | OpenConditionError)


@pytest.mark.parametrize(
    ("text", "message"),
    [
        ("while true:\n  b = 1", "more than 20000 steps"),
        ("f(n):\n  return f(n + 1)\nf(1)", "calls 60 deep"),
        ("b = 2\nfor i = 1 to 30:\n  b = b^b", "the exponent"),
        ("b = 3\nfor i = 1 to 100:\n  b = b * b", "bits, expected at most"),
        ("b = array(10^9)", "found the size"),
        ("b = 7^(10^6)", "the exponent"),
    ],
)
def test_limits_hold(text, message):
    with pytest.raises(CodeLimitError, match=message):
        run_code(text)


def test_a_condition_on_letters_is_open():
    with pytest.raises(OpenConditionError, match="which letters leave open"):
        run_code("if (x < 1):\n  b = 1", given={"x": x})
