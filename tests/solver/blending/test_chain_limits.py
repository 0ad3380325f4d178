"""Limits of chains and of their strips, each from both sides."""

from dataclasses import replace

import numpy as np
import pytest

from helpers.chains import LINE, box, circle, walls
from helpers.chains import line as straight
from semispline import Base, BSplineSurface, EdgeError, OptionError, chain
from semispline.solver.blending.chain_coefficients import Coefficients, JoinedPieces, Joint
from semispline.solver.blending.chain_pieces import Piece
from semispline.solver.blending.chain_rows import _degree, assembled, positive_rows, well_told_width
from semispline.solver.blending.end_faces import EndFace
from semispline.solver.splines import Basis, basis_matrix


@pytest.mark.parametrize(("apart", "meet"), [(0.8e-7, True), (1.25e-7, False)])
def test_ends_meet_within_a_part_in_1e7_of_the_faces(apart, meet):
    # 8 long, 2 high.
    faces = walls([straight((-4, 0), (0, 0)), straight((8 * apart, 0), (4, 0))])
    if meet:
        assert chain(faces).turned == (False, False)
    else:
        with pytest.raises(EdgeError, match=r"begins 1e-06 away .* at most 8e-07"):
            chain(faces)


def test_ends_that_are_the_same_to_the_last_bit_meet_within_nothing():
    one = chain(walls(box()), tolerance=0.0)
    assert one.closed
    assert one.turned == (False,) * 4


def test_two_edges_that_meet_at_both_ends_run_as_the_first_one_does():
    corners = [(0, 0), (2, 0), (2, 1), (0, 1), (0, 0)]
    halves = []
    for points in (corners[:3], corners[2:]):
        net = [np.column_stack([points, np.full(3, z)]) for z in (0.0, -1.0)]
        halves.append(Base(BSplineSurface(1, 1, LINE, [0, 0, 1, 2, 2], net), "u0"))
    one = chain(halves)
    assert one.closed
    assert one.turned == (False, False)


def test_places_on_a_chain_go_from_the_start_of_its_first_edge_to_the_end_of_its_last():
    strip = chain(walls([straight((0, 0), (2, 0)), straight((2, 0), (3, 0))])).strip(1)
    assert strip.place(0) == strip.cuts[0] == 0
    assert strip.place(2) == strip.cuts[-1]
    assert strip.place(0.5) == pytest.approx(strip.cuts[1] / 2, rel=1e-12)
    for x in (-0.5, -1e-9, 2 + 1e-9, 2.5):
        with pytest.raises(OptionError, match="expected 0 to 2"):
            strip.place(x)


@pytest.mark.parametrize("cuts", [(0, 90), (0, 45, 90), (0, 40, 90), (0, 20, 70, 90)])
def test_arcs_of_one_circle_stay_of_second_degree(cuts):
    """`blend` runs through them by one smooth circle; what joins them as they are would have a higher degree."""
    strip = chain(walls(circle(2.0, cuts))).strip(2)
    assert strip.surface.degree_v == 2


def bezier_of_degree(degree):
    x = np.linspace(0, 4, degree + 1)
    net = [np.column_stack([x, (-1.0) ** np.arange(degree + 1), np.full(degree + 1, z)]) for z in (0.0, -1.0)]
    return Base(BSplineSurface(1, degree, LINE, [0.0] * (degree + 1) + [1.0] * (degree + 1), net), "u0")


def test_degrees_along_up_to_25():
    assert chain([bezier_of_degree(25)]).strip(1).surface.degree_v == 25
    with pytest.raises(EdgeError, match="degree 26 along, expected at most 25"):
        chain([bezier_of_degree(26)]).strip(1)


def slanted_spline():
    """A face of degree 4 along, C3 at its inner knot, that leaves a plane curve upright; between slanted planes."""
    points = np.array([[0, 0], [1, 0.5], [2, -0.5], [3, 1.0], [4, 0.0], [5, 0.3]])
    net = [np.column_stack([points, np.full(6, z)]) for z in (0.0, -1.0)]
    knots = [0.0] * 5 + [0.5] + [1.0] * 5
    base = Base(BSplineSurface(1, 4, LINE, knots, net), "u0")
    ends = EndFace.plane(np.array([1.0, 0, 0.3])), EndFace.plane(np.array([1.0, 0, -0.5]))
    return replace(chain([base]), ends_on=ends), (knots, points)


