"""Bolted joints from frequency response functions, and FMUs from joints.

The functions here do what the command line ``bolted-joint`` does, in the same words and to the same bits:

=================  ==================================================================
`read`             a file of functions as arrays
`identify`         a study becomes a joint
`predict`          a joint from surfaces, materials and bolts
`respond`          what a test of the assembly would measure, and how laps and assemblies answer
`draw`             some of the draws of a bootstrap or a Monte Carlo simulation
`merge`            all of them together
`export`           a joint, or an assembly, becomes an FMU
`check`            is a joint file, an FMU or an SSP what it should be
`show`             what is in a file
`compare`          joints beside each other
`convert`          a joint for Nastran, Abaqus, CalculiX, ANSYS, MATLAB or Modelica
`Joint`            a joint file as an object
`Study`            a study file as a dictionary
=================  ==================================================================

All numbers are in SI units without prefixes. Arrays of functions have the frequency axis first.
"""

from importlib.metadata import version as _version

from ._command import BoltedJointError, NotUsableWarning
from ._draws import Draws, draw, merge
from ._fmu import Checked, Fmu, check, export
from ._functions import Functions
from ._identify import Identification, identify
from ._joint import Joint
from ._predict import Prediction, predict
from ._read import read
from ._respond import Plan, Response, respond
from ._show import Comparison, Look, compare, convert, show
from ._study import Study

#: Version of the module, which is that of the command line.
__version__ = _version("bolted-joint")

__all__ = [
    "BoltedJointError",
    "Checked",
    "Comparison",
    "Draws",
    "Fmu",
    "Functions",
    "Identification",
    "Joint",
    "Look",
    "NotUsableWarning",
    "Plan",
    "Prediction",
    "Response",
    "Study",
    "__version__",
    "check",
    "compare",
    "convert",
    "draw",
    "export",
    "identify",
    "merge",
    "predict",
    "read",
    "respond",
    "show",
]
