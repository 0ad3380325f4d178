"""Energy against number of control points, as SVG in the page: each method is a number, the one of its table."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from html import escape
from math import ceil, floor, log10

from semispline.papers.reproduction import Comparison, reached

_WIDTH, _HEIGHT = 640, 300
_LEFT, _RIGHT, _TOP, _BOTTOM = 70, 20, 14, 44
_COLORS = {"G2": "#2b7a3b", "G1": "#d99a00", "G0": "#b5651d", "none": "#b03a2e"}
# Methods closer than this on paper share a mark.
_NEAR = 15.0
_TICKS = 7


@dataclass
class _Mark:
    x: float
    y: float
    color: str
    numbers: list[int]


def energy_chart(comparisons: Sequence[Comparison]) -> str:
    """Return an SVG of all methods with control points that do not fold; colours tell the contact that is met.

    Folded results are left out: their energies say nothing of a usable blend.
    """
    found = [
        (number, float(c.outcome.control_points), c.measures.energy, reached(c.task, c.measures))
        for number, c in enumerate(comparisons, start=1)
        if c.outcome and c.measures and c.outcome.control_points and not c.measures.folds
    ]
    if len(found) < 2:
        return ""
    across = _Axis([points for _, points, _, _ in found], _LEFT, _WIDTH - _RIGHT)
    upwards = _Axis([energy for _, _, energy, _ in found], _HEIGHT - _BOTTOM, _TOP)
    marks: list[_Mark] = []
    for number, points, energy, contact in found:
        x, y, color = across.place(points), upwards.place(energy), _COLORS[contact]
        near = next((m for m in marks if m.color == color and abs(m.x - x) + abs(m.y - y) < _NEAR), None)
        if near:
            near.numbers.append(number)
        else:
            marks.append(_Mark(x, y, color, [number]))
    bottom = _HEIGHT - _BOTTOM
    parts = [f"<rect x='{_LEFT}' y='{_TOP}' width='{_WIDTH - _LEFT - _RIGHT}' height='{bottom - _TOP}' class='frame'/>"]
    for value in across.ticks():
        x = across.place(value)
        parts.append(f"<line x1='{x:.1f}' x2='{x:.1f}' y1='{_TOP}' y2='{bottom}' class='grid'/>")
        parts.append(f"<text x='{x:.1f}' y='{bottom + 16}' text-anchor='middle'>{value:g}</text>")
    for value in upwards.ticks():
        y = upwards.place(value)
        parts.append(f"<line x1='{_LEFT}' x2='{_WIDTH - _RIGHT}' y1='{y:.1f}' y2='{y:.1f}' class='grid'/>")
        parts.append(f"<text x='{_LEFT - 6}' y='{y + 4:.1f}' text-anchor='end'>{_round(value)}</text>")
    for mark in marks:
        label = ", ".join(map(str, mark.numbers))
        parts.append(f"<circle cx='{mark.x:.1f}' cy='{mark.y:.1f}' r='5' fill='{mark.color}'/>")
        parts.append(f"<text {_beside(mark)} class='mark'>{label}</text>")
    parts.append(
        f"<text x='{(_LEFT + _WIDTH - _RIGHT) / 2}' y='{_HEIGHT - 8}' text-anchor='middle'>control points</text>"
    )
    middle = (_TOP + bottom) / 2
    parts.append(
        f"<text x='14' y='{middle}' text-anchor='middle' transform='rotate(-90 14 {middle})'>energy (11)</text>"
    )
    title = escape(f"Energy against control points: {comparisons[0].task.title}")
    return f"<svg viewBox='0 0 {_WIDTH} {_HEIGHT}' role='img' aria-label='{title}' class='chart'>{''.join(parts)}</svg>"


def _beside(mark: _Mark) -> str:
    """Return where the numbers of a mark stand: on its right, below where they are many, left near the border."""
    if len(mark.numbers) > 2:
        return f"x='{mark.x - 5:.1f}' y='{mark.y + 17:.1f}' text-anchor='start'"
    if mark.x > _WIDTH - 120:
        return f"x='{mark.x - 8:.1f}' y='{mark.y + 4:.1f}' text-anchor='end'"
    return f"x='{mark.x + 8:.1f}' y='{mark.y + 4:.1f}' text-anchor='start'"


def _round(value: float) -> str:
    """Return a tick in few letters: 1.5e6 rather than 1500000."""
    return f"{value:.3g}".replace("e+0", "e")


class _Axis:
    """A logarithmic scale from data to the paper, with a little room at both ends."""

    def __init__(self, values: Sequence[float], start: float, end: float) -> None:
        low, high = log10(min(values)), log10(max(values))
        room = max(0.06 * (high - low), 0.01)
        self.low, self.high, self.start, self.end = low - room, high + room, start, end

    def place(self, value: float) -> float:
        """Return where a value lies."""
        return self.start + (log10(value) - self.low) / (self.high - self.low) * (self.end - self.start)

    def ticks(self) -> list[float]:
        """Return round numbers inside the scale: 1, 2, 5 times powers of ten, or finer ones on a short scale."""
        for steps in ((1,), (1, 2, 5), (1, 1.5, 2, 3, 4, 5, 6, 8), tuple(1 + 0.1 * k for k in range(90))):
            powers = range(floor(self.low), ceil(self.high) + 1)
            found = [s * 10.0**k for k in powers for s in steps if self.low <= log10(s * 10.0**k) <= self.high]
            if len(found) >= 3:
                return found[:: -(-len(found) // _TICKS)]
        return []


LEGEND = "".join(
    f"<span><i style='background:{color}'></i>{word}</span>"
    for word, color in zip(("G2", "G1 only", "G0 only", "not even G0"), _COLORS.values(), strict=True)
)
