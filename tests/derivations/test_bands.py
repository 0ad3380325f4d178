import pytest
import sympy as sp
from sympy import Function, Matrix, Rational, cos, diff, pi, simplify, sin, sqrt, symbols

from semispline.derivations.bands import (
    H_2,
    K_G,
    K_N,
    TAU,
    V,
    error_measures,
    frame_derivative,
    row_conditions,
    second_form,
    section_heights,
)

S, T = symbols("s t", real=True)
R, r, PHI = symbols("R r phi", positive=True)
CYLINDER = [R * cos(S), R * sin(S), T]
SPHERE = [R * cos(T) * cos(S), R * cos(T) * sin(S), R * sin(T)]
TORUS = [(R + r * cos(T)) * cos(S), (R + r * cos(T)) * sin(S), r * sin(T)]


def circle_heights(radius, order, sign):
    """Derivatives of the height of a circle over its tangent, by the implicit equation."""
    y = symbols("y")
    return [diff(sign * (radius - sqrt(radius**2 - y**2)), y, k).subs(y, 0) for k in range(2, order + 1)]


def test_the_section_of_a_cylinder_square_to_a_ruling_is_a_circle():
    # N = S_s x S_t looks outwards, and the surface bends away from it.
    found = section_heights(CYLINDER, (S, T), (pi / 3, 0), (0, 1), 4)
    assert [simplify(a - b) for a, b in zip(found, circle_heights(R, 4, -1), strict=True)] == [0, 0, 0]


@pytest.mark.long
def test_the_section_of_a_cylinder_square_to_a_helix_is_an_ellipse():
    # The plane at the angle phi to the axis cuts an ellipse with the half axes R and R / sin(phi).
    slope = (cos(PHI) / R, sin(PHI))
    y = symbols("y")
    ellipse = -(R - sqrt(R**2 - y**2 * sin(PHI) ** 2))
    expected = [diff(ellipse, y, k).subs(y, 0) for k in (2, 3, 4)]
    found = section_heights(CYLINDER, (S, T), (0, 0), slope, 4)
    assert [simplify(a - b) for a, b in zip(found, expected, strict=True)] == [0, 0, 0]


@pytest.mark.long
def test_every_normal_section_of_a_sphere_is_a_great_circle():
    found = section_heights(SPHERE, (S, T), (0, pi / 6), (Rational(6, 5) / sqrt(3), Rational(4, 5)), 4)
    assert [simplify(a - b) for a, b in zip(found, circle_heights(R, 4, -1), strict=True)] == [0, 0, 0]


@pytest.mark.long
def test_sections_of_a_torus():
    # Square to its outer parallel: the small circle. Square to a meridian at the equator: h_2 = -1 / (R + r), h_3 = 0,
    # and h_4 from the quartic of the plane section.
    across = section_heights(TORUS, (S, T), (0, 0), (1, 0), 4)
    assert [simplify(a - b) for a, b in zip(across, circle_heights(r, 4, -1), strict=True)] == [0, 0, 0]
    y = symbols("y")
    parallel = sqrt((R + r) ** 2 - y**2)  # z = 0 stays in the plane of the equator
    along = section_heights(TORUS, (S, T), (0, 0), (0, 1), 4)
    assert [simplify(a - diff(parallel, y, k).subs(y, 0)) for k, a in zip((2, 3, 4), along, strict=True)] == [0, 0, 0]


@pytest.mark.long
def test_heights_do_not_depend_on_the_parameters():
    """A graph z = f(x, y) with x and y bent functions of (s, t): the heights along y are the y-derivatives of f."""
    x, y = symbols("x y")
    f = 3 * y**2 / 2 + x * y + 5 * x**2 + y**3 / 3 - 2 * x * y**2 + x**2 * y + y**4 / 8 + x * y**3 + 7 * x**4
    in_x = S + 2 * T + S**2 - S * T + T**3 / 2
    in_y = T - S / 2 + S * T + 3 * T**2 - S**3
    surface = [in_x, in_y, f.subs({x: in_x, y: in_y}, simultaneous=True)]
    jacobian = Matrix([in_x, in_y]).jacobian([S, T]).subs({S: 0, T: 0})
    slope = tuple(jacobian.inv() * Matrix([1, 0]))
    assert jacobian.det() > 0
    assert section_heights(surface, (S, T), (0, 0), slope, 4) == [diff(f, y, k).subs({x: 0, y: 0}) for k in (2, 3, 4)]


def curve_frame(surface, path):
    """The Darboux frame of a curve on a surface, and its curvatures, from their definitions."""
    at = dict(zip((S, T), path, strict=True))
    point = Matrix(surface).subs(at, simultaneous=True)
    s_s, s_t = (Matrix(surface).diff(x).subs(at, simultaneous=True) for x in (S, T))
    normal = s_s.cross(s_t)
    normal = (normal / sqrt(normal.dot(normal))).applyfunc(simplify)
    step = point.diff(V)
    speed = simplify(sqrt(step.dot(step)))
    tangent = (step / speed).applyfunc(simplify)
    return point, tangent, normal.cross(tangent), normal, speed


