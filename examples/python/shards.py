"""A bootstrap, or a Monte Carlo simulation, in parts on a Dask cluster: the same as on one machine, to the bit.

Each worker makes some of the draws; here they are put together. A study of measured functions is identified with a
bootstrap. A study of surfaces, materials and bolts is predicted with the draws of its uncertain values that it states
itself.

    python shards.py study.toml merged.joint.json --draws 2000 --parts 8
    python shards.py ../predict-four-bolts/study.toml merged.joint.json --parts 8

Needs bolted-joint and dask[distributed]. Workers on other machines need the study's files at the same paths.
"""

import argparse

import bolted_joint

#: Methods of studies that predict a joint.
PREDICTIONS = ("fractal-contact", "virtual-material", "layered-beam")
#: Draws of a prediction whose study does not say how many.
DRAWS = 2000


def parts_of(draws, parts):
    """So many draws in so many parts of about the same size."""
    ends = [draws * part // parts for part in range(parts + 1)]
    return [range(first, end) for first, end in zip(ends, ends[1:]) if first < end]


def bootstrap(client, study, draws, parts, seed=1):
    """The identification of a study with a bootstrap that the workers of a cluster share."""
    numbers = parts_of(draws, parts)
    made = client.map(lambda own: bolted_joint.draw(study, own, bootstrap=draws, seed=seed), numbers, pure=False)
    return bolted_joint.merge(study, client.gather(made))


def monte_carlo(client, study, parts):
    """The prediction of a study with uncertain values, whose draws the workers of a cluster share."""
    tables = study if isinstance(study, dict) else bolted_joint.Study.read(study)
    draws = tables.get("uncertainty", {}).get("draws", DRAWS)
    made = client.map(lambda own: bolted_joint.draw(study, own), parts_of(draws, parts), pure=False)
    return bolted_joint.merge(study, client.gather(made))


def main():
    arguments = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    arguments.add_argument("study", help="study of measured functions, or of surfaces, materials and bolts")
    arguments.add_argument("output", help="joint file to write")
    arguments.add_argument("--draws", type=int, default=2000, help="of a bootstrap; a prediction's study has its own")
    arguments.add_argument("--parts", type=int, default=8)
    arguments.add_argument("--scheduler", help="address of a Dask scheduler [default: two workers here]")
    given = arguments.parse_args()

    from dask.distributed import Client

    is_prediction = bolted_joint.Study.read(given.study)["method"] in PREDICTIONS
    with Client(given.scheduler) if given.scheduler else Client(n_workers=2, threads_per_worker=1) as client:
        if is_prediction:
            found = monte_carlo(client, given.study, given.parts)
        else:
            found = bootstrap(client, given.study, given.draws, given.parts)
    found.joint.save(given.output)
    uncertainty = found.joint.data["uncertainty"]
    scatter = uncertainty if is_prediction else uncertainty["bootstrap"]
    draws = "" if is_prediction else f"{scatter['converged']} of {scatter['draws']} draws; "
    print(f"{draws}standard deviation of K: {scatter['standard_deviation']['stiffness']}")


if __name__ == "__main__":
    main()
