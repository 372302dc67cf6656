"""Figures by Matplotlib, which is imported where one is drawn."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ._functions import Functions
    from ._joint import Joint

#: More curves than this in one figure cannot be told apart.
MOST = 6


def functions(sets: "Mapping[str, Functions]", most: int = MOST) -> "Figure":
    """Magnitude and phase over frequency.

    Parameters
    ----------
    sets : mapping of str to Functions
        What is compared: dots for the first set where there are several, lines for the others.
    most : int
        At most so many functions are drawn, the strongest ones.

    Returns
    -------
    matplotlib.figure.Figure
    """
    import matplotlib.pyplot as plt

    first = next(iter(sets.values()))
    pairs = _strongest(first, most)
    figure, (above, below) = plt.subplots(
        2, 1, sharex=True, height_ratios=(3, 1), figsize=(8, 5), layout="constrained"
    )
    for number, (label, one) in enumerate(sets.items()):
        is_compared = len(sets) > 1
        style: dict[str, Any] = {"lw": 1}
        if is_compared and number == 0:
            style = {"marker": ".", "ms": 4, "ls": "", "alpha": 0.4}
        for color, (response, reference) in enumerate(pairs):
            if response not in one.responses or reference not in one.references:
                continue
            values = one[response, reference]
            name = " ".join(filter(None, (f"{response}/{reference}", label)))
            # lines over dots of the same colour would not be seen
            shade = "black" if is_compared and number > 0 else f"C{color}"
            above.semilogy(one.frequency_hz, np.abs(values), color=shade, label=name, **style)
            below.plot(one.frequency_hz, np.angle(values, deg=True), color=shade, **style)
    above.set_ylabel(f"{first.quantity}, SI")
    above.legend(fontsize="small")
    below.set_ylabel("phase, °")
    below.set_yticks([-180, -90, 0, 90, 180])
    below.set_xlabel("frequency, Hz")
    for axes in (above, below):
        axes.grid(alpha=0.3)
    return figure


def joints(joints: "Sequence[Joint]", from_hz: float = 1.0, to_hz: float | None = None) -> "Figure":
    """Real and imaginary part of K + iωC over frequency, one panel for each entry of the diagonal.

    Parameters
    ----------
    joints : sequence of Joint
        What is drawn, with bands of 95 % where the file states them.
    from_hz, to_hz : float
        Range; up to where the first joint was observed, or 1000 Hz.

    Returns
    -------
    matplotlib.figure.Figure
    """
    import matplotlib.pyplot as plt

    first = joints[0]
    end = to_hz or (first.data.get("validity") or {}).get("frequency_hz", (0.0, 1000.0))[1]
    frequency_hz = np.linspace(from_hz, end, 200)
    size = len(first.dofs)
    figure, panels = plt.subplots(1, size, squeeze=False, figsize=(4 * size, 3.5), layout="constrained")
    for place, axes in enumerate(panels[0]):
        for color, joint in enumerate(joints):
            values = joint.dynamic_stiffness(frequency_hz)[:, place, place]
            axes.semilogy(frequency_hz, values.real, color=f"C{color}", label=f"{joint.name}: K")
            axes.semilogy(frequency_hz, np.abs(values.imag), color=f"C{color}", ls="--", label="ωC")
            for interval, factor in (
                (joint.stiffness_interval_95, np.ones_like(frequency_hz)),
                (joint.damping_interval_95, 2.0 * np.pi * frequency_hz),
            ):
                if interval is not None:
                    low, high = np.maximum(interval[place, place], 0.0)
                    axes.fill_between(frequency_hz, low * factor, high * factor, color=f"C{color}", alpha=0.2)
        axes.set_title(first.dofs[place])
        axes.set_xlabel("frequency, Hz")
        axes.grid(alpha=0.3)
    panels[0][0].set_ylabel("N/m or N·m/rad")
    panels[0][0].legend(fontsize="small")
    return figure


def _strongest(functions: "Functions", most: int) -> list[tuple[str, str]]:
    """The functions with the highest peaks."""
    places = np.argwhere(functions.measured)
    peaks = [np.nanmax(np.abs(functions.values[:, row, column])) for row, column in places]
    order = np.argsort(peaks)[::-1][:most]
    return [(functions.responses[row], functions.references[column]) for row, column in places[order]]
