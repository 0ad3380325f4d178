"""What is printed, letter by letter, as SymPy relations: the only module in which a printed formula can run.

Write down what stands on the page, not what you think was meant. SymPy tidies what it is given: `evaluate=False` keeps
both sides of an equation as they are.
"""

from sympy import Eq, Sum, pi, symbols

from semispline.papers.checks import Digits
from semispline.papers.latex import echo, read_formula, read_names, relations
from semispline.papers.ledger import Print, formula

# One symbol for each letter of the paper, with what the paper says of it.
i, n = symbols("i n", integer=True, positive=True)

# (1) Change this into a formula of yours. Behind the relation stand the assumptions that the paper makes, here n >= 1.
SQUARES = formula(Eq(Sum(i**2, (i, 1, n)), n * (n + 1) * (2 * n + 1) / 6, evaluate=False), n >= 1)

# (2) A formula that is wrong as it stands on the page, and below it as it would be right.
CUBES = formula(Eq(Sum(i**3, (i, 1, n)), n**2 * (n + 1) / 4, evaluate=False), n >= 1)
CUBES_RIGHT = formula(Eq(Sum(i**3, (i, 1, n)), n**2 * (n + 1) ** 2 / 4, evaluate=False), n >= 1)

# A number, with the digits that are printed.
PI = formula(Eq(pi, Digits("3.1415"), evaluate=False))

# (3) A formula as LaTeX: it is read against a table of what each name is, and refused where it has two readings. These
# letters are those above, since they are of the same kind.
NAMES = read_names("i, n : integer >= 1")
ODD_LATEX = r"\sum_{i=1}^{n} (2i - 1) = n^2"
ODD_READ = read_formula(ODD_LATEX, NAMES.of("eq-3"), "printed.py: ODD_LATEX")
(STEP,) = relations(ODD_READ)
ODD = formula(Eq(STEP.left, STEP.right, evaluate=False))
# What a report shows: the LaTeX, and beside it what was read.
ODD_PRINT = Print(ODD_LATEX, echo(ODD_READ.statements, ODD_READ.names))
