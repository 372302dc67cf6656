"""Figures by Matplotlib, which is imported where one is drawn."""

from collections.abc import Mapping, Sequence
from typing import TYPE_CHECKING, Any

import numpy as np

from ._values import whole

if TYPE_CHECKING:
    from matplotlib.figure import Figure

    from ._functions import Functions
    from ._joint import Joint
    from ._respond import Response
    from ._show import Comparison

#: More curves than this in one figure cannot be told apart.
MOST = 6


def functions(sets: "Mapping[str, Functions]", most: int = MOST) -> "Figure":
    """Magnitude and phase over frequency.

    Parameters
    ----------
    sets : mapping of str to Functions
        What is compared: dots for the first set where there are several, lines for the others. All are drawn as the
        quantity of the first.
    most : int
        At most so many functions are drawn, the strongest ones.

    Returns
    -------
    matplotlib.figure.Figure
    """
    from ._picture import Picture

    most = whole("most", most, 1)
    first = next(iter(sets.values()))
    pairs = _strongest(first, most, list(sets.values())[1:])
    figure = Picture(figsize=(8, 5), layout="constrained")
    above, below = figure.subplots(2, 1, sharex=True, height_ratios=(3, 1))
    for number, (label, given) in enumerate(sets.items()):
        one = given.as_quantity(first.quantity)
        is_compared = len(sets) > 1
        style: dict[str, Any] = {"lw": 1}
        if is_compared and number == 0:
            style = {"marker": ".", "ms": 4, "ls": "", "alpha": 0.4}
        for color, (response, reference) in enumerate(pairs):
            if (response, reference) not in _pairs(one):
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


def joints(
    joints: "Sequence[Joint]", from_hz: float = 1.0, to_hz: float | None = None, preload_n_m: float | None = None
) -> "Figure":
    """Real and imaginary part of K + iωC over frequency, one panel for each entry of the diagonal.

    Parameters
    ----------
    joints : sequence of Joint
        What is drawn, with bands of 95 % where the file states them.
    from_hz, to_hz : float
        Range; up to where the first joint was observed, or 1000 Hz.
    preload_n_m : float, optional
        Preload at which joints over the preload are drawn, N·m; at those of their tables if it is left out, of which at
        most six are drawn.

    Returns
    -------
    matplotlib.figure.Figure
    """
    from ._picture import Picture

    joints = [own for joint in joints for own in _at_preloads(joint, preload_n_m)]
    first = joints[0]
    end = to_hz or (first.data.get("validity") or {}).get("frequency_hz", (0.0, 1000.0))[1]
    frequency_hz = np.linspace(from_hz, end, 200)
    size = len(first.dofs)
    figure = Picture(figsize=(4 * size, 3.5), layout="constrained")
    panels = figure.subplots(1, size, squeeze=False)
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
    _below(figure, panels[0][0])
    return figure


def response(table: "Response", up: str | None = None, across: str | None = None) -> "Figure":
    """The picture of `Response.plot`."""
    from ._picture import Picture

    names = [name for name in table.columns if name != "level"]
    across = names[0] if across is None else across
    if up is None:
        # loads over time are what was given
        given = ("N", "N·m") if across == "time" else ()
        units = dict(zip(table.columns, table.units, strict=True))
        others = [name for name in names if name != across and units[name] not in given]
        up = next(iter(others), across).removesuffix(" real")
    is_complex = up not in table.columns and f"{up} real" in table.columns
    figure = Picture(figsize=(8, 4), layout="constrained")
    axes = figure.subplots()
    levels = table["level"] if "level" in table.columns else np.zeros(len(table))
    for lap, level in dict.fromkeys(zip(table.laps.tolist(), levels.tolist(), strict=True)):
        rows = (table.laps == lap) & (levels == level)
        values = np.abs(table.complex(up)) if is_complex else table[up]
        name = ", ".join(filter(None, (lap, _level(table, level))))
        axes.plot(table[across][rows], values[rows], lw=1, label=name)
        if name:
            axes.legend(fontsize="small")
    if is_complex:
        axes.set_yscale("log")
    axes.set_xlabel(_with_unit(table, across))
    axes.set_ylabel(_with_unit(table, f"{up} real", f"|{up}|") if is_complex else _with_unit(table, up))
    axes.grid(alpha=0.3)
    return figure


def _level(table: "Response", level: float) -> str:
    return f"{level:g} {table.units[table.columns.index('level')]}" if "level" in table.columns else ""


def _with_unit(table: "Response", column: str, name: str | None = None) -> str:
    return ", ".join(filter(None, (name or column, table.units[table.columns.index(column)])))


