"""Plots of how the measures of a contact run along the edge."""

from __future__ import annotations

from collections.abc import Mapping
from io import BytesIO

import numpy as np

from semispline.solver.judge import Profile

# Name of the file, measure, and what its axis says.
_PLOTS = (
    ("gap.png", "gap", "gap, {unit}"),
    ("off.png", "off", "off the trim curve, {unit}"),
    ("angle.png", "angle_degrees", "angle, degrees"),
    ("curvature.png", "curvature_jump_relative", "jump of curvature, relative"),
    ("rate.png", "rate_jump_relative", "jump of its rate, relative"),
    ("second-rate.png", "second_rate_jump_relative", "jump of its second rate, relative"),
)
_WIDTH, _HEIGHT, _DPI = 8.0, 3.6, 150
# A maximum that is so many times below its limit is seen on a logarithmic axis alone.
_FAR = 20.0


def profile_plots(profile: Profile, limits: Mapping[str, float], unit: str | None) -> dict[str, bytes]:
    """Return PNG files by name, one for each measure, over the length of edge a.

    Parameters
    ----------
    profile : Profile
    limits : mapping
        Measure -> what it may be; none is drawn where there is none.
    unit : str or None
        Of length.
    """
    found = ((name, measure, words) for name, measure, words in _PLOTS if measure in profile.values)
    return {
        name: _plot(profile, measure, words.format(unit=unit or "model units"), limits.get(measure), unit)
        for name, measure, words in found
    }


def _plot(profile: Profile, measure: str, words: str, limit: float | None, unit: str | None) -> bytes:
    # Matplotlib waits for a plot.
    from matplotlib.backends.backend_agg import FigureCanvasAgg
    from matplotlib.figure import Figure

    length, value = profile.length, profile.values[measure]
    figure = Figure(figsize=(_WIDTH, _HEIGHT), dpi=_DPI, layout="constrained")
    FigureCanvasAgg(figure)
    axes = figure.add_subplot()
    axes.set_xlabel(f"along edge A, {unit or 'model units'}")
    axes.set_ylabel(words)
    axes.grid(color="#d8d8d8", linewidth=0.6)
    axes.margins(x=0.01)
    known = np.isfinite(value)
    most = float(value[known].max(initial=0.0))
    # A limit that rounding has eaten up is none.
    limit = limit if limit is not None and np.isfinite(limit) and limit > 0 else None
    if most > 0 and limit is not None and most < limit / _FAR:
        axes.set_yscale("log")
        # What is nothing at all lies on the lower border.
        value = np.maximum(value, value[known & (value > 0)].min())
    else:
        top = max(most, limit or 0.0)
        axes.set_ylim(0, 1.12 * top if top > 0 else 1.0)
    axes.plot(length, value, color="#0072b2", linewidth=1.4)
    mean = profile.means[measure]
    if known.any():
        k = int(np.where(known, value, -np.inf).argmax())
        axes.plot(length[k], value[k], "o", color="#0072b2", markersize=5, label=f"maximum {most:.3g}", clip_on=False)
    if np.isfinite(mean):
        axes.axhline(max(mean, axes.get_ylim()[0]), color="#7f7f7f", linestyle=":", label=f"mean {mean:.3g}")
    if limit is not None:
        axes.axhline(limit, color="#d55e00", linestyle="--", label=f"limit {limit:.3g}")
    if axes.get_legend_handles_labels()[0]:
        figure.legend(loc="outside upper right", ncols=3, frameon=False)
    stored = BytesIO()
    figure.savefig(stored, format="png")
    return stored.getvalue()
