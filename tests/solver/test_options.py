"""Options of a blend: one value through the library, files and the command line."""

from dataclasses import fields, replace

import numpy as np
import pytest
import typer
from typer.testing import CliRunner

from semispline import Base, BlendOptions, BSplineSurface, OptionError, blend
from semispline.solver.option_flags import takes_blend_options

KNOTS = [0, 0, 1, 1]
FLOOR = Base(BSplineSurface(1, 1, KNOTS, KNOTS, [[[0, 0, 0], [0, 1, 0]], [[1, 0, 0], [1, 1, 0]]]), "u1")
WALL = Base(BSplineSurface(1, 1, KNOTS, KNOTS, [[[2, 0, 1], [2, 1, 1]], [[2, 0, 2], [2, 1, 2]]]), "u0")
# Of every option another value than the default, and the words that say it on the command line.
OTHER = {
    "continuity": (("G1", "C2"), ["--continuity", "g1", "--continuity-b", "C2"]),
    "middle_curves": (2, ["--middle-curves", "2"]),
    "degree_u": (4, ["--degree-u", "4"]),
    "method": ("bfgs", ["--method", "bfgs"]),
    "flip": ("yes", ["--flip", "yes"]),
    "alpha": (("natural", 0.5), ["--alpha", "natural", "--alpha-b", "0.5"]),
    "alpha_v": ("linear", ["--alpha-v", "linear"]),
    "p2": ((0.1, -0.2), ["--p2", "0.1:-0.2"]),
    "bulge": ((1.5, 0.5), ["--bulge-a", "1.5", "--bulge-b", "0.5"]),
    "box": ((0.5, 2.0), ["--box", "0.5", "2"]),
    "v_scale": ("unit", ["--v-scale", "unit"]),
    "u_knots": ((0.25, 0.5), ["--u-knots", "0.25,0.5"]),
    "middle_knots": (((0.5,), ()), ["--middle-knots", "0.5", "--middle-knots", ","]),
    "match": (((0.25, 0.5), (0.5, 0.75)), ["--match", "0.25:0.5,0.5:0.75"]),
    "limits": ("cad", ["--limits", "cad"]),
    "strict": (True, ["--strict"]),
    "search_meets": (True, ["--search-meets"]),
}


def options_of(words):
    """What a command with the flags of a blend is given for these words."""
    given = []
    app = typer.Typer()

    @app.command()
    @takes_blend_options
    def command(options: BlendOptions) -> None:
        given.append(options)

    done = CliRunner().invoke(app, words, catch_exceptions=False)
    assert done.exit_code == 0, done.output
    return given[0]


def test_every_option_is_tried_here():
    assert set(OTHER) == {f.name for f in fields(BlendOptions)}
    assert all(value != getattr(BlendOptions(), name) for name, (value, _) in OTHER.items())


def test_nothing_said_leaves_the_defaults():
    assert options_of([]) == BlendOptions()


@pytest.mark.parametrize("name", OTHER)
def test_a_flag_sets_its_option_and_no_other(name):
    value, words = OTHER[name]
    assert options_of(words) == replace(BlendOptions(), **{name: value})


@pytest.mark.parametrize(
    ("flag", "pair"), [("--continuity-b", ("G2", "G1")), ("--alpha-b", (None, 0.5)), ("--bulge-b", (1.0, 0.5))]
)
def test_what_is_said_of_b_alone_leaves_a_at_its_default(flag, pair):
    name = flag.removeprefix("--").removesuffix("-b")
    assert getattr(options_of([flag, str(pair[1])]), name) == pair


def test_one_value_and_names_say_the_same():
    options = BlendOptions(continuity="G1", middle_curves=0)
    by_value, by_name = blend(FLOOR, WALL, options), blend(FLOOR, WALL, continuity="G1", middle_curves=0)
    assert by_value.alpha2 == by_name.alpha2
    for one, two in zip(by_value.surface.control_curves, by_name.surface.control_curves, strict=True):
        np.testing.assert_array_equal(one.control_points, two.control_points)
    assert by_value.continuity == ("G1", "G1")


@pytest.mark.parametrize("written", ["g1", "G1", ("g1", "G1")])
def test_lower_case_names_are_understood_and_kept_in_upper_case(written):
    assert blend(FLOOR, WALL, continuity=written, middle_curves=0).continuity == ("G1", "G1")


