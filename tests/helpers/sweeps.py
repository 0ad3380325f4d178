"""Sweeps in two sizes: some examples in `make test`, all of them where SEMISPLINE_SWEEPS is "whole", as in .ci/run."""

import os

import pytest
from hypothesis import settings

# Examples of a test with hypothesis that says nothing else.
_WHOLE, _SOME = 100, 12
IS_WHOLE = os.environ.get("SEMISPLINE_SWEEPS", "") == "whole"


def examples(count=_WHOLE):
    """Settings of a test with hypothesis that tries `count` examples where all are asked for, fewer elsewhere."""
    return settings(max_examples=count if IS_WHOLE else -(-count * _SOME // _WHOLE))


def first_ones(count, values):
    """Parameters of a test, all but the first `count` of them marked slow."""
    return [v if k < count else pytest.param(v, marks=pytest.mark.slow) for k, v in enumerate(values)]


def first_rows(count, rows):
    """The same of tests with several parameters: each row has one value of each."""
    return [row if k < count else pytest.param(*row, marks=pytest.mark.slow) for k, row in enumerate(rows)]
