"""Pictures of a scene without a display, by Exudyn's ray tracer."""

from __future__ import annotations

import io
from collections.abc import Sequence
from os import PathLike

import exudyn
from exudyn import interactive
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.storage import write_bytes

_LARGEST = 32768  # pixels along an edge


def draw_scene(
    SC: exudyn.SystemContainer,
    path: str | PathLike,
    *,
    deformation_scale: float = 1.0,
    contour: exudyn.OutputVariableType | None = None,
    view: ArrayLike | None = None,
    size: Sequence[int] = (1400, 900),
) -> None:
    """Draw the current state of all systems in `SC`.

    Parameters
    ----------
    SC : exudyn.SystemContainer
    path : path-like
        PNG file to write; one of that name is replaced only by a complete one.
    deformation_scale : float
        Factor on the local displacements of flexible bodies.
    contour : exudyn.OutputVariableType, optional
        Quantity shown as colours on flexible bodies, e.g. ``DisplacementLocal``.
    view : array_like, shape (3, 3), optional
        Rotation of the view; Exudyn's setting by default.
    size : tuple of int
        Width and height in pixels.

    Raises
    ------
    TypeError, ValueError
        For bad input.
    """
    checks.instance(SC, "SC", exudyn.SystemContainer)
    from matplotlib import pyplot

    target = checks.path(path)
    checks.number(deformation_scale, "deformation_scale")
    if contour is not None:
        checks.instance(contour, "contour", exudyn.OutputVariableType)
    if view is not None:
        view = checks.rotation(view, "view")
    width_and_height = checks.whole_numbers(size, "size", least=1, most=_LARGEST).tolist()
    if len(width_and_height) != 2:
        raise ValueError(f"size: needs width and height in pixels, got {checks.shown(size)}")
    settings = SC.visualizationSettings
    settings.bodies.deformationScaleFactor = deformation_scale
    settings.contour.outputVariable = contour or exudyn.OutputVariableType._None
    settings.contour.outputVariableComponent = -1
    settings.nodes.show = False
    image = interactive.ShowImage(SC, size=width_and_height, modelRotation=view, show=False)
    content = io.BytesIO()
    pyplot.imsave(content, image, format="png")
    write_bytes(target, content.getvalue())
