"""Table of mistakes for docs/systematic-errors.md: `python tests/systematic/table.py [SEEDS]`."""

import os
import pathlib
import sys
import tempfile

import numpy as np
from conftest import identified
from test_budget import CASES
from rig import Mistakes

ROOT = pathlib.Path(__file__).resolve().parents[2]


def main(seeds):
    program = pathlib.Path(os.environ.get("BOLTED_JOINT", ROOT / "target/release/bolted-joint"))
    named, total = {1: 0, 3: 0}, 0
    print("| mistake | noise alone: z | with the budget: z | first named | size that is found | rank |\n|---|---|---|---|---|---|")
    for case, (mistakes, cause, size) in {"none": (Mistakes(), None, 0.0), **CASES}.items():
        plain, careful, first, found, ranks = [], [], [], [], []
        for seed in range(1, seeds + 1):
            with tempfile.TemporaryDirectory() as folder:
                plain.append(abs(identified(program, pathlib.Path(folder), mistakes, seed, 0.01, '"none"').z).max())
                result = identified(program, pathlib.Path(folder), mistakes, seed, 0.01)
            careful.append(abs(result.z).max())
            first.append(result.suspects[0] if result.suspects else "nothing")
            if cause:
                total += 1
                rank = result.suspects.index(cause) + 1 if cause in result.suspects else 99
                ranks.append(rank)
                named[1] += rank == 1
                named[3] += rank <= 3
                if rank < 99:
                    found.append(result.budget["suspects"][rank - 1]["value"] / size)
        print(
            f"| {case} | {np.median(plain):.1f} | {np.median(careful):.1f} | {max(set(first), key=first.count)} "
            f"| {'–' if not found else f'{100 * np.median(found):.0f} %'} | {', '.join(map(str, ranks))} |",
            flush=True,
        )
    print(f"\nfirst {named[1]} of {total}, among the first three {named[3]} of {total}")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 2)
