"""Modes as pyuff writes them (data set 55) are the substructure that they came from."""

import json

import numpy as np
import pyuff
import pytest

# a chain of three masses (kg) on springs (N/m), solved by NumPy: nothing of the program computes here
MASS = np.diag([2.0, 1.0, 0.5])
STIFFNESS = np.array([[9e5, -4e5, 0], [-4e5, 7e5, -3e5], [0, -3e5, 3e5]])
DAMPING_RATIO = np.array([0.01, 0.02, 0.005])
FREQUENCY = np.linspace(20, 300, 141)


def modes():
    """ω (rad/s) and mass-normalised shapes (1/√kg), one in each column."""
    half = np.diag(1 / np.sqrt(np.diag(MASS)))
    squares, vectors = np.linalg.eigh(half @ STIFFNESS @ half)
    return np.sqrt(squares), half @ vectors


def receptance(omega_r, shapes):
    """H = Σ φφᵀ/(ω_r² − ω² + 2jζω_rω), response × reference × line."""
    omega = 2 * np.pi * FREQUENCY
    terms = 1 / (omega_r[:, None] ** 2 - omega**2 + 2j * DAMPING_RATIO[:, None] * omega_r[:, None] * omega)
    return np.einsum("pr,qr,rf->pqf", shapes, shapes, terms)


def units_set(length=1.0, force=1.0, code=9):
    return {
        "type": 164, "units_code": code, "units_description": "units", "temp_mode": 1,
        "length": length, "force": force, "temp": 1.0, "temp_offset": 0.0,
    }


def normal_sets(omega_r, shapes, mass=None, hysteretic=None, changed=None):
    """Data sets 55 of normal modes; motions along Y of nodes 1 to 3."""
    zero = np.zeros(3)
    mass = np.ones(3) if mass is None else mass
    sets = []
    for r in range(3):
        sets.append({
            "type": 55, "analysis_type": 2, "data_ch": 2, "spec_data_type": 8, "data_type": 2, "n_data_per_node": 3,
            "r1": zero, "r2": shapes[:, r], "r3": zero, "node_nums": np.array([1, 2, 3]), "load_case": 0, "mode_n": r + 1,
            "freq": omega_r[r] / 2 / np.pi, "modal_m": mass[r],
            "modal_damp_vis": 0.0 if hysteretic is not None else DAMPING_RATIO[r],
            "modal_damp_his": 0.0 if hysteretic is None else hysteretic[r], "id1": "a chain", **(changed or {}),
        })
    return sets


def written(path, sets):
    pyuff.UFF(str(path)).write_sets(sets, mode="overwrite")
    return path


@pytest.fixture
def functions(run, tmp_path):
    """The receptances that a file of modes gives, through an assembly of it alone."""

    def functions(path):
        text = f"""
name = "the chain alone"
[structures.a]
modal = "{path.name}"
[inputs]
push1 = "a/1:+Y"
push3 = "a/3:+Y"
[outputs]
y2 = "a/2:+Y"
y3 = "a/3:+Y"
[response]
kind = "linear"
from = 20
to = 300
lines = 141
"""
        (tmp_path / "chain.toml").write_text(text, encoding="utf-8")
        done = run("respond", tmp_path / "chain.toml", "-o", tmp_path / "chain.csv")
        table = np.genfromtxt(tmp_path / "chain.csv", delimiter=",", names=True, comments="#", deletechars="")
        return table, done

    return functions


def column(table, response, reference):
    names = [name for name in table.dtype.names if response in name and reference in name]
    assert len(names) == 2, table.dtype.names
    return table[names[0]] + 1j * table[names[1]]


def is_the_chain(table, within):
    exact = receptance(*modes())
    for response, reference in ((2, 1), (3, 3)):
        found = column(table, f"y{response}", f"push{reference}")
        expected = exact[response - 1, reference - 1]
        error = np.max(abs(found - expected)) / np.max(abs(expected))
        assert error < within, error


