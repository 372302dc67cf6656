"""`predict`: a joint from surfaces, materials and bolts."""

import os
import tempfile
from pathlib import Path
from typing import TYPE_CHECKING, Any

from ._command import in_page, run
from ._joint import Joint
from ._respond import Response, respond
from ._study import AnyStudy, as_file

if TYPE_CHECKING:
    from matplotlib.figure import Figure

#: Amplitudes of the loops of a joint that slips, in parts of that at which its spring alone has the slip force.
_LOOPS = (0.5, 1.0, 2.0)


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

    def plot(self, **options: Any) -> "Figure":
        """Draws what was predicted.

        Of a layered beam that is damping over the amplitude; of an interface that slips, loops of load over
        displacement; else K + iωC over frequency, at each preload of a joint over the preload (see
        `bolted_joint._plot.joints` for `options`).
        """
        from . import _plot

        if "result" in self.details:
            return _plot.damping_over_amplitude(self.details["result"], **options)
        laws = self.joint.data["joint"].get("friction", [])
        if laws and not self.joint.preloads:
            return _plot.response(self._loops(laws[0]), "load", f"relative.{laws[0]['dof']}", **options)
        return self.joint.plot(**options)

    def _loops(self, law: dict[str, Any]) -> Response:
        slip = law["slip_force"] / law["stiffness"]
        motion = f"relative.{law['dof']}"
        loops = respond(
            {
                "method": "respond",
                "kind": "hysteresis",
                "name": self.joint.name,
                "motions": [motion],
                "lap": [{"joint": self.joint}],
                "response": {"of": motion, "amplitude": [part * slip for part in _LOOPS]},
            }
        )
        assert isinstance(loops, Response)
        return loops

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
        html = in_page(page.read_text(encoding="utf-8"), shown) if report else ""
        return Prediction(Joint.read(output), details, html)
