"""Joints in space: every set of the six degrees of freedom, as element and lap, constant, slipping and over the preload."""

import itertools

import numpy as np
import pytest
from conftest import opener
from instances import Model, Slave, both_versions
from joints import body, changed, joint, over_preload
from loosening import Table
from reference import Joint, Lap

DOFS = ["x", "y", "z", "rx", "ry", "rz"]
RATES = ["vx", "vy", "vz", "wx", "wy", "wz"]
LOADS = ["Fx", "Fy", "Fz", "Mx", "My", "Mz"]
# y alone is a joint in a plane
SETS = [s for n in range(1, 7) for s in itertools.combinations(range(6), n) if s != (1,)]
SIZE = np.array([1e-4] * 3 + [1e-3] * 3)
SPEED = np.array([0.1] * 3 + [1.0] * 3)


def definite(seed, diagonal):
    """A full symmetric matrix without a negative eigenvalue, with about this diagonal."""
    generator = np.random.default_rng(seed)
    mixed = np.eye(6) + 0.3 * generator.normal(size=(6, 6))
    scale = np.sqrt(diagonal)
    full = (mixed @ mixed.T) * np.outer(scale, scale)
    return 0.5 * (full + full.T)


K = definite(1, [2e7, 3e7, 5e7, 4e3, 6e3, 8e3])
C = definite(2, [20.0, 30.0, 50.0, 0.4, 0.6, 0.8])
CUBIC = np.array([1e14, -3e13, 0.0, 2e8, 0.0, -1e8])
BODIES = {
    "a": body([2.0, 2.1, 2.2, 0.01, 0.02, 0.03], [1e6, 2e6, 3e6, 4e3, 5e3, 6e3], [10.0, 20.0, 30.0, 0.1, 0.2, 0.3]),
    "b": body([1.0, 1.1, 1.2, 0.004, 0.005, 0.006], [2e6, 1e6, 1e6, 2e3, 3e3, 1e3], [5.0, 6.0, 7.0, 0.3, 0.2, 0.1]),
}


def part(matrix, rows):
    return np.array(matrix)[np.ix_(rows, rows)].tolist()


def of(rows, bodies=False, **entries):
    rows = list(rows)
    own = {side: {key: [values[i] for i in rows] for key, values in BODIES[side].items()} for side in BODIES}
    dofs = [DOFS[i] for i in rows]
    file = joint(dofs, part(K, rows), part(C, rows), CUBIC[rows].tolist(), own if bodies else None)
    return changed(file, **entries)


@pytest.fixture
def instances(export, tmp_path, fmi):
    """Opens one export for Co-Simulation and for Model Exchange."""
    exported = {}

    def once(file, interface, *options, fmi):
        key = (str(file), interface)
        exported[key] = exported.get(key) or export(file, interface, *options, fmi=fmi)
        return exported[key]

    slaves, models = (opener(once, tmp_path, fmi, kind) for kind in (Slave, Model))
    open_slave, open_model = next(slaves), next(models)
    yield lambda *what: (open_slave(*what), open_model(*what))
    for opened in (slaves, models):
        next(opened, None)


def motions(generator, rows, count):
    for _ in range(count):
        x = generator.normal(size=(2, len(rows))) * SIZE[rows]
        v = generator.normal(size=(2, len(rows))) * SPEED[rows]
        names = [[f"{side}.{kind[i]}" for i in rows] for side in "ab" for kind in (DOFS, RATES)]
        numbers = [x[0], v[0], x[1], v[1]]
        values = {name: value for n, own in zip(names, numbers) for name, value in zip(n, own)}
        yield x[0] - x[1], v[0] - v[1], values


@both_versions
@pytest.mark.parametrize("count", range(1, 7))
def test_every_set_of_degrees_of_freedom(instances, count):
    for rows in (list(s) for s in SETS if len(s) == count):
        law = Joint(of(rows))
        for instance in instances(of(rows), "element"):
            names = [name for name in instance.reference if name[:2] in ("a.", "b.")]
            assert sorted(names) == sorted(f"{s}.{kind[i]}" for s in "ab" for kind in (DOFS, RATES, LOADS) for i in rows)
            instance.initialise()
            if isinstance(instance, Model):
                instance.enter_continuous_time()
            for index, (r, v, values) in enumerate(motions(np.random.default_rng(count), rows, 3)):
                instance.set(values)
                if isinstance(instance, Slave):
                    instance.step(index * 1e-3, 1e-3)
                load = law.load_on_b(r, v)
                scale = np.abs(law.K) @ np.abs(r) + np.abs(law.C) @ np.abs(v) + np.abs(law.k3 * r**3)
                for sign, side in ((-1, "a"), (1, "b"), (1, "joint")):
                    found = np.array(instance.get(*(f"{side}.{LOADS[i]}" for i in rows)))
                    assert (np.abs(found - sign * load) <= 1e-12 * scale).all(), (rows, side)
                found = instance.get("energy.stored", "power.dissipated")
                assert found == pytest.approx([law.energy(r), law.power(r, v)], rel=1e-12)