@pytest.mark.long
def test_frame_and_row_conditions_on_a_helix():
    # The helix on a cylinder, by arc length: s = cos(phi) v / R, t = sin(phi) v. Its Darboux curvatures are known.
    path = (cos(PHI) * V / R, sin(PHI) * V)
    _, tangent, inward, normal, speed = curve_frame(CYLINDER, path)
    assert speed == 1
    values = {K_N: -(cos(PHI) ** 2) / R, K_G: 0, TAU: sin(PHI) * cos(PHI) / R, H_2: -(sin(PHI) ** 2) / R}
    frame = Matrix.hstack(tangent, inward, normal)
    for k, vector in enumerate((tangent, inward, normal)):
        parts = frame_derivative(tuple(sp.Integer(int(i == k)) for i in range(3)))
        assert (
            (vector.diff(V) - frame * Matrix([sp.sympify(p).subs(values) for p in parts]))
            .applyfunc(simplify)
            .is_zero_matrix
        )
    # Any tangential row 1.
    a, b = sin(V), 1 + V**2
    row = a * tangent + b * inward
    conditions = row_conditions((a, b, sp.Integer(0)))
    assert simplify(row.diff(V).dot(normal) - conditions["N.R_1'"].subs(values)) == 0
    assert simplify(tangent.diff(V).dot(normal) - conditions["N.R_0''"].subs(values)) == 0


def test_row_conditions_follow_from_the_second_form():
    a, b = Function("a")(V), Function("b")(V)
    found = row_conditions((a, b, sp.Integer(0)))
    assert found["N.R_0'"] == found["N.R_1"] == 0
    assert found["N.R_0''"] == K_N
    assert simplify(found["N.R_1'"] - second_form((1, 0, 0), (a, b, 0))) == 0
    assert simplify(found["N.R_2"] - second_form((a, b, 0), (a, b, 0))) == 0


@pytest.mark.parametrize(
    ("name", "wrong"), [("", "along"), ("e_0", "along"), ("e_1", "angle_across"), ("e_2", "across")]
)
def test_measures_of_a_band_of_a_cylinder_whose_rows_are_wrong(name, wrong):
    """The band itself, differentiated by the size of its errors, at a rational place; no frame takes part.

    One row has errors, or, without a name, all of them.
    """
    w, e = symbols("w epsilon")
    radius = 2
    # Around a cylinder: T runs round, D along the axis, N inwards or outwards as S_s x S_t says.
    point = Matrix([radius * cos(V / radius), radius * sin(V / radius), 0])
    tangent, inward = point.diff(V), Matrix([0, 0, 1])
    normal = tangent.cross(inward)
    assert tangent.dot(tangent).simplify() == 1
    c_0 = V**2 / 3 + V**3 - V + 2 if name in ("", "e_0") else sp.Integer(0)
    a_1, b_1, c_1 = (V - 3, 2 * V + 1, V**2 + 4) if name in ("", "e_1") else (sp.Integer(0),) * 3
    a_2, b_2, c_2 = (V, 2 - V, 5 + V) if name in ("", "e_2") else (sp.Integer(0),) * 3
    rows = [
        point + e * c_0 * normal,
        inward + e * (a_1 * tangent + b_1 * inward + c_1 * normal),
        e * (a_2 * tangent + b_2 * inward + c_2 * normal),
    ]
    band = rows[0] + w * rows[1] + w**2 / 2 * rows[2]
    # At one place all is a function of the errors' size alone.
    place = {w: 0, V: 0}
    b_w, b_v, b_ww, b_wv, b_vv = (band.diff(*key).subs(place) for key in ((w,), (V,), (w, 2), (w, V), (V, 2)))
    tangent, inward, normal, point = (x.subs(V, 0) for x in (tangent, inward, normal, point))
    n = b_v.cross(b_w)
    n = n / sqrt(n.dot(n))
    # B_w = p D_b + q T_b.
    speed = sqrt(b_v.dot(b_v))
    t_b = b_v / speed
    d_b = n.cross(t_b)
    p, q = b_w.dot(d_b), b_w.dot(t_b)
    along = b_vv.dot(n) / speed**2
    mixed = (b_wv.dot(n) / speed - q * along) / p
    across = (b_ww.dot(n) - 2 * p * q * mixed - q**2 * along) / p**2
    bend = Rational(-1, radius) * (1 if normal.dot(point) > 0 else -1)
    faces = [bend * x.dot(tangent) * y.dot(tangent) for x, y in ((d_b, d_b), (t_b, d_b), (t_b, t_b))]
    found = {
        "across": across - faces[0],
        "mixed": mixed - faces[1],
        "along": along - faces[2],
        "angle_along": -n.dot(tangent),
        "angle_across": -n.dot(inward),
    }
    values = {K_N: bend, K_G: 0, TAU: 0, H_2: 0}
    errors = {"c_0": c_0, "a_1": a_1, "b_1": b_1, "c_1": c_1, "c_2": c_2}
    for measure, value in found.items():
        expected = error_measures()[measure]
        for symbol, function in errors.items():
            expected = expected.subs(Function(symbol)(V), function)
        expected = expected.doit().subs(values).subs(V, 0)
        slope = value.diff(e).subs(e, 0)
        assert simplify(slope - expected) == 0, measure
        if measure == wrong:
            assert simplify(slope) != 0


@pytest.mark.long
def test_leading_errors_are_the_highest_derivatives():
    leading, c_0, c_1 = error_measures(leading=True), Function("c_0")(V), Function("c_1")(V)
    assert leading["gap"] == c_0
    assert (leading["angle_along"], leading["angle_across"]) == (c_0.diff(V), c_1)
    assert (leading["mixed"], leading["along"]) == (c_1.diff(V), c_0.diff(V, 2))
    # What is tangential in row 1 counts across, unless row 2 is made for it: II(D + e_1, D + e_1).
    a_1, b_1, c_2 = (Function(name)(V) for name in ("a_1", "b_1", "c_2"))
    assert simplify(leading["across"] - (c_2 - 2 * second_form((0, 1, 0), (a_1, b_1, 0)))) == 0
