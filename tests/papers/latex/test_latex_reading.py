"""Reading formulas: known trees, what is refused and where, laws; on small inputs and on a page of another field."""

import pytest

from semispline.papers.latex import UnreadableError, read_formula, read_names
from semispline.papers.latex.echoing import echo
from semispline.papers.latex.errors import NamesError, Trouble
from semispline.papers.latex.reading import free_names
from semispline.papers.latex.trees import (
    BigSum,
    Call,
    Derived,
    Elided,
    Factorial,
    Integral,
    Listing,
    Matrix,
    Named,
    Number,
    Power,
    Product,
    Quotient,
    Statement,
    Sum,
    Transpose,
    walk,
)

TABLE = r"""
n, k, i, j : integer >= 0
a, b, c, t, x, y : real
start : real word
x' : real
x_i, w_i, s_x, knots[i], Q_{ij}, h_{i,k}, {U_1}_x : real
f(x), g(x), f_k(x), B^n_i(t), N_{i,k}(t), u(t)_{left} : function
r(x) : function bare
P, P_i : point
A, M, X : matrix
\phi, \vec{v}_x : real
\pi : constant
sin, cos : standard function
tan : standard function word
RED : colour
abc : product
e1 : real
Bézier : label
"""
NAMES = read_names(TABLE, "names.txt").of("eq-1")


def one(latex, names=NAMES):
    """The tree of a formula that is a single side."""
    (statement,) = read_formula(latex, names).statements
    assert statement.relations == ()
    return statement.sides[0]


def name(pattern, *slots, arguments=None, derivative=0):
    return Named(pattern, slots, arguments, derivative)


def plus(*terms):
    return Sum(tuple(("+", term) for term in terms))


a, b, c, t, x, y, i, k, n = (name(letter) for letter in "abctxyikn")
ONE, TWO, THREE, FOUR = (Number(d) for d in "1234")


@pytest.mark.parametrize(
    ("latex", "tree"),
    [
        ("2at", Product((TWO, a, t))),
        ("at^2", Product((a, Power(t, TWO)))),
        ("abc", Product((a, b, c))),
        ("x_{n+1}^2", Power(name("x_i", plus(n, ONE)), TWO)),
        ("x^2_1", Power(name("x_i", ONE), TWO)),
        ("x'^2", Power(name("x'"), TWO)),
        ("s_x", name("s_x")),
        ("{U_1}_x", name("{U_1}_x")),
        ("e1", name("e1")),
        ("start", name("start")),
        ("knots[i+1]", name("knots[i]", plus(i, ONE))),
        ("Q_{12} + Q_{i+1,j}", plus(name("Q_{ij}", ONE, TWO), name("Q_{ij}", plus(i, ONE), name("j")))),
        ("h_{(i+k),1}", name("h_{i,k}", plus(i, k), ONE)),
        ("B^n_{i+1}(t)", name("B^n_i(t)", plus(i, ONE), n, arguments=(t,))),
        ("N_{i,k-1}(x)", name("N_{i,k}(t)", i, Sum((("+", k), ("-", ONE))), arguments=(x,))),
        ("u(t)_{left}", name("u(t)_{left}", arguments=(t,))),
        ("f'(x)", name("f(x)", arguments=(x,), derivative=1)),
        (r"f^{\prime\prime}(x)", name("f(x)", arguments=(x,), derivative=2)),
        ("f_2(x)^2", Power(name("f_k(x)", TWO, arguments=(x,)), TWO)),
        ("r^2 + r(t)", plus(Power(name("r(x)"), TWO), name("r(x)", arguments=(t,)))),
        (r"\vec{v}_x^2", Power(name(r"\vec{v}_x"), TWO)),
        ("φ²", Power(name(r"\phi"), TWO)),
        ("kn!", Product((k, Factorial(n)))),
        (r"b \cdot -1", Product((b, Sum((("-", ONE),))))),
        ("a(b+c)", Product((a, plus(b, c)))),
        ("a - (b - c)", Sum((("+", a), ("-", Sum((("+", b), ("-", c))))))),
        (r"\frac12 x", Product((Quotient(ONE, TWO), x))),
        ("a / b", Quotient(a, b)),
        ("2tan(x)", Product((TWO, Call("tan", x)))),
        (r"\cos^2(x) \cdot \sin x", Product((Power(Call("cos", x), TWO), Call("sin", x)))),
        ("|x - y|", Call("abs", Sum((("+", x), ("-", y))))),
        (r"|x| + |y|", plus(Call("abs", x), Call("abs", y))),
        ("RED[+ 2] \\cdot x", Product((TWO, x))),
        (r"A^T A^{-1}", Product((Transpose(name("A")), Power(name("A"), Sum((("-", ONE),)))))),
        ("(1, 2)", Listing("()", (ONE, TWO))),
        (r"\begin{bmatrix} a & b \\ 0 & 1 \end{bmatrix}", Matrix(((a, b), (Number("0"), ONE)))),
        (r"x_1 + ... + x_n", Elided(name("x_i", ONE), name("x_i", n), ONE, n, (name("x_i", ONE),))),
        (r"1 + 2 + \dots + n", Elided(ONE, n, ONE, n, (ONE, TWO))),
        (r"\int_0^1 a x dx", Integral(x, Number("0"), ONE, Product((a, x)))),
        (r"\frac{d}{dx} f(x)", Derived(name("f(x)", arguments=(x,)), x, ONE)),
        (r"\frac{d^n}{dx^n} (x^2-1)^n", Derived(Power(Sum((("+", Power(x, TWO)), ("-", ONE))), n), x, n)),
        (r"\underbrace{\ \cdot x}_{label}".replace(r"\ \cdot", "2"), Product((TWO, x))),
    ],
)
def test_known_trees(latex, tree):
    assert one(latex) == tree


