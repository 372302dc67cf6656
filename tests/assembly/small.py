"""An assembly of one elastic mode and a rigid body: small enough for equations by hand."""

import json

import numpy as np
from scipy.integrate import solve_ivp

# A has one mode of 800 rad/s with 2 % of damping and shape 1.2 at the joint; B is a rigid body of 0.5 kg
SHAPE, OMEGA, RATIO, MASS = 1.2, 800.0, 0.02, 0.5
STIFFNESS, DAMPING = 4e5, 20.0


def write(folder, joint, extra=""):
    """The assembly file, with a joint that has these entries beside stiffness and damping."""
    own = 1 / SHAPE**2
    for name, mass, damping, stiffness in [
        ("a", own, 2 * RATIO * OMEGA * own, OMEGA**2 * own),
        ("b", MASS, 0.0, 0.0),
    ]:
        matrices = {"M": [[mass]], "C": [[damping]], "K": [[stiffness]]}
        np.savez(folder / f"{name}.npz", points=["1:+Y"], **{key: np.array(value) for key, value in matrices.items()})
    whole = {"dofs": ["y"], "stiffness": [[STIFFNESS]], "damping": [[DAMPING]], **joint}
    file = {"format": "bolted-joint/1", "name": "lap", "joint": whole}
    (folder / "lap.joint.json").write_text(json.dumps(file))
    path = folder / "small.toml"
    path.write_text(
        f"""name = "small"
[structures.a]
matrices = "a.npz"
[structures.b]
matrices = "b.npz"
[[joints]]
name = "lap"
file = "lap.joint.json"
a = {{ structure = "a", y = "1:+Y" }}
b = {{ structure = "b", y = "1:+Y" }}
[inputs]
push = "b/1:+Y"
[outputs]
tip = "b/1:+Y"
root = "a/1:+Y"
{extra}
"""
    )
    return path


def rates(state, load, friction):
    """Of x_a, x_b, v_a, v_b, with the joint's load beside its spring and damper."""
    x_a, x_b, v_a, v_b = state
    force = STIFFNESS * (x_a - x_b) + DAMPING * (v_a - v_b) + friction
    a = SHAPE**2 * -force - 2 * RATIO * OMEGA * v_a - OMEGA**2 * x_a
    return [v_a, v_b, a, (load + force) / MASS]


def with_cubic(times, load, cubic):
    """States at these times from rest under a held load, by SciPy."""

    def rate(_, state):
        return rates(state, load, cubic * (state[0] - state[1]) ** 3)

    done = solve_ivp(rate, (0, times[-1]), np.zeros(4), method="DOP853", rtol=1e-12, atol=1e-16, t_eval=times)
    return done.y.T


def with_lugre(end, load, law):
    """State at the end from rest under a held load, each piece between two turns by itself."""
    time, state, turns = 0.0, np.zeros(5), 0
    stiffness, slip, static = law["stiffness"], law["slip_force"], law["static_force"]

    def rate(_, state, direction):
        v, z = state[2] - state[3], state[4]
        g = slip + (static - slip) * np.exp(-((v / law["stribeck_velocity"]) ** 2))
        z_rate = v - stiffness * direction * v * z / g
        friction = stiffness * z + law["bristle_damping"] * z_rate + law["damping"] * v
        return [*rates(state[:4], load, friction), z_rate]

    def turn(_, state, direction):
        return (state[2] - state[3]) * direction

    turn.terminal, turn.direction = True, -1
    # the load on b moves it away from a
    direction = -1
    while time < end:
        done = solve_ivp(
            rate, (time, end), state, method="DOP853", rtol=1e-12, atol=1e-15, events=turn, args=(direction,)
        )
        time, state = done.t[-1], done.y[:, -1]
        if done.status == 1:
            direction, turns = -direction, turns + 1
    return state[:4], turns


def with_slider(end, load, stiffness, slip):
    """State at the end from rest under a held load, every stick and slip of the slider located by SciPy."""
    time, state, place, direction = 0.0, np.zeros(4), 0.0, 0
    turns = 0
    while time < end:

        def friction(state):
            return slip * direction if direction else stiffness * (state[0] - state[1] - place)

        def event(_, state):
            if direction:
                return direction * (state[2] - state[3])
            return slip - abs(friction(state))

        event.terminal, event.direction = True, -1
        done = solve_ivp(
            lambda _, state: rates(state, load, friction(state)),
            (time, end),
            state,
            method="DOP853",
            rtol=1e-12,
            atol=1e-16,
            events=event,
        )
        time, state = done.t[-1], done.y[:, -1]
        if done.status != 1:
            break
        turns += 1
        if direction:
            place, direction = state[0] - state[1] - slip * direction / stiffness, 0
        else:
            direction = int(np.sign(state[0] - state[1] - place))
    return state, turns
