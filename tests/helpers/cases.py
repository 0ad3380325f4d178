"""Small inputs that once failed, each for a kind of fault."""

from pathlib import Path

CASES = Path(__file__).parents[1] / "cases"
