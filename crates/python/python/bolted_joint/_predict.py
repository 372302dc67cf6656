"""`predict`: a joint from surfaces, materials and bolts."""

import tempfile
from pathlib import Path
from typing import Any

from ._command import run
from ._joint import Joint
from ._study import AnyStudy, as_file


class Prediction:
    """What was predicted.

    Attributes
    ----------
    joint : Joint
        The joint.
    details : dict
        All that ``bolted-joint predict --json`` prints.
    report_html : str
        The report. Empty where none was asked for.
    """

    def __init__(self, joint: Joint, details: dict[str, Any], report_html: str):
        self.joint = joint
        self.details = details
        self.report_html = report_html

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
    with as_file(study) as (path, hidden), tempfile.TemporaryDirectory(prefix="bolted-joint-") as folder:
        output, page = Path(folder, "predicted.joint.json"), Path(folder, "report.html")
        arguments = ["predict", path, "-o", str(output)]
        if report:
            arguments += ["--report", str(page)]
        details = run(arguments, hidden)
        return Prediction(Joint.read(output), details, page.read_text(encoding="utf-8") if report else "")
