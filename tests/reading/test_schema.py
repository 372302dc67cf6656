"""The schema of studies, held against every study of the project and against studies with mistakes, by `jsonschema`."""

import json
import pathlib
import tomllib

import jsonschema
import pytest

ROOT = pathlib.Path(__file__).resolve().parents[2]
SCHEMA = json.loads((ROOT / "docs/study.schema.json").read_text(encoding="utf-8"))


def studies():
    for folder in ("examples", "tests/data"):
        for path in sorted((ROOT / folder).rglob("*.toml")):
            tables = tomllib.loads(path.read_text(encoding="utf-8"))
            if "method" in tables or "structures" in tables:
                yield pytest.param(tables, id=str(path.relative_to(ROOT)))


ALL = list(studies())


def alternative(tables):
    """The alternative of a study, so that a message is about it alone."""
    for own in SCHEMA["oneOf"]:
        own = {**own, "definitions": SCHEMA.get("definitions", {})}
        if own["properties"].get("method", {}).get("const") == tables.get("method"):
            return own
    raise AssertionError(tables.get("method"))


def test_the_documented_schema_is_the_programs(run):
    assert run("init", "--schema").stdout == (ROOT / "docs/study.schema.json").read_text(encoding="utf-8")


def test_the_schema_is_one():
    jsonschema.Draft7Validator.check_schema(SCHEMA)
    assert len(ALL) > 15


@pytest.mark.parametrize("tables", ALL)
def test_every_study_is_valid(tables):
    jsonschema.validate(tables, alternative(tables), cls=jsonschema.Draft7Validator)
    jsonschema.validate(tables, SCHEMA, cls=jsonschema.Draft7Validator)


@pytest.mark.parametrize("tables", ALL)
def test_a_key_that_there_is_not_is_refused_everywhere(tables):
    """In the study itself, and in each of its tables but those whose keys are names."""

    def places(value, path=()):
        if isinstance(value, dict):
            yield path
            for key, own in value.items():
                yield from places(own, (*path, key))
        elif isinstance(value, list):
            for number, own in enumerate(value):
                yield from places(own, (*path, number))

    validator = jsonschema.Draft7Validator(alternative(tables))
    refused = 0
    for path in places(tables):
        wrong = json.loads(json.dumps(tables))
        inner = wrong
        for step in path:
            inner = inner[step]
        inner["no_such_key"] = None
        assert not validator.is_valid(wrong), path
        refused += 1
    assert refused > 1


@pytest.mark.parametrize("key, value", [
    (("method",), "frf-decopling"), (("joint", "model"), "ful"), (("frequency", "from"), "5 Hz"), (("assembly", "points"), 11),
    (("assembly", "frf"), 5), (("frequency", "every"), 2.5), (("a", "ground"), "yes"), (("b", "beam", "length"), True),
])
def test_wrong_types_and_words_are_refused(key, value):
    tables = tomllib.loads((ROOT / "examples/tol-m10x16/study.toml").read_text(encoding="utf-8"))
    inner = tables
    for step in key[:-1]:
        inner = inner[step]
    inner[key[-1]] = value
    assert not jsonschema.Draft7Validator(SCHEMA).is_valid(tables)


def test_completions_are_there():
    """What an editor offers: keys, words and what a value may be."""
    own = SCHEMA["oneOf"][0]
    method = own["properties"]["method"]
    assert method["const"] == "frf-decoupling" and "joint between two structures" in method["description"]
    text = json.dumps(SCHEMA)
    for word in ("translation", "diagonal", "euler-bernoulli", "points_on_a", "accelerometer_mass", "a standard deviation or"):
        assert word in text, word
