"""Modelica packages, compiled and run by rumoca, against the FMU in FMPy."""

import sys
from pathlib import Path

import joints
import numpy as np
import pytest
from fmpy import simulate_fmu

sys.path.append(str(Path(__file__).resolve().parents[1] / "assembly"))
import small  # noqa: E402

rumoca = pytest.importorskip("rumoca", reason="rumoca is not installed")

STOP, STEP = 0.02, 1e-4
RATE = {"y": "v", "theta": "omega", "x": "vx", "z": "vz", "rx": "wx", "ry": "wy", "rz": "wz"}
LOAD = {"y": "F", "theta": "M"}
SPACE_LOAD = dict(zip(joints.DOFS, ["Fx", "Fy", "Fz", "Mx", "My", "Mz"]))


def names(file):
    """Name of rate and load of each DOF, which in space have y as an axis among three."""
    dofs = file["joint"]["dofs"]
    if dofs in (["y"], ["y", "theta"]):
        return dofs, RATE, LOAD
    return dofs, {**RATE, "y": "vy"}, SPACE_LOAD


def course(place):
    """Amplitude, rad/s and phase of the motion of side a on a DOF."""
    return 1e-5 / (1 + place), 2 * np.pi * (100 + 37 * place), 0.3 * place


def in_modelica(path, file):
    """Load on side b over time: side a moves, side b is held."""
    dofs, _, load = names(file)
    moves = "".join(
        "    m.{} = {!r}*(sin({!r}*time + {!r}) - sin({!r}));\n".format(dof, *course(place), course(place)[2])
        for place, dof in enumerate(dofs)
    )
    inside = path.read_text(encoding="ascii").rstrip()
    end = f"end {path.stem};"
    assert inside.endswith(end)
    test = (
        "  model Test\n    Joint joint;\n    Ground g;\n    Motion m;\n  equation\n"
        f"{moves}    connect(m.flange, joint.a);\n    connect(g.flange, joint.b);\n  end Test;\n"
    )
    source = path.parent / "with-test" / path.name
    source.parent.mkdir()
    source.write_text(inside[: -len(end)] + test + end + "\n", encoding="ascii")
    model = rumoca.Session().load(str(source), model=f"{path.stem}.Test")
    result = model.simulate(t=(0, STOP), config=rumoca.SimConfig(rtol=1e-10, atol=1e-13, dt=STEP))
    # what is recorded at events stands between the points that were asked for
    time = np.array(result["time"])
    points = np.linspace(0, STOP, round(STOP / STEP) + 1)
    places = np.array([np.argmin(abs(time - point)) for point in points])
    np.testing.assert_allclose(time[places], points, rtol=0, atol=1e-12)
    # a flow into a flange acts on the component
    return points, {dof: -np.array(result[f"joint.b.{load[dof]}"])[places] for dof in dofs}


def in_fmpy(fmu, file, time):
    dofs, rates, load = names(file)
    motion = np.zeros(len(time), dtype=[("time", float)] + [(f"a.{name}", float) for dof in dofs for name in (dof, rates[dof])])
    motion["time"] = time
    for place, dof in enumerate(dofs):
        amplitude, omega, phase = course(place)
        motion[f"a.{dof}"] = amplitude * (np.sin(omega * time + phase) - np.sin(phase))
        motion[f"a.{rates[dof]}"] = amplitude * omega * np.cos(omega * time + phase)
    outputs = [f"b.{load[dof]}" for dof in dofs]
    result = simulate_fmu(str(fmu), input=motion, output=outputs, stop_time=time[-1], output_interval=STEP, step_size=STEP)
    assert len(result) == len(time)
    return {dof: result[f"b.{load[dof]}"] for dof in dofs}


def cubic():
    return joints.joint(["y"], [[2e6]], [[30.0]], cubic=[4e15], higher={"damping_quadratic": [6e9]})


def sliding(law):
    friction = [{"dof": "y", "law": law, "stiffness": 1.5e6, "slip_force": 6.0}]
    return joints.joint(["y"], [[2e6]], [[30.0]], friction=friction)


def law(name, **parameters):
    return joints.joint(["y"], [[2e6]], [[30.0]], friction=[{"dof": "y", "law": name, **parameters}])


CASES = {
    "planar": joints.planar(),
    "in space": joints.coupled(),
    "cubic": cubic(),
    "jenkins": sliding("jenkins"),
    "dahl": sliding("dahl"),
    "bouc-wen": law("bouc-wen", stiffness=1.5e6, slip_force=6.0, exponent=2.0, beta=0.6, gamma=0.4),
    "valanis": law("valanis", stiffness=1.5e6, slip_stiffness=2e5, slip_force=6.0, kappa=0.6),
}


@pytest.mark.parametrize("file", CASES.values(), ids=CASES.keys())
def test_loads_are_those_of_the_fmu(convert, export, file):
    time, found = in_modelica(convert(file, "modelica", "Bolted.mo"), file)
    expected = in_fmpy(export(file, "element"), file, time)
    for dof, load in found.items():
        largest = max(abs(expected[dof]))
        # FMPy sets the inputs of a step's beginning, so that its outputs are those of one step before
        np.testing.assert_allclose(expected[dof][1:], load[:-1], rtol=0, atol=1e-6 * largest, err_msg=dof)