def comparison(found: "Comparison") -> "Figure":
    """The numbers of joints beside each other, each with its interval of 95 %.

    Parameters
    ----------
    found : Comparison
        What is drawn.

    Returns
    -------
    matplotlib.figure.Figure
    """
    from ._picture import Picture

    count = len(found.rows)
    columns = min(count, 6)
    lines = -(-count // columns)
    figure = Picture(figsize=(2.2 * columns, 2.4 * lines + 0.5), layout="constrained")
    panels = figure.subplots(lines, columns, squeeze=False)
    for place, axes in enumerate(panels.flat):
        if place >= count:
            axes.set_visible(False)
            continue
        for number, name in enumerate(found.names):
            deviation = found.standard_deviations[place, number]
            # of a normal distribution 95 % are within 1.96 standard deviations
            error = 0.0 if np.isnan(deviation) else 1.96 * deviation
            axes.errorbar(number, found.values[place, number], yerr=error, fmt="o", ms=4, capsize=3, label=name)
        axes.set_title(f"{found.rows[place]}, {found.details['rows'][place]['unit']}", fontsize="small")
        axes.set_xlim(-0.5, len(found.names) - 0.5)
        axes.set_xticks([])
        axes.grid(alpha=0.3)
    _below(figure, panels[0][0])
    return figure


def damping_over_amplitude(result: "Mapping[str, Any]") -> "Figure":
    """Damping ratio of a layered beam's modes over the amplitude.

    Parameters
    ----------
    result : mapping
        What ``bolted-joint predict --json`` tells as ``result``, method ``layered-beam``.

    Returns
    -------
    matplotlib.figure.Figure
    """
    from ._picture import Picture

    figure = Picture(figsize=(6, 4), layout="constrained")
    axes = figure.subplots()
    for mode in result["modes"]:
        points = [one for one in result["amplitudes"] if one["mode"] == mode["number"]]
        if points:
            amplitudes, ratios = zip(*((one["amplitude_m"], one["damping_ratio"]) for one in points), strict=True)
            axes.loglog(amplitudes, ratios, lw=1, label=f"mode {mode['number']}, {mode['frequency_hz']:.4g} Hz")
    axes.set_xlabel("amplitude at the drive point, m")
    axes.set_ylabel("damping ratio")
    axes.grid(alpha=0.3)
    axes.legend(fontsize="small")
    return figure


def frequencies(torques: "Sequence[Mapping[str, Any]]") -> "Figure":
    """Natural frequencies that were measured at each torque, and those of the laps that were found.

    Parameters
    ----------
    torques : sequence of mapping
        What ``bolted-joint identify --json`` tells of each torque, method ``lap-update``.

    Returns
    -------
    matplotlib.figure.Figure
    """
    from ._picture import Picture

    figure = Picture(figsize=(6, 4), layout="constrained")
    axes = figure.subplots()
    # a study of one assembly need not state its torque
    known = all(one["torque_n_m"] is not None for one in torques)
    across = [one["torque_n_m"] if known else number for number, one in enumerate(torques)]
    for key, label, style in [("measured_rad_per_s", "measured", "o"), ("updated_rad_per_s", "identified", "kx-")]:
        for mode in range(max(len(one[key]) for one in torques)):
            found = [one[key][mode] / (2.0 * np.pi) if mode < len(one[key]) else np.nan for one in torques]
            axes.plot(across, found, style, lw=1, label=f"mode {mode + 1} {label}")
    axes.set_xlabel("torque, N·m" if known else "assembly")
    axes.set_ylabel("natural frequency, Hz")
    axes.grid(alpha=0.3)
    axes.legend(fontsize="small")
    return figure


def runs(backbones: "Sequence[Mapping[str, Any]]", resonances: "Sequence[Mapping[str, Any]]") -> "Figure":
    """Frequencies and damping ratios over the amplitude, and resonances of stepped sines, measured and of the model.

    Parameters
    ----------
    backbones, resonances : sequence of mapping
        What ``bolted-joint identify --json`` tells as ``backbones`` and ``predictions``, method ``lap-response``.

    Returns
    -------
    matplotlib.figure.Figure
    """
    from ._picture import Picture

    figure = Picture(figsize=(8, 5), layout="constrained")
    above, below = figure.subplots(2, 1, sharex=True)
    for number, one in enumerate(backbones):
        for axes, key in [(above, "frequency_hz"), (below, "damping_ratio")]:
            points = [(point["amplitude_m"], point[key]) for point in one["points"] if point.get(key) is not None]
            for source, label, style in [("measured", "measured", f"C{number}."), ("predicted", "identified", "k-")]:
                found = [(amplitude, value[source]) for amplitude, value in points if value[source] is not None]
                if found:
                    axes.plot(*zip(*found, strict=True), style, lw=1, label=f"{one['run']} {label}")
    for source, label, style in [("measured", "measured", "o"), ("predicted", "identified", "kx")]:
        tops = [one[source] for one in resonances if one[source] is not None]
        found = [(top["displacement_m"], top["frequency_hz"]) for top in tops]
        if found:
            above.plot(*zip(*found, strict=True), style, label=f"resonances {label}")
    above.set_ylabel("frequency, Hz")
    above.legend(fontsize="small")
    below.set_ylabel("damping ratio")
    below.set_xlabel("amplitude of the displacement, m")
    below.set_xscale("log")
    for axes in (above, below):
        axes.grid(alpha=0.3)
    return figure


def _below(figure: "Figure", axes: Any) -> None:
    """The legend of one panel, below all of them: names are long, and curves fill the panels."""
    handles, labels = axes.get_legend_handles_labels()
    figure.legend(handles, labels, fontsize="small", loc="outside lower center", ncols=2)


def _at_preloads(joint: "Joint", preload_n_m: float | None) -> "list[Joint]":
    """A joint over the preload at one preload, or at those of its table; any other joint as it is."""
    preloads = joint.preloads
    if not preloads:
        return [joint]
    if preload_n_m is not None:
        return [joint.at_preload(preload_n_m)]
    places = np.unique(np.linspace(0, len(preloads) - 1, min(MOST, len(preloads))).round().astype(int))
    return [joint.at_preload(preloads[place]) for place in places]


def _strongest(functions: "Functions", most: int, others: "Sequence[Functions]") -> list[tuple[str, str]]:
    """The functions with the highest peaks, of those that the others have too unless there are none."""
    pairs = _pairs(functions)
    common = [pair for pair in pairs if all(pair in _pairs(other) for other in others)]
    peaks = {pair: np.nanmax(np.abs(functions[pair])) for pair in common or pairs}
    return sorted(peaks, key=lambda pair: peaks[pair], reverse=True)[:most]


def _pairs(functions: "Functions") -> list[tuple[str, str]]:
    """Response and reference of the functions that were measured."""
    return [(functions.responses[row], functions.references[column]) for row, column in np.argwhere(functions.measured)]