@pytest.mark.parametrize(
    ("call", "message"),
    [
        (lambda: blend(FLOOR, WALL, tension=1), "tension: no such option, expected one of continuity, middle_curves"),
        (lambda: blend(FLOOR, WALL, "G2"), "options: found a str, expected a BlendOptions"),
        (lambda: blend(FLOOR, WALL, BlendOptions(), strict=True), "options: found strict beside it"),
        (lambda: BlendOptions(continuity="g 2"), "continuity: found 'g 2', expected one of C0"),
        (
            lambda: BlendOptions(alpha="free"),
            "alpha: found 'free', expected fair, energy, natural or a positive number",
        ),
        (lambda: BlendOptions(u_knots=[0.5, float("nan")]), r"u_knots\[1\]: found nan, expected a finite number"),
        (lambda: BlendOptions(middle_knots=[0.5]), r"middle_knots\[0\]: found 0.5, expected numbers"),
        (lambda: BlendOptions(middle_knots="0.5"), "middle_knots: found '0.5', expected one of fourth, paper"),
    ],
)
def test_what_no_option_can_be_is_refused(call, message):
    with pytest.raises(OptionError, match=message):
        call()


@pytest.mark.parametrize("other", [{"method": "casadi"}, {"method": "bfgs"}, {"alpha": "energy"}])
@pytest.mark.parametrize(
    ("asked", "message"),
    [
        ({"alpha": ("fair", 1.0)}, "alpha: found fair with method .*, which minimises .*; give alpha energy"),
        ({"alpha": ((0.3, 0.9), 1.0)}, r"alpha: found \(0.3, 0.9\) with .*, expected one number for each side"),
        ({"alpha_v": "linear"}, "alpha_v: found linear with .*, expected constant"),
        ({"p2": (0.1, 0.0)}, r"p2: found \(0.1, 0.0\) with .*, expected zero"),
        ({"bulge": 1.5}, r"bulge: found \(1.5, 1.5\) with .*, expected 1"),
        ({"continuity": ("G2", "G3")}, "continuity: found G3 with .*, expected at most G2"),
    ],
)
def test_what_the_minimum_of_11_does_not_have_is_refused_beside_it(other, asked, message):
    if "alpha" in other and "alpha" in asked:
        other, message = {"alpha": (asked["alpha"][0], "energy")}, message.replace("method .*", "alpha energy")
        asked = {}
    with pytest.raises(OptionError, match=message):
        BlendOptions(**(asked | other))


@pytest.mark.parametrize(
    ("asked", "message"),
    [
        ({"continuity": ("G2", "C2"), "bulge": (1.0, 2.0)}, "bulge: found 2 at b, expected 1: C2 has no alpha"),
        ({"continuity": "G0", "bulge": 0.5}, "bulge: found 0.5 at a, expected 1: G0 has no alpha"),
        ({"continuity": ("G1", "G2"), "p2": (0.1, 0.0)}, "p2: found 0.1 at a, expected 0: G1 has no p2"),
        ({"continuity": "C2", "p2": (0.0, 1.0)}, "p2: found 1 at b, expected 0: C2 has no p2"),
        ({"continuity": "C2", "alpha_v": "linear"}, "alpha_v: found linear, but no alpha is searched"),
        ({"alpha": 0.9, "alpha_v": "linear"}, "alpha_v: found linear, but no alpha is searched; give alpha as X:Y"),
    ],
)
def test_what_a_contact_has_no_use_for_is_refused(asked, message):
    with pytest.raises(OptionError, match=message):
        BlendOptions(**asked)


def test_what_one_contact_has_use_for_is_taken():
    options = BlendOptions(continuity=("G2", "C2"), bulge=(2.0, 1.0), p2=(0.1, 0.0), alpha_v="linear")
    assert (options.bulges, options.p2, options.alpha_v) == ((2.0, 1.0), (0.1, 0.0), "linear")
    assert BlendOptions(continuity=("C2", "G1"), alpha=(0.5, None), alpha_v="linear").alphas == (0.5, None)


def test_c_is_not_advised_to_change_its_method():
    with pytest.raises(OptionError, match=r"found G3 with generated C, which minimises .11., expected at most G2$"):
        BlendOptions(continuity="G3").decided("generated C")


def test_a_pair_with_an_end_left_out_is_none():
    with pytest.raises(OptionError, match=r"--alpha: found '0\.3:', expected numbers with colons between them"):
        options_of(["--alpha", "0.3:"])


def test_what_is_unsaid_is_decided_by_what_is_minimised():
    fair, papers = BlendOptions().decided(), BlendOptions(alpha="energy").decided()
    shown = "alpha", "alpha_v", "degree_u", "middle_curves", "middle_knots", "p2", "v_scale"
    assert [getattr(fair, name) for name in shown] == [("fair", "fair"), "auto", 5, 0, "fourth", "auto", "length"]
    assert [getattr(papers, name) for name in shown] == [
        ("energy", "energy"), "constant", 3, 1, "paper", "zero", "paper",
    ]  # fmt: skip
    for method in ("casadi", "bfgs"):
        assert BlendOptions(method=method).decided() == replace(papers, method=method)
    assert BlendOptions().decided("generated C") == papers
    assert fair.decided() == fair
    assert papers.decided("generated C") == papers
    # A number leaves the set as it is: it is that of the method. With it there is nothing to search.
    assert BlendOptions(alpha=0.5).decided() == replace(fair, alpha=0.5, alpha_v="constant", p2="zero")
    assert BlendOptions(alpha=0.5, method="casadi").decided() == replace(papers, alpha=0.5, method="casadi")


