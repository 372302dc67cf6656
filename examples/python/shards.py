"""A bootstrap in parts on a Dask cluster: the same as on one machine, to the bit.

Each worker identifies the joint and makes some of the draws; here they are put together.

    python shards.py study.toml merged.joint.json --draws 2000 --parts 8

Needs bolted-joint and dask[distributed]. Workers on other machines need the study's files at the same paths.
"""

import argparse

import bolted_joint


def parts_of(draws, parts):
    """So many draws in so many parts of about the same size."""
    ends = [draws * part // parts for part in range(parts + 1)]
    return [range(first, end) for first, end in zip(ends, ends[1:]) if first < end]


def bootstrap(client, study, draws, parts, seed=1):
    """The identification of a study with a bootstrap that the workers of a cluster share."""
    numbers = parts_of(draws, parts)
    made = client.map(lambda own: bolted_joint.draw(study, own, bootstrap=draws, seed=seed), numbers, pure=False)
    return bolted_joint.merge(study, client.gather(made))


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("study", help="study of measured functions")
    arguments.add_argument("output", help="joint file to write")
    arguments.add_argument("--draws", type=int, default=2000)
    arguments.add_argument("--parts", type=int, default=8)
    arguments.add_argument("--scheduler", help="address of a Dask scheduler [default: two workers here]")
    given = arguments.parse_args()

    from dask.distributed import Client

    with Client(given.scheduler) if given.scheduler else Client(n_workers=2, threads_per_worker=1) as client:
        found = bootstrap(client, given.study, given.draws, given.parts)
    found.joint.save(given.output)
    scatter = found.joint.data["uncertainty"]["bootstrap"]
    print(f"{scatter['converged']} of {scatter['draws']} draws; standard deviation of K: {scatter['standard_deviation']['stiffness']}")


if __name__ == "__main__":
    main()