def test_normal_modes_are_the_chain(functions, run, tmp_path):
    omega_r, shapes = modes()
    path = written(tmp_path / "chain.unv", [units_set(), *normal_sets(omega_r, shapes)])
    table, _ = functions(path)
    # E13.5 keeps six digits of frequencies and shapes; at a resonance of 0.5 % damping that is 1e-4 of the peak
    is_the_chain(table, 5e-4)
    shown = json.loads(run("show", "--json", path).stdout)[0]
    assert shown["kind"] == "modes of a structure"
    assert shown["facts"]["scale"] == ["unit modal masses"] and "data set 164" in shown["facts"]["units"][0]
    assert shown["details"]["points"] == ["1:+Y", "2:+Y", "3:+Y"]
    np.testing.assert_allclose([mode["frequency_hz"] for mode in shown["details"]["modes"]], omega_r / 2 / np.pi, rtol=1e-5)
    assert shown["warnings"] == []
    run("show", path, "--plot", tmp_path / "chain.html")


def test_other_units_masses_and_loss_factors_are_the_same_chain(functions, run, tmp_path):
    omega_r, shapes = modes()
    mass = np.array([3.0, 0.2, 40.0])
    # mm and N: the unit of mass is a tonne, and U/√m of unit tonne is √1000 larger … U √(length/force)/√m is 1/√kg
    in_mm = shapes * np.sqrt(1000) * np.sqrt(mass)
    path = written(tmp_path / "mm.unv", [*normal_sets(omega_r, in_mm, mass, 2 * DAMPING_RATIO), units_set(1000.0, 1.0)])
    table, _ = functions(path)
    is_the_chain(table, 5e-4)
    shown = run("show", path).stdout
    assert "modal masses 0.2 to 40, brought to 1" in shown and "half the loss factor" in shown
    # without units SI is assumed, and said to be
    path = written(tmp_path / "no-units.unv", normal_sets(omega_r, shapes))
    table, done = functions(path)
    is_the_chain(table, 5e-4)
    assert "states no units (data set 164)" in done.stderr
    assert "states no units (data set 164)" in run("show", path).stdout + run("show", path).stderr


def test_a_rigid_body_mode_and_rotations(run, tmp_path):
    sets = normal_sets(np.array([0.0, 600.0, 900.0]), modes()[1])
    sets[0]["modal_damp_vis"] = 0.0
    for one in sets:
        one.update(data_ch=3, n_data_per_node=6, r4=np.zeros(3), r5=np.zeros(3), r6=np.array([0.0, 0.5, 0.0]))
    path = written(tmp_path / "free.unv", [units_set(), *sets])
    shown = json.loads(run("show", "--json", path).stdout)[0]
    assert shown["details"]["points"] == ["1:+Y", "2:+Y", "2:+RZ", "3:+Y"]
    assert shown["details"]["modes"][0]["frequency_hz"] == 0


def complex_sets(poles, shapes, modal_a):
    zero = np.zeros(3, complex)
    return [{
        "type": 55, "analysis_type": 3, "data_ch": 2, "spec_data_type": 8, "data_type": 5, "n_data_per_node": 3,
        "r1": zero, "r2": shapes[:, r], "r3": zero, "node_nums": np.array([1, 2, 3]), "load_case": 0, "mode_n": r + 1,
        "eig": poles[r], "modal_a": modal_a[r], "modal_b": -poles[r] * modal_a[r], "id1": "a chain",
    } for r in range(3)]


def test_complex_modes_scaled_by_modal_a(functions, run, tmp_path):
    """Real modes in the dress of complex ones, turned and scaled at will: modal A takes all of it back."""
    omega_r, shapes = modes()
    damped = omega_r * np.sqrt(1 - DAMPING_RATIO**2)
    poles = -DAMPING_RATIO * omega_r + 1j * damped
    turn = np.array([2 * np.exp(0.7j), 0.1 * np.exp(-2j), 1j])
    path = written(tmp_path / "complex.unv", [units_set(), *complex_sets(poles, shapes * turn, 2j * damped * turn**2)])
    table, _ = functions(path)
    is_the_chain(table, 5e-4)
    assert "complex modes, scaled by modal A" in run("show", path).stdout
    # truly complex shapes are no structure in time, and said not to be
    phases = np.exp(1j * np.array([0.0, 0.8, -0.5]))[:, None]
    written(path, [units_set(), *complex_sets(poles, shapes * phases, 2j * damped)])
    with pytest.raises(AssertionError, match="whose shape is complex.*fit real modes"):
        functions(path)
    assert "shapes" in run("show", path).stdout


