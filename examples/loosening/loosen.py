"""A bolt loosens from 8 to 2 N·m while the lap joint rings: FMPy drives the FMU, and a picture shows what happens.

    bolted-joint export loosening.joint.json -o loosening.fmu --as lap
    python loosen.py loosening.fmu
"""

import argparse
import pathlib

import fmpy
import numpy as np

DURATION_S = 4.0
STEP_S = 1e-4
FIRST_NM, LAST_NM = 8.0, 2.0
# the bolt holds for a while, then loosens, then holds again
RAMP_S = (0.5, 3.5)
# a blow pushes the bodies apart: half a sine of force
BLOW_S, BLOW_N, BLOWS_EVERY_S = 1e-3, 2000.0, 0.5

OUTPUTS = ["a.y", "b.y", "preload", "energy.stored", "energy.supplied", "energy.dissipated", "energy.preload"]


def inputs():
    """Preload and loads at the communication points; FMPy holds them over the steps, so the preload goes down in steps."""
    time = np.arange(0.0, DURATION_S + 0.5 * STEP_S, STEP_S)
    preload = np.interp(time, RAMP_S, (FIRST_NM, LAST_NM))
    phase = time % BLOWS_EVERY_S
    force = np.where(phase < BLOW_S, BLOW_N * np.sin(np.pi * phase / BLOW_S), 0.0)
    table = np.zeros(len(time), dtype=[(name, float) for name in ("time", "preload", "a.F", "b.F")])
    table["time"], table["preload"], table["a.F"], table["b.F"] = time, preload, force, -force
    return table


def simulate(fmu):
    return fmpy.simulate_fmu(
        str(fmu), fmi_type="CoSimulation", stop_time=DURATION_S, output_interval=STEP_S, input=inputs(), output=OUTPUTS
    )


def resonance(result):
    """Times (s) and frequencies (Hz) of the relative motion, from the times at which it passes zero."""
    time, relative = result["time"], result["a.y"] - result["b.y"]
    below = relative[:-1] < 0
    rising = np.flatnonzero(below & (relative[1:] >= 0))
    zeros = time[rising] - relative[rising] * STEP_S / (relative[rising + 1] - relative[rising])
    periods = 12
    times = 0.5 * (zeros[periods:] + zeros[:-periods])
    frequencies = periods / (zeros[periods:] - zeros[:-periods])
    # a blow shifts the phase
    free = np.array([not any(b - 0.03 < t < b + 0.03 for b in np.arange(0, DURATION_S, BLOWS_EVERY_S)) for t in times])
    return times[free], frequencies[free]


def linear_model(fmu, preload):
    """Resonance of the relative motion at rest, Hz, from the FMU itself: its partial derivatives are the state matrix.

    The bodies are alike, so that ω² = −∂(a.acceleration)/∂(a.y) + ∂(a.acceleration)/∂(b.y).
    """
    description = fmpy.read_model_description(str(fmu))
    reference = {variable.name: variable.valueReference for variable in description.modelVariables}
    folder = fmpy.extract(str(fmu))
    instance = fmpy.instantiate_fmu(folder, description, "ModelExchange")
    is_fmi2 = description.fmiVersion == "2.0"
    if is_fmi2:
        instance.setupExperiment()
    instance.enterInitializationMode()
    frequencies = []
    for value in preload:
        (instance.setReal if is_fmi2 else instance.setFloat64)([reference["preload"]], [value])
        by_a, by_b = (
            instance.getDirectionalDerivative([reference["a.acceleration"]], [reference[known]], [1.0])[0]
            for known in ("a.y", "b.y")
        )
        frequencies.append(np.sqrt(by_b - by_a) / (2 * np.pi))
    instance.freeInstance()
    return np.array(frequencies)


