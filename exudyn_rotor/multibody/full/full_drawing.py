"""Drawing a full body: its deformed surface, from the displacements of the nodes."""

from __future__ import annotations

from collections.abc import Callable

import exudyn
from exudyn.graphics import FromPointsAndTrigs

from exudyn_rotor.multibody.full.full_plan import FullPlan
from exudyn_rotor.solid.surface import flat_triangles

_KINDS = exudyn.OutputVariableType
_STATE = exudyn.ConfigurationType.Visualization


def surface_drawing(
    plan: FullPlan, rigid: exudyn.NodeIndex, fields: exudyn.NodeIndex
) -> Callable | None:
    """Return Exudyn's graphics function of the rotor's surface; None for a rotor without one.

    Displacements are drawn with the factor ``visualizationSettings.bodies.deformationScaleFactor``.
    """
    rotor, color = plan.selection.source, list(plan.setup.color)
    if not len(rotor.triangles):
        return None
    triangles = flat_triangles(rotor.triangles)

    def drawn(mbs, item):
        factor = mbs.GetSystemContainer().visualizationSettings.bodies.deformationScaleFactor
        c = mbs.GetNodeOutput(fields, _KINDS.Coordinates, _STATE).reshape(-1, 3)
        place = mbs.GetNodeOutput(rigid, _KINDS.Position, _STATE)
        turn = mbs.GetNodeOutput(rigid, _KINDS.RotationMatrix, _STATE).reshape(3, 3)
        points = place + plan.frame.points(rotor.nodes + factor * c) @ turn.T
        return [FromPointsAndTrigs(points, triangles, color)]

    return drawn
