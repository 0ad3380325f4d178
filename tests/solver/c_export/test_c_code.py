"""Generated C: compiled with every warning an error, compared with NumPy and with the blend itself."""

import subprocess

import casadi as ca
import numpy as np
import pytest

from helpers.bases import facing_pair, ring
from helpers.papers_set import blend, state_problem
from semispline import Base, BSplineSurface, ComputationError
from semispline.solver.blending.nlp import constrained_problem
from semispline.solver.c_export.files import c_files, c_functions

pytestmark = pytest.mark.compiler
FLAGS = ["-Wall", "-Wextra", "-Werror", "-Wno-unused-parameter", "-pedantic", "-std=c99"]


def far_pair():
    # 10^4 times the size away from the origin.
    a, b = facing_pair(np.random.default_rng(7))
    return [
        Base(
            BSplineSurface(s.degree_u, s.degree_v, s.knots_u, s.knots_v, s.control_points + np.array([1e4, -2e4, 5e3])),
            base.edge,
        )
        for base in (a, b)
        for s in [base.surface]
    ]


RINGS = Base(ring(7, 1.0, (0.0, -0.5, -1.2)), "u0"), Base(ring(5, 0.7, (1.0, 1.4, 2.0)), "u0")
CASES = {
    "G2": (facing_pair(np.random.default_rng(0)), {"continuity": "G2"}),
    "G1 and C0": (facing_pair(np.random.default_rng(1)), {"continuity": ("G1", "C0"), "middle_curves": 0}),
    "closed G2": (RINGS, {"continuity": "G2"}),
    "C2": (facing_pair(np.random.default_rng(2)), {"continuity": "C2"}),
    "C2 and G0, three curves": (
        facing_pair(np.random.default_rng(3)),
        {"continuity": ("C2", "G0"), "middle_curves": 3, "degree_u": 4},
    ),
    "nothing free": (facing_pair(np.random.default_rng(4)), {"continuity": "C2", "middle_curves": 0}),
    "alpha set": (facing_pair(np.random.default_rng(5)), {"continuity": "G2", "alpha": (0.9, 1.1)}),
    "closed C2": (RINGS, {"continuity": "C2", "v_scale": "unit"}),
    "far away": (far_pair(), {"continuity": "C2"}),
}
LINEAR = list(CASES)[3:]


class Compiled:
    """A stated problem, its C in a folder, and the compiled functions by their short names."""

    def __init__(self, name, folder):
        self.bases, self.options = CASES[name]
        self.stated = state_problem(*self.bases, **self.options)
        self.nlp = constrained_problem(self.stated.problem)
        self.folder = folder
        for file, text in c_files(self.stated).items():
            (folder / file).write_text(text)
        self.run("cc", *FLAGS, "-shared", "-fPIC", "blend.c", "-lm", "-o", "blend.so")
        names = [function.name() for function in c_functions(self.stated, self.nlp)]
        self.functions = {name: ca.external(name, str(folder / "blend.so")) for name in names}

    def run(self, *words):
        return subprocess.run(words, cwd=self.folder, check=True, capture_output=True, text=True).stdout

    def __call__(self, name, *arguments):
        return [part.full() for part in self.functions[f"blend_{name}"].call([ca.DM(part) for part in arguments])]


@pytest.fixture(scope="module", params=list(CASES))
def compiled(request, tmp_path_factory):
    return Compiled(request.param, tmp_path_factory.mktemp("c"))


def random_point(compiled):
    start = compiled.nlp.start
    return start + 0.1 * np.random.default_rng(0).standard_normal(len(start))


def parts(compiled, x):
    """Control points of each row and alpha^2, beta^2, from the unknowns."""
    problem = compiled.stated.problem
    n = problem.form.offsets[-1]
    shape = iter(x[3 * n :])
    values = [
        next(shape) ** 2 * natural if is_free else fixed
        for is_free, natural, fixed in zip(problem.free, problem.natural, problem.start, strict=True)
    ]
    return x[: 3 * n].reshape(3, n).T, values