def test_the_body_of_a_sum_is_the_rest_of_its_term():
    assert one(r"a + 2\sum_{i=0}^{n} w_i x + b") == plus(
        a, Product((TWO, BigSum(i, Number("0"), n, Product((name("w_i", i), x))))), b
    )


@pytest.mark.parametrize(
    ("latex", "trouble", "column"),
    [
        ("x + z", Trouble.UNDECLARED, 5),
        ("x + P_x", Trouble.KINDS, 7),
        ("P_{i+x}", Trouble.KINDS, 4),
        ("xyt", Trouble.WORD, 1),
        (r"\text{area} + x", Trouble.WORD, 1),
        ("x^12", Trouble.SCRIPT, 3),
        ("w_12", Trouble.SCRIPT, 3),
        ("t^(i+1)", Trouble.SCRIPT, 3),
        ("Q_{123}", Trouble.UNDECLARED, 1),
        ("x_1_2", Trouble.TEX, 4),
        ("a/bc", Trouble.SLASH, 2),
        ("1/2x", Trouble.SLASH, 2),
        (r"a/b \cdot c", Trouble.SLASH, 2),
        (r"\left( a \middle/ b \right)", Trouble.SLASH, 10),
        (r"\sin 2x", Trouble.FUNCTION_ARGUMENT, 6),
        (r"\sin^{-1}(x)", Trouble.FUNCTION_POWER, 1),
        ("f^2(x)", Trouble.FUNCTION_POWER, 4),
        ("f x", Trouble.UNDECLARED, 1),
        ("a(t)", Trouble.APPLICATION, 2),
        ("P_i(s_x)", Trouble.APPLICATION, 4),
        ("n!!", Trouble.OPERATOR, 3),
        ("2 3", Trouble.NUMERAL, 3),
        ("x 3", Trouble.NUMERAL, 3),
        ("01 + x", Trouble.NUMERAL, 1),
        (r"4 \frac{1}{3}", Trouble.NUMERAL, 3),
        ("x = 3, 5", Trouble.NUMERAL, 8),
        ("x--y", Trouble.TEX, 3),
        ("+ \\cdot x", Trouble.TEX, 3),
        (r"x \cdot", Trouble.TEX, 3),
        (r"\frac{d}{dx} f(x) g(x)", Trouble.OPERATOR, 1),
        (r"f(x) \frac{d}{dx}", Trouble.OPERATOR, 6),
        (r"\int_0^1 x", Trouble.OPERATOR, 1),
        (r"\int x dx", Trouble.OPERATOR, 1),
        (r"\sum_{i=0} w_i", Trouble.OPERATOR, 1),
        (r"\sum_{x=0}^n x", Trouble.KINDS, 1),
        (r"\sum_{i=0}^n w_i + x_i", Trouble.SUM_SCOPE, 1),
        (r"x_i \sum_{i=0}^n w_i", Trouble.SUM_SCOPE, 5),
        (r"a \underbrace{b + c}", Trouble.TEX, 3),
        ("P P_1", Trouble.KINDS, 3),
        ("|a|b|c|", Trouble.DELIMITERS, 3),
        ("(a]", Trouble.DELIMITERS, 1),
        ("(a", Trouble.DELIMITERS, 1),
        ("a}", Trouble.DELIMITERS, 2),
        (r"\left( a", Trouble.DELIMITERS, 1),
        (r"\mystery x", Trouble.TEX, 1),
        ("x_1 + ... ", Trouble.ELLIPSIS, 1),
        ("1 + ... + n", Trouble.ELLIPSIS, 1),
        ("1 + 3 + ... + n", Trouble.ELLIPSIS, 1),
        ("x_1 + ... + w_n", Trouble.ELLIPSIS, 1),
        (r"\begin{bmatrix} 1 & ... \\ x & y \end{bmatrix}", Trouble.ELLIPSIS, 1),
        (r"\begin{bmatrix} x = 1 & y \end{bmatrix}", Trouble.LAYOUT, 1),
        (r"\begin{bmatrix} x \\ y & a \end{bmatrix}", Trouble.LAYOUT, 1),
        (r"\begin{matrix} x \end{matrix} + 1", Trouble.LAYOUT, 1),
        ("x = 1 when i = 0, y = 2", Trouble.LAYOUT, 19),
        ("x = 1 when i = 0 and k = 2", Trouble.LAYOUT, 22),
        (r"\begin{aligned} x &= a \\ &+ b = c \end{aligned}", Trouble.LAYOUT, 28),
        ("x = ", Trouble.TEX, 1),
        ("", Trouble.TEX, 1),
        (r"\begin{bmatrix} x \end{bmatrix}_{Other}", Trouble.UNDECLARED, 32),
    ],
)
def test_what_has_two_readings_or_none_is_refused_with_its_place(latex, trouble, column):
    with pytest.raises(UnreadableError) as refused:
        read_formula(latex, NAMES, "eq.md", 7)
    assert (refused.value.trouble, refused.value.place) == (trouble, f"eq.md:7:{column}")
    assert str(refused.value).startswith(f"eq.md:7:{column}: {trouble}: ")


