"""Loops of load over displacement: what a joint with friction is drawn as."""

from typing import TYPE_CHECKING

from ._respond import Response, respond

if TYPE_CHECKING:
    from ._joint import Joint

#: Amplitudes of the loops of a joint that slips, in parts of that at which its spring alone has the slip force.
_AMPLITUDES = (0.5, 1.0, 2.0)


def loops_of(joint: "Joint") -> Response | None:
    """Loops of the first law that says where it slips, at each of the joint's preloads; none where no law says it."""
    laws = [law for _, law in joint._friction() if "slip_force" in law and law.get("stiffness")]
    if not laws:
        return None
    # the last one of a joint over the preload is that at its highest preload, which slips last
    law = laws[-1] if joint.preloads else laws[0]
    slip = law["slip_force"] / law["stiffness"]
    motion = f"relative.{law['dof']}"
    joints = [joint.at_preload(preload) for preload in joint.preloads] or [joint]
    loops = respond(
        {
            "method": "respond",
            "kind": "hysteresis",
            "name": joint.name,
            "motions": [motion],
            "lap": [{"name": own.name, "joint": own} for own in joints] if joint.preloads else [{"joint": joint}],
            "response": {"of": motion, "amplitude": [part * slip for part in _AMPLITUDES]},
        }
    )
    assert isinstance(loops, Response)
    return loops
