"""Tables for notebooks."""

from collections.abc import Iterable, Sequence
from html import escape

from ._command import BoltedJointError


def asked(page: str | None, what: str, argument: str, by: str) -> str:
    """A page that was made where it was asked for.

    Raises
    ------
    BoltedJointError
        Where it was not: with the argument that asks for it.
    """
    if page is None:
        raise BoltedJointError(f"{what}: found none, since none was asked for; {by} it with {argument}=True")
    return page


def table(caption: str, heads: Sequence[str], rows: Iterable[Sequence[str]]) -> str:
    """An HTML table; what it shows is text and is escaped."""
    head = "".join(f"<th>{escape(text)}</th>" for text in heads)
    body = "".join("<tr>" + "".join(f"<td>{escape(cell)}</td>" for cell in row) + "</tr>" for row in rows)
    return f"<table><caption>{escape(caption)}</caption><thead><tr>{head}</tr></thead><tbody>{body}</tbody></table>"


def with_deviation(value: float, deviation: float) -> str:
    """A value with two digits of its deviation in parentheses: ``5.7288(27)e+05``."""
    if not (deviation > 0.0) or value == 0.0:
        return f"{value:.6g}"
    exponent = int(f"{abs(value):e}".rpartition("e")[2])
    of_deviation = int(f"{deviation:.1e}".rpartition("e")[2])
    digits = exponent - of_deviation + 1
    if not 1 <= digits <= 15:
        return f"{value:.6g} ± {deviation:.2g}"
    mantissa = f"{value / 10.0**exponent:.{digits}f}"
    last = round(deviation / 10.0 ** (of_deviation - 1))
    return f"{mantissa}({last})e{exponent:+03d}"
