"""Table of mistakes for docs/set-up-errors.md: `python tests/systematic/table.py [SEEDS [WORDS OF CASES]]`."""

import functools
import os
import pathlib
import sys
import tempfile

import numpy as np
from conftest import identified
from mistakes import CASES, Case
from rig import Mistakes

ROOT = pathlib.Path(__file__).resolve().parents[2]


def main(seeds, words):
    program = pathlib.Path(os.environ.get("BOLTED_JOINT", ROOT / "target/release/bolted-joint"))
    named, said, total = {1: 0, 3: 0}, 0, 0
    print("| mistake | noise alone: z | with the budget: z | first named | size that is found | rank |\n|---|---|---|---|---|---|")
    wanted = {case: of for case, of in CASES.items() if not words or any(word in case for word in words)}
    for case, of in {"none": Case(Mistakes(), "", 0.0), **wanted}.items():
        plain, careful, first, found, ranks, refused = [], [], [], [], [], 0
        for seed in range(1, seeds + 1):
            with tempfile.TemporaryDirectory() as folder:
                run = functools.partial(identified, program, pathlib.Path(folder), of.mistakes, seed, 0.01)
                plain.append(abs(run('"none"', **of.options).z).max())
                result = run(**of.options)
            if result.whole["usable"]:
                careful.append(abs(result.z).max())
            refused += not result.whole["usable"]
            first.append(result.suspects[0] if result.suspects else "nothing")
            if of.cause:
                total += 1
                rank = result.rank(of.cause)
                said += of.cause in result.suspects
                ranks.append(rank)
                named[1] += rank == 1
                named[3] += rank <= 3
                if of.cause in result.suspects:
                    suspect = result.budget["suspects"][result.suspects.index(of.cause)]
                    found.append(suspect["value"] / of.size)
        print(
            f"| {case} | {np.median(plain):.1f} | {np.median(careful or [np.nan]):.1f}{f', {refused} refused' * bool(refused)} "
            f"| {max(set(first), key=first.count)} "
            f"| {'–' if not found else f'{100 * np.median(found):.0f} %'} | {', '.join(map(str, ranks))} |",
            flush=True,
        )
    print(f"\nfirst {named[1]} of {total}, among the first three {named[3]}, said in so many words {said} of {total}")


if __name__ == "__main__":
    main(int(sys.argv[1]) if len(sys.argv) > 1 else 2, sys.argv[2:])
