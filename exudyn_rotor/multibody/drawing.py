"""Pictures of a scene without a display, by Exudyn's ray tracer."""

from __future__ import annotations

from os import PathLike, fspath

import exudyn
import numpy as np
from exudyn import interactive


def draw_scene(
    SC: exudyn.SystemContainer,
    path: str | PathLike,
    *,
    deformation_scale: float = 1.0,
    contour: exudyn.OutputVariableType | None = None,
    view: np.ndarray | None = None,
    size: tuple[int, int] = (1400, 900),
) -> None:
    """Draw the current state of all systems in `SC`.

    Parameters
    ----------
    SC : exudyn.SystemContainer
    path : path-like
        PNG file to write.
    deformation_scale : float
        Factor on the local displacements of flexible bodies.
    contour : exudyn.OutputVariableType, optional
        Quantity shown as colours on flexible bodies, e.g. ``DisplacementLocal``.
    view : ndarray, shape (3, 3), optional
        Rotation of the view; Exudyn's setting by default.
    size : tuple of int
        Width and height in pixels.
    """
    settings = SC.visualizationSettings
    settings.bodies.deformationScaleFactor = deformation_scale
    settings.contour.outputVariable = contour or exudyn.OutputVariableType._None
    settings.contour.outputVariableComponent = -1
    settings.nodes.show = False
    interactive.ShowImage(
        SC, size=list(size), modelRotation=view, show=False, fileName=fspath(path)
    )