def panel(top, height, title, unit, curves, seconds, names_x=480):
    """One diagram as SVG: curves are (name, colour, dashes, x, y), named from `names_x` on."""
    left, width = 70, 600
    everything = np.concatenate([y for *_, y in curves])
    low, high = everything.min(), everything.max()
    margin = 0.08 * (high - low)
    low, high = low - margin, high + margin
    x_of = lambda x: left + width * x / seconds
    y_of = lambda y: top + height * (high - y) / (high - low)
    raw = (high - low) / 4
    step = min((m * 10.0 ** np.floor(np.log10(raw)) for m in (1, 2, 5, 10)), key=lambda s: abs(s - raw))
    parts = [f'<text x="{left}" y="{top - 8}" class="title">{title}</text>']
    for tick in np.arange(np.ceil(low / step) * step, high, step):
        parts.append(f'<path class="grid" d="M{left} {y_of(tick):.1f}h{width}"/>')
        parts.append(f'<text x="{left - 6}" y="{y_of(tick) + 4:.1f}" text-anchor="end">{tick + 0.0:.4g}</text>')
    for tick in range(int(seconds) + 1):
        parts.append(f'<path class="grid" d="M{x_of(tick):.1f} {top}v{height}"/>')
        parts.append(f'<text x="{x_of(tick):.1f}" y="{top + height + 16}" text-anchor="middle">{tick}</text>')
    parts.append(f'<text x="16" y="{top + height / 2}" transform="rotate(-90 16 {top + height / 2})" text-anchor="middle">{unit}</text>')
    parts.append(f'<rect class="frame" x="{left}" y="{top}" width="{width}" height="{height}"/>')
    for index, (name, colour, dashes, x, y) in enumerate(curves):
        points = "L".join(f"{x_of(a):.1f} {y_of(b):.1f}" for a, b in zip(x, y))
        dash = f' stroke-dasharray="{dashes}"' if dashes else ""
        parts.append(f'<path d="M{points}" fill="none" stroke="{colour}" stroke-width="1.6"{dash}/>')
        y_name = top + 16 + 16 * index
        parts.append(f'<path d="M{names_x} {y_name - 4}h24" stroke="{colour}" stroke-width="2"{dash}/>')
        parts.append(f'<text x="{names_x + 30}" y="{y_name}">{name}</text>')
    return "".join(parts)


def picture(fmu, result):
    time = result["time"]
    times, frequencies = resonance(result)
    grid = np.linspace(0, DURATION_S, 161)
    expected = linear_model(fmu, np.clip(np.interp(grid, time, result["preload"]), LAST_NM, FIRST_NM))
    thin = slice(None, None, 100)
    few = slice(None, None, max(1, len(times) // 400))
    energies = [
        ("stored", "#1f7a3d", "", "energy.stored"),
        ("supplied by the blows", "#555", "", "energy.supplied"),
        ("dissipated", "#b03a2e", "", "energy.dissipated"),
        ("by the loosening", "#1f5fa8", "", "energy.preload"),
    ]
    panels = [
        panel(40, 110, "Preload", "N·m", [("input <tspan class='name'>preload</tspan>", "#1f5fa8", "", time[thin], result["preload"][thin])], DURATION_S),
        panel(210, 180, "Resonance of the relative motion", "Hz", [
            ("vibration, by its zeros", "#b03a2e", "", times[few], frequencies[few]),
            ("linear model", "#222", "6 4", grid, expected),
        ], DURATION_S),
        panel(450, 180, "Energy", "J", [(name, colour, dash, time[thin], result[key][thin]) for name, colour, dash, key in energies], DURATION_S, 84),
    ]
    return (
        '<svg xmlns="http://www.w3.org/2000/svg" viewBox="0 0 700 680" font-family="sans-serif" font-size="12">'
        "<style>.grid{stroke:#ddd;fill:none}.frame{stroke:#444;fill:none}.title{font-size:14px;font-weight:bold}"
        ".name{font-family:monospace}</style>"
        '<rect width="700" height="680" fill="#fff"/>' + "".join(panels)
        + '<text x="370" y="668" text-anchor="middle">time, s</text></svg>\n'
    )


def main():
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("fmu", type=pathlib.Path)
    parser.add_argument("-o", "--output", type=pathlib.Path, default=pathlib.Path("loosening.svg"))
    arguments = parser.parse_args()
    result = simulate(arguments.fmu)
    arguments.output.write_text(picture(arguments.fmu, result), encoding="utf-8")
    times, frequencies = resonance(result)
    first, last = frequencies[times < RAMP_S[0]].mean(), frequencies[times > RAMP_S[1]].mean()
    print(f"resonance: {first:.2f} Hz at {FIRST_NM:g} N·m, {last:.2f} Hz at {LAST_NM:g} N·m")
    print("linear model: {:.2f} Hz and {:.2f} Hz".format(*linear_model(arguments.fmu, [FIRST_NM, LAST_NM])))
    stored = result["energy.stored"] - result["energy.stored"][0]
    balance = stored - result["energy.supplied"] + result["energy.dissipated"] - result["energy.preload"]
    scale = result["energy.supplied"][-1]
    print(
        f"energy: {scale:.4f} J supplied, {result['energy.dissipated'][-1]:.4f} J dissipated, "
        f"{result['energy.preload'][-1]:.4f} J by the loosening, {stored[-1]:.4f} J stored; "
        f"balance off by {np.abs(balance).max() / scale:.1e} of what was supplied"
    )
    print(f"wrote {arguments.output}")


if __name__ == "__main__":
    main()