def test_objective_is_the_energy(compiled):
    x = random_point(compiled)
    p, _ = parts(compiled, x)
    # By sums of squares of derivatives, which the generated quadratic form knows nothing of.
    expected = compiled.stated.problem.form.products(p[None])[0, 0] / compiled.nlp.f_scale
    assert compiled("objective", x)[0].item() == pytest.approx(expected, rel=1e-9)


def test_constraints_are_the_contact_rows(compiled):
    x = random_point(compiled)
    problem = compiled.stated.problem
    p, values = parts(compiled, x)
    expected = []
    for (side, rows, spans), value in zip(problem.contacts, values, strict=True):
        for i, row in zip(rows, side.contact_rows(value, problem.form.u.degree, spans), strict=False):
            expected.append((p[problem.form.offsets[i] : problem.form.offsets[i + 1]] - row).T.ravel())
    expected = np.concatenate(expected)
    found = compiled("constraints", x)[0].ravel()
    np.testing.assert_allclose(found[: len(expected)], expected, rtol=0, atol=1e-12 * np.abs(expected).max())
    # The rest are seam conditions, which the solution of a closed problem satisfies.
    assert (len(found) > len(expected)) == (problem.seam_order >= 0 and len(problem.free_rows) > 0)
    solution = problem.control_points(*problem.start).T.ravel()
    at_solution = compiled("constraints", np.concatenate([solution, compiled.nlp.start[len(solution) :]]))[0]
    np.testing.assert_allclose(at_solution, 0, rtol=0, atol=1e-10)


def test_derivatives_are_those_of_the_functions(compiled):
    rng = np.random.default_rng(1)
    x = random_point(compiled)
    d, lam = rng.standard_normal(len(x)), rng.standard_normal(compiled.nlp.g.shape[0])
    h = 2.0**-12

    def slope(function):
        # Central differences: the remainder is h^2 = 6e-8 of third derivatives, the rounding 1e-16 / h = 4e-13.
        return (function(x + h * d) - function(x - h * d)) / (2 * h)

    def near(found, expected):
        np.testing.assert_allclose(found, expected, rtol=0, atol=1e-5 * max(1.0, float(np.abs(expected).max())))

    def gradient(x):
        return compiled("gradient", x)[0].ravel()

    def jacobian(x):
        return compiled("jacobian", x)[0]

    near(gradient(x) @ d, slope(lambda x: compiled("objective", x)[0].item()))
    near(jacobian(x) @ d, slope(lambda x: compiled("constraints", x)[0].ravel()))
    upper = compiled("hessian", x, 0.7, lam)[0]
    near((upper + np.triu(upper, 1).T) @ d, slope(lambda x: 0.7 * gradient(x) + jacobian(x).T @ lam))


def test_c_computes_what_python_computes(compiled):
    rng = np.random.default_rng(2)
    for function in c_functions(compiled.stated, compiled.nlp):
        arguments = [ca.DM(rng.standard_normal(function.size_in(i))) for i in range(function.n_in())]
        results = (f.call(arguments) for f in (compiled.functions[function.name()], function))
        for found, expected in zip(*([part.full() for part in result] for result in results), strict=True):
            finite = np.isfinite(expected)
            np.testing.assert_array_equal(found[~finite], expected[~finite])
            # The compiler may contract a product and a sum.
            atol = 1e-13 * np.abs(expected[finite]).max(initial=0)
            np.testing.assert_allclose(found[finite], expected[finite], rtol=1e-13, atol=atol)


def stacked(surface):
    return np.concatenate([curve.control_points for curve in surface.control_curves])


def size_of(points):
    return np.ptp(points, axis=0).max() + 1e-16 / 1e-11 * np.abs(points).max()


