"""Mistakes of a laboratory: one at a time, larger than a careful one makes them, and all at once."""

import dataclasses

from rig import Mistakes


@dataclasses.dataclass
class Case:
    """A mistake, what the program has to name, and its size in the unit of that cause."""

    mistakes: Mistakes
    cause: str
    size: float
    options: dict = dataclasses.field(default_factory=dict)  # of `rig.write`


COMPUTED = {"computed_b": True}
CASES = {
    "gain of A 2 %": Case(Mistakes(gain={"A": 0.02}), "gain of A", 0.02),
    "gain of the assembly 2 %": Case(Mistakes(gain={"C": 0.02}), "gain of the assembly", 0.02),
    "a channel of the assembly 2 %": Case(
        Mistakes(channel={("C", 1): 0.02}), "gain of the channel 12:+Y of the assembly", 0.02
    ),
    "rotation of A 5 %": Case(Mistakes(channel={("A", 1): 0.05}), "gain of the channel 1:+RZ of A", 0.05),
    "phase of A 1°": Case(Mistakes(phase={"A": 0.0174533}), "phase of A", 0.0174533),
    "delay of A 50 µs": Case(Mistakes(delay={"A": 50e-6}), "delay of A", 50e-6),
    "delay of the assembly 50 µs": Case(Mistakes(delay={"C": 50e-6}), "delay of the assembly", 50e-6),
    "sensor at the joint of A 1 mm": Case(Mistakes(joint_sensor={"A": 1e-3}), "position of the joint on A", 1e-3),
    "sensor at the joint of B 1 mm": Case(Mistakes(joint_sensor={"B": 1e-3}), "position of the joint on B", 1e-3),
    "a sensor of the assembly 1 mm": Case(Mistakes(point={1: 1e-3}), "position of 12:+Y on the assembly", 1e-3),
    "A clamped again −1 %": Case(Mistakes(frequency={"A": -0.01}), "frequencies of A in the assembly", -0.01),
    "A clamped again −0.2 %": Case(Mistakes(frequency={"A": -0.002}), "frequencies of A in the assembly", -0.002),
    "frequencies of B 0.5 %": Case(Mistakes(frequency={"B": 0.005}), "frequencies of B in the assembly", 0.005),
    "accelerometer on the assembly 5 g": Case(
        Mistakes(accelerometer={"C": 0.005}), "mass of the accelerometer on the assembly", 0.005
    ),
    "accelerometer on A 5 g": Case(Mistakes(accelerometer={"A": 0.005}), "mass of the accelerometer on A", 0.005),
    "bolt on B 20 g": Case(Mistakes(joint_mass={"B": 0.020}), "mass at the joint on B", 0.020),
    "loss factor 0.05": Case(Mistakes(loss_factor=0.05), "loss factor of the joint", 0.05),
    "computed B, E −1 %": Case(Mistakes(young=-0.01), "Young's modulus of B", -0.01, COMPUTED),
    "computed B without shear": Case(
        Mistakes(), "Young's modulus of B", -0.0043, COMPUTED | {"timoshenko": False}
    ),
}


def drawn(generator, rows=None, joints=("A", "B")):
    """Every mistake at once, each as large as a careful laboratory makes it; `joints` are those of both sides at each bolt."""
    normal = generator.standard_normal
    rows = rows or {"A": 2, "B": 5, "C": 3}
    return Mistakes(
        gain={name: 0.01 * normal() for name in "ABC"},
        channel={(name, row): 0.005 * normal() for name in "ABC" for row in range(rows[name])},
        delay={name: 5e-6 * normal() for name in "ABC"},
        accelerometer={name: 3e-4 * normal() for name in "ABC"},
        joint_sensor={joint: 5e-4 * normal() for joint in joints},
        frequency={side: 0.002 * normal() for side in "AB"},
        joint_mass={joint: 0.010 * normal() for joint in joints},
        loss_factor=0.02 * normal(),
        point={point: 5e-4 * normal() for point in range(rows["C"])},
    )
