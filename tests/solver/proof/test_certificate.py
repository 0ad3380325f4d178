"""The checker of proofs: certificates that fail one condition alone, each claiming what is false."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest

from helpers.polynomials import polynomial
from semispline.solver.proof.certificates import Certificate, Leaf
from semispline.solver.proof.checker import CertificateError, check_certificate

SQUARE = ((-1.0, 1.0), (-1.0, 1.0))
UNIT = ((0.0, 1.0), (0.0, 1.0))
WHOLE = (0, 0)


def claim(table, *leaves, box=SQUARE, point=(0.0, 0.0), bound=0.0, tolerance=0.0):
    return Certificate(table, box, point, tolerance, bound, leaves)


def tangent(s=0.5, t=0.5):
    return Leaf(WHOLE, WHOLE, tangent_at=(s, t))


def refused(certificate, message):
    with pytest.raises(CertificateError, match=message):
        check_certificate(certificate)


def mirrored(certificate):
    """The same claim with x and y exchanged."""
    leaves = tuple(
        replace(leaf, x=leaf.y, y=leaf.x, tangent_at=leaf.tangent_at and leaf.tangent_at[::-1])
        for leaf in certificate.leaves
    )
    return replace(
        certificate,
        coefficients=certificate.coefficients.T,
        box=certificate.box[::-1],
        point=certificate.point[::-1],
        leaves=leaves,
    )


def both(certificate):
    return certificate, mirrored(certificate)


BOWL = polynomial(x2y0=1, x0y2=1)


def test_true_claims_are_accepted():
    check_certificate(claim(BOWL, tangent()))
    check_certificate(claim(polynomial(x1y0=1), Leaf(WHOLE, WHOLE), box=UNIT))
    halves = Leaf((0, 1), WHOLE), Leaf((1, 1), WHOLE)
    check_certificate(claim(polynomial(x1y0=1), *halves, box=UNIT))
    # 1 - x^2 as a multiple of itself.
    check_certificate(claim(polynomial(x0y0=1, x2y0=-1), squares({}, {(0, 0): 1}), point=(1.0, 0.0)))
    check_certificate(claim(polynomial(x0y0=1, x0y2=-1), squares({}, {}, {(0, 0): 1}), point=(0.0, 1.0)))
    # (x + y)^2: rows of zeros are no fault.
    one = dict.fromkeys([(1, 1), (1, 2), (2, 1), (2, 2)], 1)
    check_certificate(claim(polynomial(x2y0=1, x1y1=2, x0y2=1), squares(one)))


@pytest.mark.parametrize("mixed", [4, -4, 2.001])
def test_a_saddle_across_the_axes_is_not_convex(mixed):
    # Along both axes it is, and both other directions have one of each sign.
    refused(claim(BOWL + polynomial(x1y1=mixed), tangent()), "not proved convex")


@pytest.mark.parametrize(
    "table",
    [
        polynomial(x2y0=-1),
        polynomial(x0y2=-1),
        polynomial(x2y0=-1, x0y2=-1),  # the determinant is positive
        polynomial(x2y0=1, x3y0=0.34),  # by a little at one end
        polynomial(x2y0=-0.1),  # by a little, and flat across
        polynomial(x0y2=-0.1),
        polynomial(x2y0=0.25, x2y1=1, x0y2=10),  # at one end of the other axis
        polynomial(x0y2=0.25, x1y2=1, x2y0=10),
    ],
)
def test_what_bends_down_along_an_axis_is_not_convex(table):
    refused(claim(table, tangent()), "not proved convex")


def test_a_mixed_derivative_of_either_sign_counts():
    # By x and y it runs from -4 at x = -1 to 0.
    refused(claim(BOWL + polynomial(x1y1=-2, x2y1=1), tangent()), "not proved convex")
    refused(claim(BOWL + polynomial(x1y1=2, x2y1=1), tangent()), "not proved convex")
    # The same along y, from -1 to 3; its least magnitude would be small enough.
    for one in both(claim(polynomial(x2y0=1, x0y2=2, x1y1=1, x1y2=1), tangent())):
        refused(one, "not proved convex")


def test_a_tangent_point_outside_of_its_part_is_refused():
    # x^3 is convex over [0, 1], but its tangent at -1 lies above it there: 2 + 3 x.
    below = claim(polynomial(x3y0=1), tangent(s=-1.0), box=UNIT, point=(1.0, 0.0), bound=1.0)
    # (1 - x)^3 and its tangent at 2.
    beyond = polynomial(x0y0=1, x1y0=-3, x2y0=3, x3y0=-1)
    above = claim(beyond, tangent(s=2.0), box=UNIT, point=(0.0, 0.0), bound=1.0)
    for certificate in (*both(below), *both(above)):
        refused(certificate, "tangent point .* outside")


@pytest.mark.parametrize("s", [0.25, 0.75])
@pytest.mark.parametrize("t", [0.25, 0.75])
def test_a_tangent_plane_below_the_bound_at_one_corner_alone_is_refused(s, t):
    # x^2 + y^2 touched at distance 1/2 from both axes: -2.5 at the corner across, -0.5 at its neighbours.
    certificate = claim(BOWL, tangent(s, t), bound=-1.0, tolerance=1.0)
    refused(certificate, "tangent plane .* below the bound")
    check_certificate(replace(certificate, bound=-2.5, tolerance=2.5))


@pytest.mark.parametrize("table", [polynomial(x2y0=1), polynomial(x0y2=1), polynomial(x2y2=1), polynomial(x4y4=1)])
def test_a_bernstein_coefficient_below_the_bound_is_refused(table):
    # The bound is true, but the coefficients do not prove it: x^2 has 1, -1, 1.
    refused(claim(table, Leaf(WHOLE, WHOLE)), "Bernstein coefficients")


def test_a_bound_that_holds_on_some_parts_only_is_refused():
    # x over [-1, 1] is positive over the right half.
    halves = Leaf((0, 1), WHOLE), Leaf((1, 1), WHOLE)
    for leaves in (halves, halves[::-1]):
        refused(claim(polynomial(x1y0=1), *leaves), "Bernstein coefficients")


@pytest.mark.parametrize("i", [1, -1])
def test_a_part_outside_of_the_box_is_refused(i):
    # Of the box's own size, and there the bound holds: the least of i x + 1 over [0, 1] is not 1 + |i|.
    point, bound = ((1.0, 0.0), 2.0) if i == 1 else ((0.0, 0.0), 1.0)
    certificate = claim(polynomial(x0y0=1, x1y0=i), Leaf((i, 0), WHOLE), box=UNIT, point=point, bound=bound)
    for one in both(certificate):
        refused(one, "area")


def test_parts_that_leave_some_of_the_box_out_are_refused():
    right = Leaf((1, 1), WHOLE)
    for one in both(claim(polynomial(x1y0=1), right)):
        refused(one, "area")
    # As large as the box, but one half twice.
    for one in both(claim(polynomial(x1y0=1), right, right)):
        refused(one, "overlap")


@pytest.mark.parametrize("at", [2.0, -2.0])
def test_a_point_outside_of_the_box_is_refused(at):
    # (x - at)^2 is positive over the box, by its coefficients, and zero only outside.
    box = UNIT if at > 0 else ((-1.0, 0.0), (0.0, 1.0))
    certificate = claim(polynomial(x0y0=4, x1y0=-2 * at, x2y0=1), Leaf(WHOLE, WHOLE), box=box, point=(at, 0.0))
    for one in both(certificate):
        refused(one, "outside of the box")


def test_a_point_too_far_above_the_bound_is_refused():
    certificate = claim(BOWL, tangent(), point=(0.5, 0.5), tolerance=0.5)
    check_certificate(certificate)
    refused(replace(certificate, tolerance=0.499), "value at the point")
    refused(replace(certificate, point=(0.5, 0.6)), "value at the point")


def test_a_point_a_little_below_the_bound_is_refused():
    refused(claim(BOWL, tangent(), bound=0.5), "value at the point")


def squares(*entries):
    """A part proved by matrices with these entries, the others zero."""
    filled = (*entries, {}, {})[:3]
    grams = (
        tuple(tuple(Fraction(given.get((i, j), 0)) for j in range(size)) for i in range(size))
        for given, size in zip(filled, (6, 3, 3), strict=True)
    )
    return Leaf(WHOLE, WHOLE, squares=tuple(grams))


@pytest.mark.parametrize(
    ("table", "leaf"),
    [
        # Pivots of zero: 2 x y; 2 (1 - x^2) y; 2 (1 - y^2) x.
        (polynomial(x1y1=2), squares({(1, 2): 1, (2, 1): 1})),
        (polynomial(x0y1=2, x2y1=-2), squares({}, {(0, 2): 1, (2, 0): 1})),
        (polynomial(x1y0=2, x1y2=-2), squares({}, {}, {(0, 1): 1, (1, 0): 1})),
        # A zero pivot that comes with the elimination: (x + y)^2 + 2 y^3.
        (
            polynomial(x2y0=1, x1y1=2, x0y2=1, x0y3=2),
            squares({(1, 1): 1, (1, 2): 1, (2, 1): 1, (2, 2): 1, (2, 5): 1, (5, 2): 1}),
        ),
        # Negative pivots: -x^2; x^2 + 4 x y + y^2, where it comes with the elimination.
        (polynomial(x2y0=-1), squares({(1, 1): -1})),
        (polynomial(x2y0=1, x1y1=4, x0y2=1), squares({(1, 1): 1, (1, 2): 2, (2, 1): 2, (2, 2): 1})),
        (polynomial(x2y0=-1, x4y0=1), squares({}, {(1, 1): -1})),
        (polynomial(x0y2=-1, x0y4=1), squares({}, {}, {(2, 2): -1})),
        # Not symmetric: x^2 + 4 x y + y^2 again, all of the mixed term on one side of the diagonal.
        (polynomial(x2y0=1, x1y1=4, x0y2=1), squares({(1, 1): 1, (1, 2): 4, (2, 2): 1})),
        (polynomial(x2y0=1, x1y1=4, x0y2=1), squares({(1, 1): 1, (2, 1): 4, (2, 2): 1})),
    ],
)
def test_matrices_that_are_not_semidefinite_are_refused(table, leaf):
    refused(claim(table, leaf), "not positive semidefinite")


@pytest.mark.parametrize(
    ("table", "leaf"),
    [
        (polynomial(x2y0=1, x0y1=1), squares({(1, 1): 1})),
        (polynomial(x2y0=-1), squares({}, {(0, 0): 1})),  # 1 - x^2 without its 1
        (polynomial(x0y0=1, x0y2=-1), squares({}, {(0, 0): 1})),  # the factor of the other variable
        (polynomial(x2y0=-1), squares({(0, 0): 1})),  # the bound lies one higher
        (polynomial(), squares({(3, 3): 1})),  # more than the polynomial has
    ],
)
def test_sums_of_squares_of_another_polynomial_are_refused(table, leaf):
    refused(claim(table, leaf, tolerance=1.0), "are not the polynomial")


def test_squares_that_prove_another_bound_are_refused():
    # x^2 + 1 is a sum of squares; that it stays above 1 is another claim, though true.
    raised = claim(polynomial(x0y0=1, x2y0=1), squares({(0, 0): 1, (1, 1): 1}), bound=1.0)
    refused(raised, "are not the polynomial")
    check_certificate(replace(raised, bound=0.0, tolerance=1.0))


def test_matrices_of_another_size_are_refused():
    leaf = squares({(1, 1): 1, (2, 2): 1})
    q0, q1, q2 = leaf.squares
    for wrong in ((q0, q1), (q0, q1, q2, q2), (q0, q0, q0), (q1, q1, q2), (q0[:5], q1, q2)):
        refused(claim(BOWL, replace(leaf, squares=wrong)), "malformed")


@pytest.mark.parametrize(
    "change",
    [
        {"coefficients": BOWL.tolist()},
        {"coefficients": None},
        {"coefficients": BOWL * np.nan},
        {"coefficients": np.zeros(3)},
        {"leaves": ("abc",)},
        {"leaves": (None,)},
        {"leaves": None},
        {"leaves": (Leaf((0.5, 1), WHOLE),)},
        {"leaves": (Leaf((0, -1), WHOLE),)},
        {"leaves": (Leaf(WHOLE, WHOLE, tangent_at=()),)},
        {"leaves": (Leaf(WHOLE, WHOLE, tangent_at="ab"),)},
        {"leaves": (Leaf(WHOLE, WHOLE, squares=1),)},
        {"bound": float("nan")},
        {"bound": None},
        {"tolerance": float("inf")},
        {"tolerance": "a"},
        {"box": ((0.0, float("inf")), (0.0, 1.0))},
        {"box": None},
        {"point": (0.0,)},
        {"point": None},
    ],
)
def test_malformed_certificates_are_refused(change):
    with pytest.raises(CertificateError):
        check_certificate(replace(claim(BOWL, tangent()), **change))
