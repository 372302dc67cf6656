"""`predict`: a joint from surfaces, materials and bolts."""

import os
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ._command import in_page, run
from ._html import asked
from ._joint import Joint
from ._loops import loops_of
from ._study import AnyStudy, as_file

if TYPE_CHECKING:
    from matplotlib.figure import Figure


class Prediction:
    """What was predicted.

    Attributes
    ----------
    joint : Joint
        The joint.
    details : dict
        All that ``bolted-joint predict --json`` prints.
    """

    def __init__(self, joint: Joint, details: dict[str, Any], report_html: str | None):
        self.joint = joint
        self.details = details
        self._report_html = report_html

    @property
    def report_html(self) -> str:
        """The report: one page.

        Raises
        ------
        BoltedJointError
            If none was asked for: ``predict(..., report=True)``.
        """
        return asked(self._report_html, "report_html", "report", "predict and merge make")

    def plot(self) -> "Figure":
        """Draws what was predicted; `Joint.plot` of `joint` has options.

        Of a layered beam that is damping over the amplitude; of an interface that slips, loops of load over
        displacement, at each preload of a joint over the preload; else K + iωC over frequency, likewise.

        Returns
        -------
        matplotlib.figure.Figure
            A figure that pyplot does not keep.
        """
        from . import _plot

        if "result" in self.details:
            return _plot.damping_over_amplitude(self.details["result"])
        loops = loops_of(self.joint)
        return self.joint.plot() if loops is None else _plot.response(loops, "load")

    def __repr__(self) -> str:
        return f"<Prediction: {self.joint!r}>"

    def _repr_html_(self) -> str:
        return self.joint._repr_html_()


def predict(study: AnyStudy, *, report: bool = False) -> Prediction:
    """Predicts a joint before anything is built.

    Parameters
    ----------
    study : path, dict or Study
        Surfaces, materials, bolts and the model to take.
    report : bool
        Whether the report is made too.

    Returns
    -------
    Prediction

    Raises
    ------
    BoltedJointError
        If the study or its files cannot be used.
    """
    with as_file(study) as (path, shown), tempfile.TemporaryDirectory(prefix="bolted-joint-") as folder:
        output, page = Path(folder, "predicted.joint.json"), Path(folder, "report.html")
        arguments = ["predict", path, "-o", str(output)]
        if report:
            arguments += ["--report", str(page)]
        shown |= {str(output): "the joint", folder + os.sep: ""}
        details = run(arguments, shown)
        html = in_page(page.read_text(encoding="utf-8"), shown) if report else None
        return Prediction(Joint.read(output), details, html)
