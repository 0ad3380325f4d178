"""Curves of equal minima: proofs by sums of squares, and what the checker makes of wrong ones."""

from dataclasses import replace
from fractions import Fraction

import numpy as np
import pytest
from flint import fmpq, fmpq_mat
from hypothesis import given
from hypothesis import strategies as st

from helpers.polynomials import polynomial
from helpers.sweeps import examples
from semispline import ComputationError
from semispline.solver.proof import squares as proof_squares
from semispline.solver.proof.box_search import least_point
from semispline.solver.proof.checker import CertificateError, check_certificate
from semispline.solver.proof.squares import NoSquares, gram_matrices

BOX = ((-2.0, 3.0), (-2.0, 2.5))
ADMISSIBLE = ((0.125, 8.0), (0.125, 8.0))


CIRCLE = polynomial(x4y0=1, x0y4=1, x2y2=2, x2y0=-2, x0y2=-2, x0y0=1)
HYPERBOLA = polynomial(x2y2=1, x1y1=-2, x0y0=1)
PARABOLA = polynomial(x2y0=1, x1y2=-2, x0y4=1)


@pytest.mark.long
@pytest.mark.parametrize("box", [BOX, ADMISSIBLE])
@pytest.mark.parametrize("table", [CIRCLE, HYPERBOLA, PARABOLA], ids=["circle", "hyperbola", "parabola"])
@pytest.mark.parametrize("level", [0.0, 5.0])
def test_a_curve_of_equal_minima_is_proved(table, box, level):
    raised = table + polynomial(x0y0=level)
    certificate = least_point(raised, box, 1e-10)
    check_certificate(certificate)
    assert any(leaf.squares is not None for leaf in certificate.leaves)
    # The least value is known: a square is zero on its curve, which crosses both boxes.
    assert level - 1e-10 <= certificate.bound <= level


@pytest.mark.long
def test_a_slight_tilt_of_a_circle_is_followed_to_its_lowest_point():
    # (x^2 + y^2 - 1)^2 + e x is least at y = 0, 4 x (x^2 - 1) = -e: x = -1 - e / 8 up to e^2.
    tilt = 1e-9
    certificate = least_point(CIRCLE + polynomial(x1y0=tilt), BOX, 1e-13)
    check_certificate(certificate)
    assert certificate.point == pytest.approx((-1 - tilt / 8, 0), abs=1e-9)
    assert certificate.bound == pytest.approx(-tilt, abs=1e-13)


@pytest.mark.long
@examples(5)
@given(st.lists(st.integers(-3, 3), min_size=5, max_size=5).filter(lambda h: h[2] and h[4]), st.integers(-3, 3))
def test_squares_of_random_conics_are_proved(h, mixed):
    # h0 + h1 x + h2 x^2 + h3 y + h4 y^2 + mixed x y, squared; the samples know nothing of the proof.
    conic = np.zeros((3, 3))
    conic[:, 0], conic[0, 1:], conic[1, 1] = h[:3], h[3:], mixed
    table = np.zeros((5, 5))
    for (i, j), c in np.ndenumerate(conic):
        table[i : i + 3, j : j + 3] += c * conic
    certificate = least_point(table, BOX, 1e-10)
    check_certificate(certificate)
    x, y = (np.linspace(*ends, 200) for ends in BOX)
    assert certificate.bound <= np.polynomial.polynomial.polygrid2d(x, y, table).min() + 1e-12


@pytest.fixture(scope="module")
def proof():
    certificate = least_point(CIRCLE, BOX, 1e-10)
    assert [leaf.squares is None for leaf in certificate.leaves] == [False]
    return certificate


def planted(proof, squares):
    return replace(proof, leaves=(replace(proof.leaves[0], squares=squares),))


def changed(gram, i, j, by):
    rows = [list(row) for row in gram]
    rows[i][j] += by
    return tuple(tuple(row) for row in rows)


def test_squares_that_are_not_the_polynomial_are_refused(proof):
    q0, q1, q2 = proof.leaves[0].squares
    for wrong in (
        (changed(q0, 3, 3, Fraction(1, 10**30)), q1, q2),
        (q0, changed(q1, 0, 0, Fraction(1, 10**30)), q2),
        (q0, q2, q1),
    ):
        with pytest.raises(CertificateError, match="are not the polynomial"):
            check_certificate(planted(proof, wrong))
    with pytest.raises(CertificateError, match="are not the polynomial"):
        check_certificate(replace(proof, bound=proof.bound + 1e-12))