def test_a_place_on_a_later_line_counts_from_the_beginning_of_that_line():
    with pytest.raises(UnreadableError, match=r"^eq\.md:8:5: undeclared: "):
        read_formula("x +\n  a z", NAMES, "eq.md", 7)


def test_brackets_without_end_are_refused():
    for latex in ("{" * 3000, "(" * 3000 + "x" + ")" * 3000, r"\sqrt{" * 3000 + "x" + "}" * 3000):
        with pytest.raises(UnreadableError):
            read_formula(latex, NAMES)


@pytest.mark.parametrize(
    ("one_way", "other_way"),
    [
        ("2 a t", "2at"),
        (r"2 \cdot a \cdot t", "2at"),
        (r"2 \times a", "2a"),
        (r"\left( a + b \right)\,c", "(a+b)c"),
        ("a % a remark\n + b", "a+b"),
        (r"\hspace{2em} x \quad + {y}", "x+y"),
        ("x ≤ y", r"x \leq y"),
        ("x^{2}", "x²"),
        (r"t'".replace("t", "x"), r"x^\prime"),
        (r"\dfrac{a}{b}", r"\frac{a}{b}"),
        ("a = b.", "a = b"),
        ("[a + b] c", "(a + b) c"),
        (r"\mathrm{start}", "start"),
    ],
)
def test_what_prints_the_same_reads_the_same(one_way, other_way):
    assert read_formula(one_way, NAMES).statements == read_formula(other_way, NAMES).statements