@pytest.mark.parametrize("rows", [range(6), (0, 2, 4), (1, 3, 4, 5)], ids=["six", "x-z-ry", "y-rx-ry-rz"])
def test_laps_move_as_scipy_says(instances, rows):
    rows = list(rows)
    file = of(rows, bodies=True, cubic=np.abs(CUBIC[rows]).tolist())
    lap, step = Lap(file), 2e-4
    # steps so short that Runge–Kutta's own error is below the tolerance
    slave, model = instances(file, "lap", "--step-size-max", "2e-6")
    loads = np.random.default_rng(3).normal(size=(20, 2 * len(rows))) * np.tile(np.where(np.array(rows) < 3, 1e3, 10), 2)
    inputs = [f"{side}.{LOADS[i]}" for side in "ab" for i in rows]
    names = [f"{side}.{kind[i]}" for kind in (DOFS, RATES) for side in "ab" for i in rows]
    slave.initialise()
    found = [np.zeros(4 * len(rows))]
    for index, load in enumerate(loads):
        slave.set(dict(zip(inputs, load)))
        slave.step(index * step, step)
        found.append(slave.get(*names))
    found, expected = np.array(found), lap.held(np.zeros(4 * len(rows)), loads, step)
    assert (np.abs(found - expected) <= 1e-8 * np.abs(expected).max(axis=0)).all()
    # Model Exchange: rates at one of these points
    model.initialise(**dict(zip(inputs, loads[7])))
    model.enter_continuous_time()
    order = model.states()
    model.set_states([expected[8][names.index(name)] for name in order])
    rates = dict(zip(names, lap.rate(expected[8], loads[7])))
    scale = np.abs(list(rates.values())).max()
    assert model.get_rates() == pytest.approx([rates[name] for name in order], rel=1e-10, abs=1e-12 * scale)


@both_versions
def test_sliders_on_some_of_them(instances, fmi):
    """Jenkins elements on x and on rz: load, heat and slider are those of the return mapping."""
    sliders = {"x": (5e6, 200.0), "rz": (2e3, 1.5)}
    friction = [{"dof": d, "law": "jenkins", "stiffness": k, "slip_force": h} for d, (k, h) in sliders.items()]
    rows = [0, 1, 5]
    file = of(rows, friction=friction, cubic=[0.0] * 3)
    slave, _ = instances(file, "element")
    law, generator = Joint(file), np.random.default_rng(4)
    slave.initialise()
    place, heat = {0: 0.0, 2: 0.0}, 0.0
    path = 4 * np.cumsum(generator.normal(size=(200, 3)), axis=0) / 10 * SIZE[rows]
    for index, r in enumerate(path):
        slave.set({f"a.{DOFS[row]}": value for row, value in zip(rows, r)})
        bristle = np.zeros(3)
        for i, (k, h) in zip((0, 2), sliders.values()):
            bristle[i] = np.clip(k * (r[i] - place[i]), -h, h)
        found = slave.get(*(f"b.{LOADS[i]}" for i in rows))
        assert found == pytest.approx(law.K @ r + bristle, rel=1e-12, abs=1e-9)
        assert slave.get("energy.dissipated")[0] == pytest.approx(heat, rel=1e-12, abs=1e-15)
        slave.step(index * 1e-3, 1e-3)
        for i, (k, h) in zip((0, 2), sliders.values()):
            moved = r[i] - bristle[i] / k
            heat += h * abs(moved - place[i])
            place[i] = moved
    assert heat > 0.1


@both_versions
@pytest.mark.parametrize("rows", [range(6), (0, 4, 5)], ids=["six", "x-ry-rz"])
def test_loosening_in_space(instances, rows):
    rows, preload = list(rows), [2.0, 4.0, 8.0]
    share = [0.4, 0.7, 1.0]
    lists = [[(s * np.array(part(m, rows))).tolist() for s in share] for m in (K, C)]
    cubic = [(s * np.abs(CUBIC[rows])).tolist() for s in share]
    file = over_preload([DOFS[i] for i in rows], preload, 4.0, *lists, cubic, None)
    del file["bodies"]
    table, generator = Table(file), np.random.default_rng(6)
    slave, _ = instances(file, "element")
    slave.initialise()
    for index, (r, v, values) in enumerate(motions(generator, rows, 40)):
        torque = generator.uniform(2.0, 8.0)
        slave.set(values | {"preload": torque})
        matrices = table.at(torque)
        load = matrices[0] @ r + matrices[1] @ v + matrices[2] * r**3
        scale = np.abs(matrices[0]) @ np.abs(r) + np.abs(matrices[1]) @ np.abs(v)
        assert (np.abs(slave.get(*(f"b.{LOADS[i]}" for i in rows)) - load) <= 1e-10 * scale).all()
        assert slave.get("energy.stored") == pytest.approx([table.energy(torque, r)], rel=1e-10)
        slave.step(index * 1e-3, 1e-3)