def test_a_negative_square_is_refused(proof):
    # The identity still stands: what one entry of Q0 loses, another that makes up the same monomial gains.
    q0, q1, q2 = proof.leaves[0].squares
    taken = q0[1][1] + 1
    moved = changed(changed(changed(q0, 1, 1, -taken), 0, 3, taken / 2), 3, 0, taken / 2)
    with pytest.raises(CertificateError, match="semidefinite"):
        check_certificate(planted(proof, (moved, q1, q2)))


def test_a_matrix_that_is_not_symmetric_is_refused(proof):
    q0, q1, q2 = proof.leaves[0].squares
    skew = changed(changed(q0, 0, 1, Fraction(1)), 1, 0, Fraction(-1))
    with pytest.raises(CertificateError, match="semidefinite"):
        check_certificate(planted(proof, (skew, q1, q2)))


@pytest.mark.parametrize("squares", [(), ((), (), ()), "abc"])
def test_malformed_squares_are_refused(proof, squares):
    with pytest.raises(CertificateError, match="malformed"):
        check_certificate(planted(proof, squares))


def test_a_tolerance_finer_than_floats_is_refused():
    with pytest.raises(ComputationError, match="spacing of floats"):
        least_point(CIRCLE + polynomial(x0y0=1e9), BOX, 1e-12)


@pytest.mark.parametrize("exponents", [None, (4, 1), (1, 4), (3, 2), (4, 4)])
def test_no_squares_of_nothing_and_of_what_is_no_polynomial(exponents):
    table = fmpq_mat(5, 5)
    if exponents:
        table[exponents] = table[0, 0] = fmpq(1)
    assert gram_matrices(table) == NoSquares((0.0, 0.0))


def test_a_curve_of_equal_minima_of_higher_degree_is_given_up():
    # (x^2 y - 1)^2 is zero along a curve, but no quartic.
    with pytest.raises(ComputationError, match="within 300 boxes, nor by 20 sums of squares"):
        least_point(polynomial(x4y2=1, x2y1=-2, x0y0=1), BOX, 1e-10)


def test_what_the_search_in_floats_finds_is_believed_only_where_it_is_definite(monkeypatch):
    # 8 + 3 x^2 + ... as it is spread: Q0 is definite, Q1 and Q2 are zero until the search has found some.
    table = fmpq_mat(5, 5)
    for exponents, c in {(0, 0): 8, (2, 0): 3, (0, 2): 3, (4, 0): 2, (0, 4): 2, (2, 2): 3}.items():
        table[exponents] = fmpq(c)
    assert not isinstance(gram_matrices(table), NoSquares)
    monkeypatch.setattr(proof_squares, "_definite", lambda start: [fmpq(0)] * 18)
    assert gram_matrices(table) == NoSquares((0.0, 0.0))


def quartic(**coefficients):
    """A table of exact numbers, by names such as x2y1."""
    table = fmpq_mat(5, 5)
    for name, value in coefficients.items():
        table[int(name[1]), int(name[3])] = fmpq(value)
    return table


@pytest.mark.parametrize(
    "negative", [quartic(x0y0=-1, x2y0=-1), quartic(x0y0=-3, x4y0=-1, x0y4=-1), quartic(x0y0=-1, x0y2=-2, x2y2=-1)]
)
def test_what_is_negative_everywhere_is_no_sum_of_squares(negative):
    assert isinstance(gram_matrices(negative), NoSquares)
    assert not isinstance(gram_matrices(negative * -1), NoSquares)


@pytest.mark.parametrize(
    ("table", "lowest"),
    [
        # 2 (x - 1/4)^2 + (y + 1/2)^2 less than it takes; and where a box stops it.
        (quartic(x0y0=-1, x1y0=-1, x2y0=2, x0y1=1, x0y2=1), (0.25, -0.5)),
        (quartic(x0y0=-9, x1y0=-8, x2y0=2, x0y1=8, x0y2=1), (1.0, -1.0)),
    ],
)
def test_where_there_are_no_squares_the_lowest_point_is_known_to_ten_digits(table, lowest):
    assert gram_matrices(table).lowest == pytest.approx(lowest, abs=5e-11)