def test_what_prints_otherwise_reads_otherwise():
    readings = [
        one(latex) for latex in ("a b c", "a (b c)", "a + b + c", "a + (b + c)", "x'", "x", "P", "A", "X", "ab", "ba")
    ]
    assert len(set(readings)) == len(readings)


# Regressions: an echo that is read again, and tokens that are changed, see neither of these two.


def steps(latex):
    return [(len(step.conditions), step.relation) for step in read_formula(latex, NAMES).steps]


def test_a_line_goes_on_with_the_last_chain_that_is_no_condition():
    latex = r"\begin{aligned} x &= a, \textit{where } k = n + 1 \\ &= b \end{aligned}"
    (statement,) = read_formula(latex, NAMES).statements
    assert statement.sides == (x, a, b)
    assert [(c.word, c.since, c.statement.sides) for c in statement.conditions] == [("where", 0, (k, plus(n, ONE)))]
    assert steps(latex) == [(1, "="), (1, "=")]


def test_when_limits_what_stands_right_before_it():
    (statement,) = read_formula("x = a, with k = n+1 and w_{i-1} = 0 when i = 0", NAMES).statements
    words = [(c.word, [inner.word for inner in c.statement.conditions]) for c in statement.conditions]
    assert words == [("where", []), ("where", ["when"])]
    limit = statement.conditions[1].statement.conditions[0].statement
    assert limit == Statement((i, Number("0")), ("=",))


def test_a_name_is_known_from_its_line_on():
    latex = r"\begin{aligned} x &= a \\ &= b, where\ k = 2 \\ &= c \end{aligned}"
    assert steps(latex) == [(0, "="), (1, "="), (1, "=")]
    assert steps(r"\begin{aligned} x &= a when\ k = 2 \\ y &= c \end{aligned}") == [(1, "="), (0, "=")]


def test_statements_of_a_display():
    latex = r"\left. \begin{matrix} a = b \\ c =& x \end{matrix} \right\} \ y = a \Rightarrow x = 0, \{ x \leq 1 \}"
    first, second = read_formula(latex, NAMES).statements
    assert [c.statement.sides for c in first.conditions] == [(a, b), (c, x)]
    assert second.after == r"\Rightarrow"
    assert [c.word for c in second.conditions] == ["when"]


def test_dots_on_the_left_continue_the_display_before():
    (statement,) = read_formula("... = a = b", NAMES).statements
    assert (statement.continues, statement.sides, statement.relations) == (True, (a, b), ("=", "="))
    assert [step.left for step in read_formula("= a = b", NAMES).steps] == [None, a]


def test_free_names_are_those_that_no_sum_binds():
    assert free_names(read_formula(r"x = \sum_{i=0}^{n} w_i + k", NAMES).statements) == ["x", "n", "w_i", "k"]


# The table.


