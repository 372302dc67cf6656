"""Figures that nobody but their owner keeps, and that a notebook shows once."""

import io

from ._command import BoltedJointError

try:
    from matplotlib.figure import Figure
except ImportError:
    raise BoltedJointError("a figure needs Matplotlib: pip install bolted-joint[plot]") from None


class Picture(Figure):
    """A figure that pyplot knows nothing of: it needs no window, no thread of its own, and nobody to close it."""

    def _repr_png_(self) -> bytes:
        """What a notebook shows where it has no picture of its own for figures."""
        buffer = io.BytesIO()
        self.savefig(buffer, format="png")
        return buffer.getvalue()
