"""Points of a rotor by which its motions are told: nodes of the mesh, or rings at interfaces."""

from __future__ import annotations

import numpy as np

from exudyn_rotor.calls import kept
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.theory.invariants import Invariants
from exudyn_rotor.theory.rotating_axes import axes_of

_CORNERS = 8  # points of a ring
ACROSS = np.eye(3)[:, :2]  # a pair along (n1, n2) as a vector


def interface_motion(rotor: ReducedRotor, name: str) -> np.ndarray:
    """Return an interface's displacement and rotation along (n1, n2, e), (6, k), rotor frame."""
    motion = rotor.interfaces[name].motion.reshape(2, 3, -1)
    return (axes_of(rotor.axis).T @ motion).reshape(6, -1)


@kept
def rotor_points(rotor: ReducedRotor, most: int) -> tuple[np.ndarray, np.ndarray]:
    """Return points (s, 3) along (n1, n2, e) and their displacement (3s, k) per coordinate.

    Up to `most` nodes, evenly spread over the node numbers. Of a rotor that was stored without mode
    shapes, points on rings that move with its interfaces.
    """
    axes, shapes = axes_of(rotor.axis), rotor.shapes
    if shapes is None:
        return _rings(rotor, axes)
    count = len(shapes.nodes)
    nodes = np.unique(np.linspace(0, count - 1, min(count, most)).astype(int))
    points = (shapes.nodes[nodes] - rotor.axis.point) @ axes
    motion = shapes.matrix.reshape(count, 3, -1)[nodes]
    return points, np.einsum("ab,sak->sbk", axes, motion).reshape(3 * len(nodes), -1)


def _rings(rotor: ReducedRotor, axes: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    # a point at rest, so that a rotor without any interface has no whirl instead of an error
    points, motion = [np.zeros((1, 3))], [np.zeros((3, rotor.size))]
    angles = 2.0 * np.pi * np.arange(_CORNERS) / _CORNERS
    circle = np.column_stack([np.cos(angles), np.sin(angles), np.zeros(_CORNERS)])
    for name, entry in rotor.interfaces.items():
        U, arms = interface_motion(rotor, name), entry.radius * circle
        points.append((entry.reference - rotor.axis.point) @ axes + arms)
        turning = np.cross(U[3:].T[None], arms[:, None]).transpose(0, 2, 1)
        motion.append((U[:3] + turning).reshape(3 * _CORNERS, -1))
    return np.vstack(points), np.vstack(motion)


def radius_of_gyration(invariants: Invariants) -> float:
    """Return the radius of gyration about the centre of mass [m]."""
    return float(np.sqrt(np.trace(invariants.J) / invariants.mass))