@pytest.mark.parametrize(
    ("table", "message"),
    [
        ("x : rael", "names.txt:1: unknown kind 'rael', expected one of integer, real"),
        ("x real", "names.txt:1: found 'x real', expected `PATTERN"),
        ("\nx : real\nx : integer", "names.txt:3: x: looks like x of line 2"),
        ("i, k : integer\nP_i : point\nP_k : real", "names.txt:3: P_k: looks like P_i of line 2"),
        ("f(x) : real", "names.txt:1: f(x): found real, expected a function just where arguments are named"),
        ("f : function", "names.txt:1: f: found function"),
        ("x + y : real", "names.txt:1: 'x + y' is no name"),
        (r"\frac{a}{b} : real", "is no name"),
        ("x, , y : real", "names.txt:1: found a comma without a name"),
        ("x_{ : real", "names.txt:1: 'x_{'"),
    ],
)
def test_a_table_that_is_not_well_formed_is_refused_with_its_line(table, message):
    with pytest.raises(NamesError) as refused:
        read_names(table, "names.txt")
    assert message in str(refused.value)


def test_sections_inherit_and_take_away():
    table = read_names("x : real\n[part]\nx : point\ny : real\n[part.2]\n- y  # not here\nz : real\n")
    kinds = {key: {d.pattern: d.kind for d in table.of(key).declarations} for key in ("a.1", "part.1", "part.2")}
    assert kinds == {
        "a.1": {"x": "real"},
        "part.1": {"x": "point", "y": "real"},
        "part.2": {"x": "point", "z": "real"},
    }


@pytest.mark.parametrize(
    ("table", "latex"),
    [
        ("B : point\nB(t) : function\nt : real", "B(t+1)"),
        ("a, t, at : real", "at"),
        ("f(x) : function\nf'(x) : function\nx : real", "f'(x)"),
        ("i : integer\nP_i, P_1 : real", "P_1"),
    ],
)
def test_what_fits_two_names_is_refused_and_both_are_named(table, latex):
    with pytest.raises(UnreadableError) as refused:
        read_formula(latex, read_names(table).of("eq-1"))
    assert refused.value.trouble is Trouble.TWO_NAMES


def test_a_list_in_a_bracket_tells_a_function_from_a_factor():
    names = read_names("B : point\nB(n,t) : function\nn, t : real").of("eq-1")
    assert one("B(n,t)", names).arguments is not None


def test_a_prime_needs_one_argument_that_is_no_integer():
    names = read_names("n : integer\nx, y : real\nf(n,x), g(x,y) : function").of("eq-1")
    assert one("f'(n,x)", names).derivative == 1
    with pytest.raises(UnreadableError, match="by which argument is not told"):
        read_formula("g'(x,y)", names)


# A page of another field, as somebody might bring it.

LEGENDRE = r"""
n, m, k, i : integer >= 0
x, t : real
P_n(x) : function
f(x) : function
x_i, w_i : real
\delta_{mn} : real
"""
FORMULAS = [
    r"(n+1) P_{n+1}(x) = (2n+1) x P_n(x) - n P_{n-1}(x)",
    r"P_n(x) = \frac{1}{2^n n!} \frac{d^n}{dx^n} (x^2-1)^n",
    r"\int_{-1}^{1} P_m(x) P_n(x)\,dx = \frac{2}{2n+1} \delta_{mn}",
    r"P_n(x) = \frac{1}{2^n} \sum_{k=0}^{n} \binom{n}{k}^2 (x-1)^{n-k} (x+1)^k",
    r"(2n+1) P_n(x) = P_{n+1}'(x) - P_{n-1}'(x)",
    r"\int_{-1}^{1} f(x)\,dx \approx \sum_{i=1}^{n} w_i f(x_i)",
    r"\int_{-1}^{1} f(x)\,dx \approx w_1 f(x_1) + \dots + w_n f(x_n)",
]


@pytest.mark.parametrize("latex", FORMULAS)
def test_a_page_of_another_field_is_read_and_its_echo_says_the_same(latex):
    names = read_names(LEGENDRE).of("eq-1")
    formula = read_formula(latex, names)
    assert read_formula(echo(formula.statements, names), names).statements == formula.statements
    used = {node.name for node in walk(formula.statements[0]) if isinstance(node, Named)}
    for pattern in used:
        with pytest.raises(UnreadableError):
            read_formula(latex, read_names(f"{LEGENDRE}[eq-1]\n- {pattern}").of("eq-1"))