def test_identification_takes_modes_of_a_universal_file(demo, study):
    """The demo's substructure A, written again by pyuff, tells the same joint to the six digits of the format."""
    import tomllib

    expected, _ = study()
    model = tomllib.loads((demo.folder / "a-modes.toml").read_text(encoding="utf-8"))
    nodes = np.array([int(point.split(":")[0]) for point in model["points"]])
    assert all(point.endswith(":+Y") for point in model["points"])
    sets = [units_set()]
    for number, mode in enumerate(model["mode"], 1):
        zeta, omega_r = mode["damping_ratio"], 2 * np.pi * mode["frequency_hz"]
        damped = omega_r * np.sqrt(1 - zeta**2)
        shape = np.array([complex(*part) for part in mode["shape"]])
        sets.append({
            "type": 55, "analysis_type": 3, "data_ch": 2, "spec_data_type": 8, "data_type": 5, "n_data_per_node": 3,
            "r1": 0 * shape, "r2": shape, "r3": 0 * shape, "node_nums": nodes, "load_case": 0, "mode_n": number,
            "eig": -zeta * omega_r + 1j * damped, "modal_a": 2j * damped, "modal_b": 0j, "id1": "Tol",
        })
    written(study.folder / "a.unv", sets)
    text = (study.folder / "a-modes.toml").read_text(encoding="utf-8")
    # data set 55 has no residuals
    (study.folder / "a-modes.toml").write_text(text[: text.index("[[residual]]")], encoding="utf-8")
    without_residuals, _ = study()
    own = (study.folder / "study.toml").read_text(encoding="utf-8")
    assert 'modal = "a-modes.toml"' in own
    study.replace = ('modal = "a-modes.toml"', 'modal = "a.unv"')
    found, _ = study()
    np.testing.assert_allclose(found["joint"]["stiffness"], without_residuals["joint"]["stiffness"], rtol=1e-3)
    assert found["joint"]["stiffness"] != expected["joint"]["stiffness"]
    assert "a.unv" in [one["file"] for one in found["provenance"]["inputs"]]