def test_a_strip_is_smooth_to_second_order_inside_of_a_spline():
    """What runs through it fades out to third order: a knot of multiplicity degree - 2, and contact all along."""
    one, (knots, points) = slanted_spline()
    surface = one.strip(1).surface
    values, counts = np.unique(surface.knots_v, return_counts=True)
    assert values.tolist() == [0, 0.5, 1]
    assert counts[1] == surface.degree_v - 2
    v = np.linspace(0, 1, 41)
    tangents = np.diff(points, axis=0) / (np.array(knots[5:10]) - knots[1:6])[:, None]
    along = np.column_stack([basis_matrix(3, np.array(knots[1:-1]), v) @ tangents, np.zeros(41)])
    across = basis_matrix(surface.degree_v, surface.knots_v, v) @ (
        surface.control_points[1] - surface.control_points[0]
    )
    # It leaves in the face's own tangent plane, which is upright; roundings of points of size 5.
    assert np.abs(np.cross(along, across)[:, 2]).max() < 1e-11
    assert np.abs(across[[0, -1], 0] / across[[0, -1], 2] + [0.3, -0.5]).max() < 1e-12


@pytest.mark.parametrize(("fall", "width"), [(0.74, 1.0), (0.76, 0.5), (1.49, 0.5), (1.51, 0.25)])
def test_weights_of_a_strip_keep_a_quarter_of_the_least_on_the_contact(fall, width):
    """Over the width h the second row has the weights 1 -+ h `fall`: their mean does not change across."""
    jets = np.zeros((2, 2, 4))
    jets[0, :, 0], jets[0, :, 3], jets[1, :, 3] = [0, 1], 1, [-fall, fall]
    rows, found = positive_rows(jets, Basis(1, np.array([0.0, 0, 1, 1])), 1.0)
    assert found == width
    np.testing.assert_allclose(rows[:, :, 3], [[1, 1], [1 - width * fall, 1 + width * fall]], rtol=1e-14)


@pytest.mark.parametrize("least", [0.0, -0.1])
def test_weights_of_the_contact_that_vanish_are_refused(least):
    jets = np.zeros((2, 3, 4))
    jets[0, :, 0], jets[0, :, 3] = [0, 0.5, 1], [1, least, 1]
    with pytest.raises(EdgeError, match="cannot be made smooth and positive"):
        positive_rows(jets, Basis(2, np.array([0.0, 0, 0, 1, 1, 1])), 1.0)


def plain(order):
    values = np.zeros((2, 3, order + 1))
    values[:, 0, 0] = values[:, 1, 1] = 1.0
    return Coefficients(values, np.zeros_like(values), 1.0, 0.0)


@pytest.mark.parametrize(("times", "knots"), [(0.0, 0), (0.8, 0), (1.25, 1)])
def test_a_joint_of_one_spline_leaves_no_knot_unless_it_changes_a_part_in_1e12(times, knots):
    """A parabola 2 long, and beyond the joint the third power too: one cubic through all misses 1 / 19 of that."""
    jump = times * 1e-12 * 2 * 19
    bezier = Basis(3, np.array([0, 0, 0, 0, 1.0, 1, 1, 1]))
    pieces = []
    for k in (0, 1):
        # By polar forms: x = v, y = v^2 / 4 and the power, whose control points over [1, 2] are 0, 0, 0, 1.
        polar = [sorted([k] * (3 - i) + [k + 1] * i) for i in range(4)]
        x = [sum(p) / 3 for p in polar]
        y = [(p[0] * p[1] + p[0] * p[2] + p[1] * p[2]) / 12 for p in polar]
        y[3] += k * jump
        points = np.column_stack([x, y, np.zeros(4)])
        pieces.append(
            Piece(k, (0.0, 1.0), np.stack([points, np.tile([0.0, 0, 1], (4, 1))]), bezier, (3, 0), np.zeros(2), 1)
        )
    joint = Joint((1.0, 0.25, 0.0), "smooth", 0.0, 0.0, (0.0, 0.0), 0.0, (0.0, 0.0))
    joined = JoinedPieces(tuple(pieces), np.ones(2), (plain(1), plain(1)), (None, joint), (0, 1))
    _, along = assembled(joined)
    assert along.degree == 3
    assert np.count_nonzero(along.knots == 1) == knots


