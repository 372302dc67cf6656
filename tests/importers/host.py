"""A host in a process of its own: tries damaged FMUs, after each of them runs a sound one, and is silent itself.

Reads a JSON object: the folder of a `sound` FMU, the file to write the `result` to, and `tasks`: for each case the
`folder` of an FMU, perhaps with another `token` or other `resources`.
"""

import ctypes
import json
import pathlib
import sys

from instances import Slave

MESSAGES = []


class Visitor(Slave):
    """Keeps the messages also where there is no instance, and may come with a token of its own."""

    def __init__(self, folder, token=None, resources=None):
        self.token = token
        super().__init__(folder, resources=resources)

    def instantiate(self):
        if self.token is not None:
            self.fmu.guid = self.token
        super().instantiate()

    def log(self, environment, status, category, message):
        MESSAGES.append((status, category.decode(), message.decode()))


def obey_permissions():
    """Gives up the superuser's right to read and write everything; nothing changes for other users."""
    if not sys.platform.startswith("linux"):
        return
    version_3 = 0x20080522
    header = (ctypes.c_uint32 * 2)(version_3, 0)
    no_capabilities = (ctypes.c_uint32 * 6)()
    if ctypes.CDLL(None).capset(header, no_capabilities) != 0:
        raise OSError("capset")


def try_to_instantiate(task):
    resources = task.get("resources")
    try:
        instance = Visitor(task["folder"], task.get("token"), resources.encode() if resources else None)
    except Exception as error:
        # FMPy says this, whatever the reason
        assert str(error).startswith("Failed to instantiate"), error
        return False
    use(instance)
    return True


def use(instance):
    """A short simulation, with wrong calls in its middle."""
    instance.initialise(**{"a.y": 1e-5})
    instance.step(0.0, 1e-3)
    before = instance.get("a.y")
    for time, size in ((5.0, 1e-3), (1e-3, -1.0), (1e-3, float("nan"))):
        try:
            instance.step(time, size)
        except Exception:
            continue
        raise AssertionError(f"a step of {size} s from {time} s was accepted")
    instance.step(1e-3, 1e-3)
    assert instance.get("a.y") != before
    instance.close()


def main():
    job = json.load(sys.stdin)
    obey_permissions()
    found = {}
    for case, task in job["tasks"].items():
        MESSAGES.clear()
        instantiated = try_to_instantiate(task)
        found[case] = {"instantiated": instantiated, "messages": list(MESSAGES)}
        use(Visitor(job["sound"]))
        found[case]["sound one ran"] = True
    pathlib.Path(job["result"]).write_text(json.dumps(found))


main()