def test_bad_modes_are_refused(run, tmp_path):
    omega_r, shapes = modes()
    path = tmp_path / "bad.unv"

    def refused(sets, *said):
        written(path, sets)
        done = run("show", path, expect=1)
        for part in ("bad.unv", *said):
            assert part in done.stderr, done.stderr

    def change(**changed):
        return normal_sets(omega_r, shapes, changed=changed)

    refused(change(modal_m=0.0), "mode 1 (line 1) with the modal mass 0", "above zero")
    refused(change(modal_damp_vis=0.01, modal_damp_his=0.5), "damping ratio 0.01 and loss factor 0.5", "one of them")
    refused(change(modal_damp_vis=2.0), "damping_ratio: found 2", "not per cent")
    refused(change(freq=-3.0), "frequency_hz: found -3")
    refused(change(spec_data_type=12), "line 8", "shapes of velocity or acceleration", "displacement")
    refused(change(data_ch=1), "data characteristic 1 with 3 values")
    refused(change(node_nums=np.array([1, 1, 3])), "node 1 twice")
    sets = normal_sets(omega_r, shapes)
    sets[1]["node_nums"] = np.array([1, 2, 4])
    refused(sets, "mode 2", "not the 3 of the first mode", "same nodes")
    text = written(path, normal_sets(omega_r, shapes)).read_text(encoding="utf-8")
    header = "         1         2         2         8         2         3"
    assert text.count(header) == 3
    for bad, said in [
        # statics, which pyuff does not write
        (text.replace(header, header.replace("         1         2", "         1         1")), "3 of other data at nodes"),
        (text.replace(header, header.replace("         1         2", "         1         7")), "complex mode of second order"),
        (text.replace(header, header.replace("8         2", "8         4")), "data type 4, expected 2 (real) or 5 (complex)"),
        (text.replace("         2\n", "         x\n", 1), "expected the number of a node"),
        (text[: len(text) // 2], "the file ends inside data set 55"),
        (text.replace("e+00", "e+xx").replace("E+00", "E+xx"), "found"),
        (text.replace("e-0", "e+999").replace("E-0", "E+9"), "found"),
    ]:
        path.write_text(bad, encoding="utf-8")
        done = run("show", path, expect=1)
        assert "bad.unv" in done.stderr and said in done.stderr, done.stderr


def analysis_sets(frequency=None, mass=None, damping=None, shapes=None, poles=None, modal_a=None, rotations=False):
    """Data sets 2414 of modes, normal or with poles; motions along Y of nodes 1 to 3."""
    sets = []
    for r in range(3):
        if poles is None:
            values = np.zeros((3, 6 if rotations else 3))
            values[:, 1] = shapes[:, r]
            record = {"record12_field2": frequency[r], "record12_field3": (2 * np.pi * frequency[r]) ** 2, "record12_field4": mass[r],
                      "record12_field5": damping[r]}
        else:
            values = np.zeros((3, 6))
            values[:, 2], values[:, 3] = shapes[:, r].real, shapes[:, r].imag
            record = {"record13_field1": poles[r].real, "record13_field2": poles[r].imag, "record13_field3": modal_a[r].real,
                      "record13_field4": modal_a[r].imag}
        sets.append({
            "type": 2414, "analysis_dataset_label": r + 1, "analysis_dataset_name": "a chain", "dataset_location": 1,
            "id1": "a chain", "id2": "NONE", "id3": "NONE", "id4": "NONE", "id5": "NONE",
            "model_type": 1, "analysis_type": 2 if poles is None else 3, "data_characteristic": 3 if rotations else 2, "result_type": 8,
            "data_type": 2 if poles is None else 5, "number_of_data_values_for_the_data_component": 6 if rotations else 3,
            "record10_field6": r + 1, **record, "node_nums": np.array([1, 2, 3]), "data_at_node": values.tolist(),
        })
    return sets


@pytest.mark.parametrize("rotations", [False, True])
def test_normal_modes_of_analysis_data_are_the_chain(functions, run, tmp_path, rotations):
    omega_r, shapes = modes()
    mass = np.array([3.0, 0.2, 40.0])
    sets = analysis_sets(omega_r / 2 / np.pi, mass, DAMPING_RATIO, shapes * np.sqrt(mass), rotations=rotations)
    path = written(tmp_path / "chain.unv", [units_set(), *sets])
    table, _ = functions(path)
    is_the_chain(table, 5e-4)
    shown = json.loads(run("show", "--json", path).stdout)[0]
    assert shown["kind"] == "modes of a structure" and shown["details"]["points"] == ["1:+Y", "2:+Y", "3:+Y"]
    assert shown["facts"]["scale"] == ["modal masses 0.2 to 40, brought to 1"]


def test_complex_modes_of_analysis_data_are_the_chain(functions, tmp_path):
    omega_r, shapes = modes()
    damped = omega_r * np.sqrt(1 - DAMPING_RATIO**2)
    turn = np.array([2 * np.exp(0.7j), 0.1 * np.exp(-2j), 1j])
    sets = analysis_sets(shapes=shapes * turn, poles=-DAMPING_RATIO * omega_r + 1j * damped, modal_a=2j * damped * turn**2)
    table, _ = functions(written(tmp_path / "chain.unv", [units_set(), *sets]))
    is_the_chain(table, 5e-4)


@pytest.mark.parametrize(("changed", "said"), [
    ({"dataset_location": 2, "element_nums": np.array([1]), "data_at_element": [[1.0, 2.0, 3.0]]}, "3 of other data at nodes"),
    ({"analysis_type": 7}, "complex mode of second order"),
    ({"result_type": 12}, "velocity or acceleration"),
    ({"data_characteristic": 4}, "data characteristic 4 with 3 values"),
    ({"record12_field4": 0.0}, "modal mass 0"),
])
def test_bad_analysis_data(run, tmp_path, changed, said):
    omega_r, shapes = modes()
    sets = analysis_sets(omega_r / 2 / np.pi, np.ones(3), DAMPING_RATIO, shapes)
    for one in sets:
        one.update(changed)
    path = written(tmp_path / "bad.unv", [units_set(), *sets])
    done = run("show", path, expect=1)
    assert "bad.unv" in done.stderr and said in done.stderr, done.stderr