@pytest.mark.parametrize(
    ("degrees", "cubic", "found"),
    [
        # Nothing but constants runs through it.
        ((1, 0), [], 1),
        # w_1 cubic: it stands before R_w, which is constant, or linear.
        ((1, 0), [(1, 1)], 3),
        ((1, 1), [(1, 1)], 4),
        ((1, -1), [(1, 1)], 1),
        # q_1 before R_v, which is constant, or linear.
        ((1, 0), [(2, 1)], 3),
        ((2, 0), [(2, 1)], 4),
        # lambda before all of it.
        ((2, 0), [(0, 0)], 5),
    ],
)
def test_the_degree_of_a_strip_is_that_of_its_formula(degrees, cubic, found):
    """X = lambda R and X_u = lambda (w_1 R_w + q_1 R_v) + lambda_1 R."""
    own = plain(1)
    for name, order in cubic:
        own.slopes[0, name, order] = 1.0
    piece = Piece(0, (0.0, 1.0), np.zeros((2, 3, 3)), Basis(2, np.array([0.0, 0, 0, 1, 1, 1])), degrees, np.zeros(2), 1)
    assert _degree(piece, own) == found


def jets_along_a_line(length, *across):
    """Of a contact along x, with derivatives across of these sizes, straight down."""
    jets = np.zeros((1 + len(across), 2, 3))
    jets[0, 1, 0] = length
    for k, size in enumerate(across, start=1):
        jets[k, :, 2] = -size
    return jets, Basis(1, np.array([0.0, 0, 1, 1]))


@pytest.mark.parametrize(
    ("across", "width"),
    [
        # Half of 6: h s_1, h^2 s_2 / 2 or h^3 s_3 / 6 is 3 first.
        ((2.0, 0.0, 0.0), 1.5),
        ((0.5, 0.0, 0.0), 6.0),
        ((1.0, 1.5, 0.0), 2.0),
        ((0.1, 0.0, 18.0), 1.0),
        ((0.25, 0.5, 0.144), 12**0.5),
    ],
)
def test_a_strip_may_be_so_wide_that_it_leaves_a_contact_by_half_of_its_extent(across, width):
    assert well_told_width(*jets_along_a_line(6.0, *across)) == pytest.approx(width, rel=1e-13)


@pytest.mark.parametrize("radius", [1.0, 3.0])
def test_the_extent_of_a_closed_contact_is_its_diameter(radius):
    """A circle in half circles, whose middle control points lie at infinity."""
    halves = np.array([[1, 0, 0, 1], [0, 1, 0, 0], [-1, 0, 0, 1], [0, -1, 0, 0], [1, 0, 0, 1.0]])
    jets = np.stack([halves * [radius, radius, 1, 1], np.tile([0, 0, -0.5, 0], (5, 1))])
    basis = Basis(2, np.array([0, 0, 0, 0.5, 0.5, 1, 1, 1.0]))
    # Its points are seen at 64 steps: the cosine of half a step, on either side, is a part in 1000.
    assert well_told_width(jets, basis) == pytest.approx(2 * radius, rel=1e-3)


@pytest.mark.parametrize(("order", "length", "width"), [(3, 15.9, 1), (3, 16, 1), (3, 16.1, 4.025), (2, 100, 1)])
def test_rows_of_third_order_are_taken_further_apart_where_a_face_is_four_times_too_small(order, length, width):
    """2 high over a parameter of 1; half of its length is reached at a quarter of that."""
    strip = chain(walls([straight((0, 0), (length, 0))])).strip(order)
    assert strip.surface.domain[0] == pytest.approx((0, width), rel=1e-12)
    assert strip.shown.domain[0] == (0, 1)
    assert strip.surface.evaluate([width], [0.0])[0] == pytest.approx([0, 0, -2 * width], abs=1e-12)


def test_a_ring_that_is_one_circle_begins_with_its_first_edge_and_ends_with_its_last():
    strip = chain(walls(circle(2.0, (0, 100, 230, 360)))).strip(2)
    assert (strip.place(0), strip.place(3)) == (strip.cuts[0], strip.cuts[-1])
    assert strip.place(1) == pytest.approx(strip.cuts[1], rel=1e-9)