@pytest.mark.parametrize(
    ("said", "decided"),
    [
        ({"alpha": "natural"}, ("constant", "zero")),
        ({"alpha": ((0.3, 0.4), 0.5)}, ("constant", "zero")),
        ({"alpha": ("natural", 0.5), "p2": (0.1, 0.2)}, ("constant", (0.1, 0.2))),
        ({"box": (1.0, 1.0)}, ("constant", "zero")),
        ({"box": (1.0, 1.0), "alpha_v": "linear"}, ("linear", "zero")),
        ({"continuity": "C2"}, ("constant", "zero")),
        # One side is searched.
        ({"box": (1.0, 1.01)}, ("auto", "auto")),
        ({"alpha": ("fair", 0.5)}, ("auto", "auto")),
        ({"continuity": ("C2", "G2")}, ("auto", "auto")),
        # In step with alpha^2, whatever that is.
        ({"alpha": 0.5, "continuity": ("G1", "G3")}, ("constant", "auto")),
        ({"alpha": "natural", "continuity": "G4"}, ("constant", "auto")),
        ({"alpha": "natural", "continuity": "G4", "p2": "zero"}, ("constant", "zero")),
    ],
)
def test_what_is_not_searched_is_constant_and_zero(said, decided):
    options = BlendOptions(**said).decided()
    assert (options.alpha_v, options.p2) == decided
    assert options.decided() == options


@pytest.mark.parametrize(
    ("continuity", "degree"),
    [("C0", 5), ("G2", 5), (("G3", "G1"), 6), (("G3", "C2"), 6), ("G3", 7), (("G4", "G3"), 8), ("G4", 9)],
)
def test_the_degree_leaves_neither_inner_knots_nor_middle_curves(continuity, degree):
    decided = BlendOptions(continuity=continuity).decided()
    assert (decided.degree_u, decided.middle_curves) == (degree, 0)


@pytest.mark.parametrize(
    ("continuity", "v_scale"),
    [
        ("G2", "length"),
        (("G1", "G4"), "stretched"),
        ("C1", "stretched"),
        (("C0", "G2"), "straight"),
        ("G0", "straight"),
    ],
)
def test_the_lower_order_decides_how_long_v_is(continuity, v_scale):
    assert BlendOptions(continuity=continuity).decided().v_scale == v_scale
    assert BlendOptions(continuity=continuity, v_scale="unit").decided().v_scale == "unit"
    if "G4" not in continuity:
        assert BlendOptions(continuity=continuity, alpha="energy").decided().v_scale == "paper"


@pytest.mark.parametrize("edge", [0.01, 100.0])
def test_bulges_have_a_range_with_two_ends(edge):
    assert BlendOptions(bulge=edge).bulges == (edge, edge)
    with pytest.raises(OptionError, match=r"bulge: found .*, expected 0\.01 to 100"):
        BlendOptions(bulge=edge * (1.001 if edge > 1 else 0.999))


@pytest.mark.parametrize("p2", ["free", 0.1, (0.1,), (0.1, float("nan")), (1e21, 0), ("a", "b")])
def test_p2_is_a_word_or_a_pair_of_numbers(p2):
    with pytest.raises(OptionError, match="p2"):
        BlendOptions(p2=p2)


def test_a_pair_on_the_command_line_is_for_both_ends_of_v():
    assert options_of(["--alpha", "0.3:0.9"]).alphas == ((0.3, 0.9), (0.3, 0.9))
    assert options_of(["--alpha", "0.3:0.9", "--alpha-b", "natural"]).alphas == ((0.3, 0.9), "natural")
    assert options_of(["--middle-knots", "paper"]).middle_knots == "paper"


def test_said_holds_what_a_file_needs():
    assert BlendOptions().said() == {}
    assert BlendOptions(**BlendOptions(alpha=0.5, strict=True).said()) == BlendOptions(alpha=0.5, strict=True)


def test_options_are_values():
    assert hash(BlendOptions(alpha=[0.5, 0.5])) == hash(BlendOptions(alpha=0.5))
    assert BlendOptions(middle_knots=np.array([[0.5]])) == BlendOptions(middle_knots=[[0.5]])
