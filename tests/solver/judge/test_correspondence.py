"""Which way edges run along each other: where closeness decides, and where both directions are left."""

import numpy as np
import pytest

from helpers.shapes import line, revolved
from semispline import Base, BSplineSurface, transform
from semispline.solver.judge.correspondence import Correspondence, correspond, corresponding, is_closed, tied_directions

K1 = [0, 0, 1, 1]


def strip(along, across=(0.0, 0.0, 1.0), middle=(0.0, 0.0, 0.0)):
    """The edge u0 is a unit segment about its middle."""
    along, across, middle = (np.array(x, dtype=float) for x in (along, across, middle))
    return BSplineSurface(1, 1, K1, K1, [[middle + u * across + v * along for v in (-0.5, 0.5)] for u in (0, 1)])


@pytest.mark.parametrize(("cosine", "tied"), [(0.0099, True), (-0.0099, True), (0.0101, False), (-0.0101, False)])
def test_directions_within_a_hundredth_tie(cosine, tied):
    """Segments at an angle: the closeness of one direction is half its cosine, of the other the opposite."""
    a, b = Base(strip((1, 0, 0)), "u0"), Base(strip((cosine, np.sqrt(1 - cosine**2), 0)), "u0")
    closer = "no" if cosine > 0 else "yes"
    assert tied_directions(a, b) == ((closer, "yes" if closer == "no" else "no") if tied else (closer,))


def cone(square, height=0.0):
    """From a rim of radius 1 outwards and down, the square of the sine of its slope as given."""
    drop = np.sqrt(square / (1 - square))
    return Base(transform(revolved(line((1, 0), (2, -drop))), np.eye(3), [0, 0, height]), "u0")


@pytest.mark.parametrize(("square", "told"), [(0.0099, False), (0.0101, True), (0.5, True)])
def test_surfaces_tell_how_they_circle_from_a_product_of_sines_of_a_hundredth_on(square, told):
    """Both lie below their rims, as in a pipe that bends back: closeness says one direction, circling the other."""
    assert tied_directions(cone(square), cone(square, 0.5)) == (("no", "yes") if told else ("no",))


@pytest.mark.parametrize("outwards", [0.0, 1.0])
def test_a_straight_pipe_runs_one_way(outwards):
    above, below = (Base(revolved(line((1, side), (1 + outwards, side * 2))), "u0") for side in (1, -1))
    assert tied_directions(below, above) == ("no",)


def test_a_shift_between_rims_is_that_of_their_seams():
    """Turned about their axis by any angle, by Newton's method from samples; the parameters of a circle are uneven."""
    rim = revolved(line((1, 0), (1, -1)))
    for degrees in (37.0, 90.0, 200.0):
        t = np.radians(degrees)
        rotation = np.array([[np.cos(t), -np.sin(t), 0], [np.sin(t), np.cos(t), 0], [0, 0, 1]])
        a, b = Base(rim, "u0"), Base(transform(rim, rotation, [0, 0, 1.0]), "u0")
        assert is_closed(a)
        assert is_closed(b)
        matched = correspond(a, b)
        assert not matched.flipped
        s = np.linspace(0, 4, 9)[:-1]
        if degrees == 90:
            # A quarter of the circle is one piece: there nothing is uneven.
            assert matched.shift == pytest.approx(3.0, abs=1e-9)
            on_b = b.derivative(corresponding(a, b, matched, s), 0, 0)
            assert on_b == pytest.approx(a.derivative(s, 0, 0) + np.array([0, 0, 1]), abs=1e-9)
        else:
            # Of all shifts beside it none is closer.
            steps = matched.shift + np.array([-1e-3, 0.0, 1e-3])
            fine = np.linspace(0, 4, 4001)[:-1]
            apart = [
                np.sum(
                    (
                        b.derivative(corresponding(a, b, Correspondence(False, x % 4), fine), 0, 0)
                        - a.derivative(fine, 0, 0)
                    )
                    ** 2
                )
                for x in steps
            ]
            assert apart[1] < min(apart[0], apart[2])