def test_points_are_in_model_units(compiled):
    problem = compiled.stated.problem
    centre, size = compiled.stated.frame
    start, *_ = compiled("start")
    expected = problem.control_points(*problem.start) * size + centre
    np.testing.assert_allclose(compiled("points", start)[0].T, expected, rtol=0, atol=1e-14 * np.abs(expected).max())


def test_the_program_of_the_readme_prints_the_blend(compiled):
    text = (compiled.folder / "README.md").read_text()
    (compiled.folder / "main.c").write_text(text.split("```c\n")[1].split("```")[0])
    compiled.run("cc", *FLAGS, "main.c", "blend.c", "-lm", "-o", "main")
    found = np.array([[float(x) for x in line.split()] for line in compiled.run("./main").splitlines()])
    problem = compiled.stated.problem
    if any(problem.free):
        centre, size = compiled.stated.frame
        expected = problem.control_points(*problem.start) * size + centre
    else:
        expected = stacked(blend(*compiled.bases, **compiled.options).surface)
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-11 * size_of(expected))


@pytest.fixture(scope="module", params=LINEAR)
def linear(request, tmp_path_factory):
    return Compiled(request.param, tmp_path_factory.mktemp("linear"))


def test_the_whole_solve_follows_the_bases(linear):
    rng = np.random.default_rng(3)
    changed = []
    for base in linear.bases:
        s = base.surface
        # The same bump on every point of a row along the edge keeps closed bases smooth.
        bump = 0.05 * rng.standard_normal((*s.control_points.shape[:2], 3))
        bump = bump.mean(axis=1 if base.edge[0] == "u" else 0, keepdims=True)
        changed.append(
            Base(BSplineSurface(s.degree_u, s.degree_v, s.knots_u, s.knots_v, s.control_points + bump), base.edge)
        )
    options = linear.options | {"flip": "yes" if linear.stated.matched.flipped else "no"}
    expected = stacked(blend(*changed, **options).surface)
    rows = [side.rows[: side.order + 1].reshape(-1, 3).T for side in state_problem(*changed, **options).sides]
    found = linear("solve", *rows)[0].T
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-11 * size_of(expected))
    before = stacked(blend(*linear.bases, **linear.options).surface)
    assert np.abs(expected - before).max() > 1e-3


def test_the_size_of_the_solve_is_linear():
    def length(n):
        knots = np.concatenate([np.zeros(3), np.arange(n - 2.0), np.full(3, n - 3.0)])
        x, y = np.meshgrid([0.0, 1.0, 2.0], np.linspace(0, n - 3, n), indexing="ij")
        net = np.stack([x, y, np.sin(y)], axis=2)
        a = BSplineSurface(2, 3, [0, 0, 0, 1, 1, 1], knots, net)
        b = BSplineSurface(2, 3, [0, 0, 0, 1, 1, 1], knots, net * [-1, 1, 1] - [1, 0, 0.3])
        return len(c_files(state_problem(Base(a, "u0"), Base(b, "u0"), continuity="C2"))["blend.c"])

    small, large = length(50), length(200)
    # A dense map would be 16 times as long.
    assert large < 4.5 * small


@pytest.mark.parametrize(("width", "is_written"), [(1e-3, True), (1e-6, False)])
def test_what_one_solve_cannot_find_is_not_written(width, is_written):
    # Knots close to an end: `blend` refines, the code that is written cannot.
    knots = [0, 0, 0, 0, width, 1, 1, 1, 1]
    y = [np.mean(knots[i + 1 : i + 4]) for i in range(5)]
    line = [0, 0, 1, 1]
    a = BSplineSurface(1, 3, line, knots, [[[x, at, 0] for at in y] for x in (0, 1)])
    b = BSplineSurface(1, 1, line, line, [[[2, at, z] for at in (0, 1)] for z in (1, 2)])
    stated = state_problem(Base(a, "u1"), Base(b, "u0"), continuity="C2")
    if is_written:
        assert "blend.c" in c_files(stated)
    else:
        with pytest.raises(ComputationError, match="without the refinement that blend has"):
            c_files(stated)
