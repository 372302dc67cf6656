"""Messages of the command line in words of this module: functions and arguments in place of commands and options."""

import re

#: Arguments that have the value of an option.
_ARGUMENTS = {
    "--add": "add",
    "--as": "interface",
    "--bootstrap": "bootstrap",
    "--deviations": "deviations",
    "--draws": "numbers",
    "--first-number": "first_number",
    "--fmi": "fmi",
    "--for": "wanted",
    "--joint": "joint",
    "--level": "noise_level",
    "--nodes": "nodes",
    "--output": "path",
    "--platforms": "platforms",
    "--plot": "page",
    "--preload": "preload_n_m",
    "--report": "report",
    "--rotation-nodes": "rotation_nodes",
    "--samples": "noise_samples",
    "--seed": "seed",
    "--step": "step_hz",
    "--step-error": "step_error",
    "--step-size-max": "step_size_max_s",
    "--to": "tool",
    "--units": "units",
}

#: Arguments that are options without a value.
_SWITCHES = {
    "--allow-active": "allow_active=True",
    "--at-rest": "at_rest=True",
    "--extrapolate": "extrapolate=True",
    "--no-rivals": "rivals=False",
    "--no-run": "run_library=False",
    "--plan": "plan=True",
    "--unusable": "unusable=True",
}

#: A command as texts have it, such as ``bolted-joint show FILE`` or ``respond --plan`` between backticks.
_COMMAND = re.compile(
    r"`(?:bolted-joint )?(?P<name>check|compare|convert|export|identify|merge|predict|respond|show)\b(?P<rest>[^`\n]*)`"
)

#: An option that is no part of a path, what it is said to be, and where that can be said.
_OPTION = re.compile(
    r"(?<![\w/\\.=-])(?P<option>--[a-z][a-z-]*[a-z])(?![\w=-])(?:[ ](?P<value>[0-9][0-9.]*|[A-Z]{2,})\b(?!\.\w))?"
    r"(?P<after>`? at the command line)?(?P<colon>:)?"
)


def in_python(message: str) -> str:
    """A message with the names that its reader gave, or may give."""
    # how the command line is used is of no use here
    message = message.partition("\n\nUsage: ")[0]
    # a part of the draws is made by a function of its own
    message = message.replace(" with --draws", " with `draw`")
    return _OPTION.sub(_argument, _COMMAND.sub(_function, message))


def _function(found: re.Match[str]) -> str:
    options = [_named(one["option"], one["value"]) for one in _OPTION.finditer(found["rest"])]
    # only pictures of responses have a path of their own
    value = "..." if found["name"] == "respond" else "True"
    named = [
        one if "=" in one else f"{one}={value if one == 'report' else '...'}" for one in options if one is not None
    ]
    return f"`{found['name']}(..., {', '.join(named)})`" if named else f"`{found['name']}`"


def _argument(found: re.Match[str]) -> str:
    named = _named(found["option"], found["value"])
    if named is None:
        return found[0]
    after = "`" if (found["after"] or "").startswith("`") else ""
    return f"{named.removesuffix('=True')}{after}:" if found["colon"] else f"{named}{after}"


def _named(option: str, value: str | None) -> str | None:
    """An argument with its value, where an option is one of this module's."""
    if option in _SWITCHES:
        return _SWITCHES[option] if value is None else f"{_SWITCHES[option]} {value}"
    name = _ARGUMENTS.get(option)
    return name if name is None or value is None else f"{name}={value}"
