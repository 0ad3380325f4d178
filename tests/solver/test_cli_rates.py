"""`semispline check` on G3 and G4: tables, JSON, answers."""

import json

import numpy as np
import pytest
from typer.testing import CliRunner

from helpers.bases import moved
from helpers.high_order import facing, hand_made
from semispline import BSplineSurface, write_surface
from semispline.solver.cli import app


def run(*arguments):
    return CliRunner().invoke(app, [str(argument) for argument in arguments])


def files(folder, *, order=4, faults=None, offset=(0, 0, 0)):
    """A base and its blend of this order, as files; and the edges that meet."""
    a, b, p_a, p_b = facing(np.random.default_rng(2), order)
    made = hand_made(a, b, order, p_a=p_a, p_b=p_b, faults=faults).to_bspline()
    for name, surface in (("a", a.surface), ("c", made)):
        write_surface(folder / f"{name}.json", moved(surface, offset=offset))
    return folder / "a.json", folder / "c.json", "--edge-a", "u0", "--edge-b", "u0"


def test_all_rates_are_shown_and_answered(tmp_path):
    call = files(tmp_path)
    for required in ("G2", "G3", "g4"):
        done = run("check", *call, "--require", required)
        assert done.exit_code == 0
        assert done.stdout.splitlines()[-1] == f"{required.upper()}: yes"
    rows = [line.split("  ")[0] for line in done.stdout.splitlines()]
    assert rows[3:9] == [
        "curvature jump",
        "curvature jump, relative",
        "rate jump",
        "rate jump, relative",
        "second rate jump",
        "second rate jump, relative",
    ]
    assert "1/(model units)\u00b2" in done.stdout
    assert "1/(model units)\u00b3" in done.stdout
    assert "counts only" not in done.stdout


def test_json_holds_the_rates(tmp_path):
    done = run("check", *files(tmp_path, faults={(4, 4): 1.01}), "--require", "G4", "--json", "-")
    assert done.exit_code == 1
    record = json.loads(done.stdout)
    assert record["meets"] is False
    assert record["rate_jump_relative"] < 1e-10
    assert record["second_rate_jump_relative"] > 1e-6
    assert record["rate_jump"] < 1e-9 < record["second_rate_jump"]
    assert set(record["rate_at"]) == set(record["second_rate_at"]) == {"parameter", "point"}
    assert record["allowed"]["rate_jump_relative"] == pytest.approx(1e-8, rel=0.2)
    assert record["allowed"]["second_rate_jump_relative"] == pytest.approx(1e-7, rel=0.2)
    (miss,) = record["misses"]
    assert miss.startswith("second rate jump relative is ")


@pytest.mark.parametrize(
    ("place", "most", "counts"),
    [((2, 2), "G1", ["counts only with G2", "counts only with G3"]), ((3, 3), "G2", ["counts only with G3"])],
)
def test_an_order_counts_only_where_all_lower_ones_hold(tmp_path, place, most, counts):
    call = files(tmp_path, faults={place: 1.01})
    names = ("G1", "G2", "G3", "G4")
    for k, name in enumerate(names):
        done = run("check", *call, "--require", name)
        assert done.exit_code == (0 if k <= names.index(most) else 1)
    # Of G4 the lowest order that misses is named, and no other.
    assert done.stdout.splitlines()[-1].count("at most") == 1
    assert [text for text in ("counts only with G2", "counts only with G3") if text in done.stdout] == counts


def test_far_away_it_cannot_be_told(tmp_path):
    call = files(tmp_path, offset=(1e9, 0, 0))
    done = run("check", *call, "--require", "G4")
    assert done.exit_code == 3
    assert "G4 cannot be told: rounding alone may change" in done.stderr
    assert run("check", *call, "--require", "G1").exit_code == 0


def test_places_without_a_normal_qualify_these_answers_too(tmp_path):
    k1, k2 = [0, 0, 1, 1], [0, 0, 0, 1, 1, 1]
    lengths = 0.44**2, 0.44**2 - 0.44, 0.56**2
    cusp = [[[x * q, y, 0.0] for y, q in zip((0, 0.5, 1), lengths, strict=True)] for x in (0.0, 1.0)]
    flat = [[[x, y, 0.0] for y in (0, 0.5, 1)] for x in (-1.0, 0.0)]
    for name, net in (("a", flat), ("b", cusp)):
        write_surface(tmp_path / f"{name}.json", BSplineSurface(1, 2, k1, k2, net))
    edges = "--edge-a", "u1", "--edge-b", "u0"
    done = run("check", tmp_path / "a.json", tmp_path / "b.json", *edges, "--require", "G3")
    assert done.stdout.splitlines()[-1].startswith("G3: yes, but B has no proper normal at parameter 0.44")
    # Beside the cusp the speed across the edge is small, and its fourth power divides what rounds.
    done = run("check", tmp_path / "a.json", tmp_path / "b.json", *edges, "--require", "G4")
    assert done.exit_code == 3
    assert "G4 cannot be told" in done.stderr


def test_unknown_orders_are_refused_by_name(tmp_path):
    done = run("check", *files(tmp_path), "--require", "G5")
    assert done.exit_code == 2
    assert "expected one of C0, C1, C2, G0, G1, G2, G3, G4" in done.stderr


@pytest.mark.parametrize(("continuity", "rates"), [("G2", 0), ("G3", 1), ("G4", 2)])
def test_a_report_of_a_blend_holds_the_rates_that_were_asked_for(tmp_path, continuity, rates):
    a, b, *_ = facing(np.random.default_rng(0), 3)
    for name, base in (("a", a), ("b", b)):
        write_surface(tmp_path / f"{name}.json", base.surface)
    report = tmp_path / "r.json"
    call = tmp_path / "a.json", tmp_path / "b.json", "--edge-a", "u0", "--edge-b", "u0", "--continuity", continuity
    done = run("blend", *call, "-o", tmp_path / "c.json", "--report", report)
    assert done.exit_code == 0
    assert done.stdout.count("relative jump of its rate") == (2 if rates > 0 else 0)
    assert done.stdout.count("relative jump of its second rate") == (2 if rates > 1 else 0)
    for side in ("contact_a", "contact_b"):
        contact = json.loads(report.read_text())[side]
        for k, name in enumerate(("rate", "second_rate")):
            found = {f"{name}_jump", f"{name}_jump_relative", f"{name}_at"} & set(contact)
            assert len(found) == (3 if k < rates else 0)
        assert set(contact["allowed"]) == set(contact["rounding"]) <= set(contact)
