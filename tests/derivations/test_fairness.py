"""|grad H|^2 dA against the geometry of graphs, and reverse accumulation against plain differentiation."""

import pytest
from sympy import Matrix, Rational, Symbol, diff, expand, sqrt, symbols

from helpers.sweeps import first_ones
from semispline.derivations.fairness import (
    DERIVATIVES,
    Program,
    fairness_formulas,
    fairness_program,
    reversed_program,
)

X, Y = symbols("x y")


def run(program, values):
    """Carry out a program exactly."""
    known = dict(values)
    for name, value in program.steps:
        known[name] = value.subs(known, simultaneous=True)
    return [known[output] for output in program.outputs]


def derivative_values(program, surface, at):
    """The inputs of the fairness program: derivatives of a parametrised surface at a point."""
    values = {}
    for name in DERIVATIVES:
        derived = surface
        for letter in name:
            derived = derived.diff(X if letter == "u" else Y)
        for coordinate, entry in zip("xyz", derived, strict=True):
            values[Symbol(f"p_{name}_{coordinate}")] = entry.subs(at)
    return values


def graph_outputs(f, at):
    """|grad H|^2 dA per dx dy, area element, H and |P_x| of z = f(x, y), from the divergence form of mean curvature."""
    fx, fy = diff(f, X), diff(f, Y)
    area = sqrt(1 + fx**2 + fy**2)
    mean = (diff(fx / area, X) + diff(fy / area, Y)) / 2
    metric = Matrix([[1 + fx**2, fx * fy], [fx * fy, 1 + fy**2]])
    slope = Matrix([diff(mean, X), diff(mean, Y)])
    rough = (slope.T * metric.inv() * slope)[0] * area
    return [value.subs(at) for value in (rough, area, mean, sqrt(1 + fx**2))]


@pytest.mark.long
@pytest.mark.parametrize(
    "f", [X**3 / 3 - X * Y**2 + Y, X**2 * Y - Y**3 / 5 + X * Y, X**4 / 7 + 2 * X * Y**3 - X**2 + 3 * Y**2]
)
@pytest.mark.parametrize(
    "at", first_ones(1, [{X: Rational(1, 3), Y: Rational(-2, 5)}, {X: Rational(3, 4), Y: Rational(1, 7)}])
)
def test_graphs_have_the_fairness_of_their_divergence_form(f, at):
    program = fairness_program()
    found = run(program, derivative_values(program, Matrix([X, Y, f]), at))
    for ours, known in zip(found, graph_outputs(f, at), strict=True):
        assert (ours - known).simplify() == 0


@pytest.mark.long
def test_another_parametrisation_changes_the_element_only():
    f, at = X**3 / 3 - X * Y**2 + Y, {X: Rational(1, 3), Y: Rational(-2, 5)}
    # x = u + u v / 2, y = v - u^2 / 3, with the Jacobian taken by hand.
    u, v = X + X * Y / 2, Y - X**2 / 3
    jacobian = ((1 + Y / 2) * 1 - (X / 2) * (-2 * X / 3)).subs(at)
    there = {X: u.subs(at), Y: v.subs(at)}
    program = fairness_program()
    surface = Matrix([u, v, f.subs({X: u, Y: v}, simultaneous=True)])
    found = run(program, derivative_values(program, surface, at))
    known = graph_outputs(f, there)
    assert (found[0] - known[0] * jacobian).simplify() == 0
    assert (found[1] - known[1] * jacobian).simplify() == 0
    assert (found[2] - known[2]).simplify() == 0


@pytest.mark.long
def test_spheres_and_cylinders_are_fair():
    program = fairness_program()
    cylinder = Matrix([X, (1 - Y**2) / (1 + Y**2), 2 * Y / (1 + Y**2)])
    at = {X: Rational(1, 2), Y: Rational(1, 3)}
    rough, _, mean, speed = run(program, derivative_values(program, cylinder, at))
    assert rough.simplify() == 0
    assert abs(mean) == Rational(1, 2)
    assert speed == 1


def test_reverse_accumulation_is_differentiation():
    x, y, p, q, r, s = symbols("x y p q r s")
    steps = ((p, x * y + 3 * x), (q, sqrt(p)), (r, q * p - y / q), (s, p**2))
    program = Program((x, y), steps, (r, s))
    at = {x: Rational(2), y: Rational(1, 2)}
    seeds = {Symbol("seed_r"): Rational(3, 7), Symbol("seed_s"): Rational(-2)}
    found = run(reversed_program(program), at | seeds)
    full = x * y + 3 * x
    total = Rational(3, 7) * (sqrt(full) * full - y / sqrt(full)) - 2 * full**2
    for ours, letter in zip(found, (x, y), strict=True):
        assert (ours - diff(total, letter).subs(at)).simplify() == 0


def test_steps_that_no_output_needs_are_left_out():
    x, y, z = symbols("x y z")
    gradient = reversed_program(Program((x,), ((y, expand(3 * x)), (z, x**2)), (z,)))
    assert [name.name for name, _ in gradient.steps] == ["d_x"]


@pytest.mark.long
def test_formulas_are_what_the_program_computes():
    program = fairness_program()
    surface = Matrix([X + X * Y / 2, Y - X**2 / 3, X**3 / 3 - X * Y**2 + Y])
    at = {X: Rational(1, 3), Y: Rational(-2, 5)}
    p = {"u": surface.diff(X), "v": surface.diff(Y)}
    p |= {"uu": p["u"].diff(X), "uv": p["u"].diff(Y), "vv": p["v"].diff(Y)}
    m = p["u"].cross(p["v"])
    area = sqrt(m.dot(m))
    forms = {"E": p["u"].dot(p["u"]), "F": p["u"].dot(p["v"]), "G": p["v"].dot(p["v"])}
    forms |= {letter: p[name].dot(m) / area for letter, name in zip("LMN", ("uu", "uv", "vv"), strict=True)}
    (_, mean), (_, square) = fairness_formulas()
    curvature = mean.subs({Symbol(name): value for name, value in forms.items()})
    values = {name: value.subs(at) for name, value in forms.items()}
    values |= {"H_u": curvature.diff(X).subs(at), "H_v": curvature.diff(Y).subs(at)}
    rough, element, h, _ = run(program, derivative_values(program, surface, at))
    known = [formula.subs({Symbol(name): value for name, value in values.items()}) for formula in (mean, square)]
    assert (known[0] - h).simplify() == 0
    assert abs((known[1] - rough).evalf(30)) < 1e-25
    assert (area.subs(at) - element).simplify() == 0
