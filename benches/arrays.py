"""What an identification costs in Python: from arrays, from files, and in memory over many.

    python benches/arrays.py [identifications in the loop, 1000]

Needs the module `bolted_joint`. Times are processor times of the whole process, which other work on the machine disturbs
least, and the least of many: arrays and files take turns.
"""

import os
import subprocess
import sys
import tempfile
import time
from pathlib import Path

import bolted_joint

TURNS = 25


def least(works):
    """The least processor time of each work, s."""
    times = {name: [] for name in works}
    for _ in range(TURNS):
        for name, work in works.items():
            begun = time.process_time()
            work()
            times[name].append(time.process_time() - begun)
    return {name: min(own) for name, own in times.items()}


def resident_bytes():
    """Memory of this process that is in use."""
    return int(Path("/proc/self/statm").read_text().split()[1]) * os.sysconf("SC_PAGE_SIZE")


def main():
    loops = int(sys.argv[1]) if len(sys.argv) > 1 else 1000
    with tempfile.TemporaryDirectory() as name:
        demo = Path(name)
        subprocess.run([sys.executable, "-m", "bolted_joint", "demo", "-o", demo], check=True, capture_output=True)
        functions = bolted_joint.read(demo / "assembly.uff")
        functions.save(demo / "assembly.npz")
        of_arrays = bolted_joint.Study.read(demo / "study.toml")
        of_archive, of_universal = (bolted_joint.Study(of_arrays, demo) for _ in range(2))
        si = {"length": "m", "force": "N"}
        of_archive["assembly"] = {**of_arrays["assembly"], "frf": "assembly.npz", "units": si}
        of_arrays["assembly"] = {**of_arrays["assembly"], "frf": functions}
        for rivals in (True, False):
            times = least(
                {
                    "universal file": lambda: bolted_joint.identify(of_universal, rivals=rivals),
                    "archive": lambda: bolted_joint.identify(of_archive, rivals=rivals),
                    "arrays": lambda: bolted_joint.identify(of_arrays, rivals=rivals),
                }
            )
            told = ", ".join(f"from {what} {1e3 * own:.1f} ms" for what, own in times.items())
            ratios = [times["arrays"] / times[what] - 1.0 for what in ("archive", "universal file")]
            print(
                f"{len(functions)} functions, {len(functions.frequency_hz)} lines, rivals {rivals}: {told}; arrays cost "
                f"{ratios[0]:+.1%} against the archive, {ratios[1]:+.1%} against the universal file"
            )
        lines = slice(None, None, 128)
        of_arrays["assembly"]["frf"] = bolted_joint.Functions(
            functions.frequency_hz[lines], functions.values[lines], functions.responses, functions.references
        )
        for _ in range(100):
            bolted_joint.identify(of_arrays, rivals=False)
        before = resident_bytes()
        for _ in range(loops):
            bolted_joint.identify(of_arrays, rivals=False)
        print(f"{loops} identifications in a loop: {(resident_bytes() - before) / 1024:+.0f} KiB of memory")


if __name__ == "__main__":
    main()