def test_bodies_move_as_the_equations_say(convert):
    """Two free bodies with the joint between them, against the closed form of their relative motion."""
    file = joints.joint(["y"], [[2e6]], [[30.0]])
    path = convert(file, "modelica", "Bolted.mo")
    inside = path.read_text(encoding="ascii").rstrip()
    end = "end Bolted;"
    test = (
        "  model Test\n    Joint joint;\n    Body a(m=1.3, y(start=1e-5));\n    Body b(m=0.7);\n  equation\n"
        "    connect(a.flange, joint.a);\n    connect(b.flange, joint.b);\n  end Test;\n"
    )
    source = path.parent / "with-test" / path.name
    source.parent.mkdir()
    source.write_text(inside[: -len(end)] + test + end + "\n", encoding="ascii")
    model = rumoca.Session().load(str(source), model="Bolted.Test")
    result = model.simulate(t=(0, STOP), config=rumoca.SimConfig(rtol=1e-10, atol=1e-14, dt=STEP))
    time = np.array(result["time"])
    reduced = 1.3 * 0.7 / 2.0
    decay, omega = 30.0 / (2 * reduced), np.sqrt(2e6 / reduced)
    damped = np.sqrt(omega**2 - decay**2)
    expected = 1e-5 * np.exp(-decay * time) * (np.cos(damped * time) + decay / damped * np.sin(damped * time))
    found = np.array(result["a.y"]) - np.array(result["b.y"])
    np.testing.assert_allclose(found, expected, rtol=0, atol=1e-6 * 1e-5)


ASSEMBLIES = {
    "cubic": {"cubic": [1e12]},
    "jenkins": {"friction": [{"dof": "y", "law": "jenkins", "stiffness": 2e5, "slip_force": 6.0}]},
}


@pytest.mark.parametrize("joint", ASSEMBLIES.values(), ids=ASSEMBLIES.keys())
def test_an_assembly_is_that_of_the_fmu(run, tmp_path, joint):
    """Loads in, motions out, under a held load."""
    path = small.write(tmp_path, joint)
    run("convert", path, "--to", "modelica", "-o", tmp_path / "Small.mo")
    run("export", path, "-o", tmp_path / "small.fmu")
    inside = (tmp_path / "Small.mo").read_text(encoding="ascii").rstrip()
    end = "end Small;"
    assert inside.endswith(end)
    source = tmp_path / "with-test" / "Small.mo"
    source.parent.mkdir()
    test = "  model Test\n    Assembly whole;\n  equation\n    whole.push_F = 10.0;\n  end Test;\n"
    source.write_text(inside[: -len(end)] + test + end + "\n", encoding="ascii")
    model = rumoca.Session().load(str(source), model="Small.Test")
    stop, step = 4e-3, 1e-4
    result = model.simulate(t=(0, stop), config=rumoca.SimConfig(rtol=1e-11, atol=1e-16, dt=step))
    time = np.array(result["time"])
    expected = simulate_fmu(
        str(tmp_path / "small.fmu"), stop_time=stop, output_interval=step, start_values={"push.F": 10.0},
        fmi_type="CoSimulation",
    )
    places = np.array([np.argmin(abs(time - point)) for point in expected["time"]])
    np.testing.assert_allclose(time[places], expected["time"], rtol=0, atol=1e-12)
    for own, other in [("tip_y", "tip.y"), ("tip_v", "tip.v"), ("root_y", "root.y")]:
        largest = max(abs(expected[other]))
        np.testing.assert_allclose(np.array(result[f"whole.{own}"])[places], expected[other], rtol=0, atol=1e-6 * largest)


def test_other_tools_take_no_assembly(run, tmp_path):
    path = small.write(tmp_path, {})
    done = run("convert", path, "--to", "nastran", "-o", tmp_path / "x.bdf", expect=1)
    assert "an assembly is converted for Modelica alone" in done.stderr


def test_lugre_is_its_differential_equation(convert):
    """The FMU's element takes LuGre's rate at the mean of a step: SciPy is the reference for it."""
    from scipy.integrate import solve_ivp

    bristles = {"stiffness": 1.5e6, "bristle_damping": 30.0, "damping": 25.0}
    slip = {"slip_force": 6.0, "static_force": 8.0, "stribeck_velocity": 2e-3}
    file = law("lugre", **bristles, **slip)
    time, found = in_modelica(convert(file, "modelica", "Bolted.mo"), file)
    amplitude, omega, phase = course(0)

    def motion(t):
        return amplitude * (np.sin(omega * t + phase) - np.sin(phase)), amplitude * omega * np.cos(omega * t + phase)

    def rate(t, z):
        v = motion(t)[1]
        return v - 1.5e6 * np.abs(v) * z / (6.0 + 2.0 * np.exp(-((v / 2e-3) ** 2)))

    z = solve_ivp(rate, (0, STOP), [0.0], "Radau", t_eval=time, rtol=1e-10, atol=1e-16).y[0]
    r, v = motion(time)
    expected = 2e6 * r + 30.0 * v + 1.5e6 * z + 30.0 * rate(time, z) + 25.0 * v
    np.testing.assert_allclose(found["y"], expected, rtol=0, atol=1e-6 * max(abs(expected)))
