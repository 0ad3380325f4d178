"""Figures of the search and of the pipeline that a blend hardly shows: each by itself, from both sides."""

from types import SimpleNamespace

import numpy as np
import pytest

from semispline import Base, BSplineSurface, blend
from semispline.solver.blending import fair_search, pipeline
from semispline.solver.blending.pipeline import state_problem

LINE = [0.0, 0.0, 1.0, 1.0]


def strip(x, width=1.0, z=0.0):
    """A flat strip from x on, one long."""
    return BSplineSurface(1, 1, LINE, LINE, [[[at, y, z] for y in (0, 1)] for at in (x, x + width)])


def strips(edge_a="u1", edge_b="u0"):
    """Two strips, 2 apart."""
    return Base(strip(0), edge_a), Base(strip(3, z=0.5), edge_b)


def test_the_three_lowest_wells_are_starts_and_the_lowest_comes_first():
    values = np.array([[9, 3, 9, 1, 9, 2, 9, 0, 9.0]])
    cells = np.arange(9.0)[:, None]
    assert fair_search._starts(cells, values)[:, 0].tolist() == [7, 3, 5]
    # Of wells that are equally deep the first ones.
    assert fair_search._starts(cells, np.minimum(values, 3.5) // 3)[:, 0].tolist() == [3, 5, 7]


@pytest.mark.parametrize(
    ("edges", "cells", "nodes"), [(("u1", "u0"), 6, 20), (("u0", "u1"), 8, 40)], ids=["facing", "U-turn"]
)
def test_u_turns_are_scanned_in_more_cells_and_places(monkeypatch, edges, cells, nodes):
    class Enough(Exception):
        pass

    def scan(objective, count):
        raise Enough(count, len(objective.table.across.weights))

    monkeypatch.setattr(fair_search, "_scan", scan)
    with pytest.raises(Enough) as asked:
        fair_search.solve_fair(state_problem(*strips(*edges)).problem)
    assert asked.value.args == (cells, nodes)


@pytest.mark.parametrize(("less", "chosen"), [(0.0, 0), (0.0009, 0), (0.0011, 1), (-1.0, 0), (1.0, 1)])
def test_blends_that_turn_alike_to_a_thousandth_of_a_degree_turn_equally(monkeypatch, less, chosen):
    results = [
        SimpleNamespace(shape=SimpleNamespace(turn=SimpleNamespace(degrees=x)), warnings=()) for x in (30, 30 - less)
    ]
    monkeypatch.setattr(pipeline, "blend", lambda a, b, options: results[("no", "yes").index(options.flip)])
    options = pipeline.named_options(None, {})
    assert pipeline._less_turning(*strips(), ("no", "yes"), options) is results[chosen]


@pytest.mark.parametrize("continuity", [("G0", "G1"), ("G1", "C0"), ("G1", "C1"), ("C1", "G1"), ("C0", "G0")])
def test_a_side_without_a_tangent_has_no_shape_parameter(continuity):
    result = blend(*strips(), continuity=continuity, alpha="natural")
    for value, wanted in zip((result.alpha2, result.beta2), continuity, strict=True):
        if wanted[1] == "0":
            assert value is None
        else:
            assert value == pytest.approx(1.0 if wanted == "C1" else np.sqrt(4.25), rel=1e-12)
