"""Shapes of whirl modes, and of the steady motion under unbalance."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.bearings.support import Support
from exudyn_rotor.linear import options
from exudyn_rotor.linear.modal.whirl import WHIRLS, WhirlContent
from exudyn_rotor.linear.models.linear_model import (
    Target,
    linear_model,
    warn_of_structural_damping,
)
from exudyn_rotor.linear.models.protocol import LinearModel, Mesh
from exudyn_rotor.linear.response.harmonic_loads import unbalance_load
from exudyn_rotor.linear.response.unbalance import Unbalance
from exudyn_rotor.pictures.motion_shapes import MotionShapes
from exudyn_rotor.sweep import ascending_from_zero

_MODES = 6  # that the subspace of a full rotor begins with
_ANGLES = 90  # of a revolution, at which the size of a response is looked up: 0.1 % of an ellipse


def mode_shapes(
    target: Target,
    speed: float,
    *,
    supports: Sequence[Support] = (),
    modes: int = 6,
    stiffening: str = "auto",
    tolerance: float = 1e-8,
    residual: float = 1e-5,
) -> MotionShapes:
    """Return the shapes of the lowest modes at one spin speed, by frequency seen from outside.

    Parameters
    ----------
    target : ReducedRotor, SolidRotor or linear model of these
        See :func:`linear_model`; a ReducedRotor must have kept its shapes.
    speed : float
        Spin speed [rad/s].
    supports, stiffening, tolerance, residual
        See :func:`campbell`.
    modes : int, optional
        How many; fewer where there are fewer.

    Raises
    ------
    TypeError
        If the target or a support is of another kind.
    ValueError
        If the model has no mesh nodes: a scene, or a rotor reduced without its shapes.

    Examples
    --------
    >>> import numpy as np
    >>> from exudyn_rotor import SolidRotor, Support, mode_shapes
    >>> rod = 1e8 * np.kron([[1, -1], [-1, 1]], np.diag([0.0, 0.0, 1.0]))
    >>> nodes = [[0.0, 0.0, -0.1], [0.0, 0.0, 0.1]]  # two masses of 2 kg on a rod
    >>> rotor = SolidRotor.from_matrices(2.0 * np.eye(6), rod, nodes, "z")
    >>> rotor = rotor.with_interface("left", [0]).with_interface("right", [1])
    >>> supports = [Support(name, 2e4) for name in ("left", "right")]
    >>> mode_shapes(rotor, 50.0, supports=supports, modes=3).frequencies.round(6)
    array([  0., 100., 100.])
    """
    speed = checks.number(speed, "speed", "rad/s")
    count = checks.count(modes, "modes", least=1)
    tolerance = options.accuracy(tolerance, "tolerance")
    residual = options.accuracy(residual, "residual")
    model, mesh = _with_mesh(target, supports, stiffening)
    warn_of_structural_damping(model, "mode_shapes finds modes")
    wanted = min(count, model.size)
    space = model.space(wanted, abs(speed), residual=residual)
    motions = space.modes(speed, tolerance)
    vectors, seen, codes, _ = WhirlContent.of(model).named(motions, speed)
    chosen = np.argsort(seen, kind="stable")[:wanted]
    shapes = vectors[:, :, chosen]
    motion = np.array(
        [_unit(np.array([mesh.columns @ x for x in shapes[:, :, i]])) for i in range(len(chosen))]
    )
    return MotionShapes(
        **_surface(mesh),
        speeds=np.full(len(chosen), speed),
        labels=tuple(f"mode {i + 1}, {WHIRLS[codes[j]]}" for i, j in enumerate(chosen)),
        rates=np.abs(motions.values.imag[chosen]),
        frequencies=seen[chosen],
        orders=motions.orders,
        motion=motion,
    )


def response_shapes(
    target: Target,
    speeds: ArrayLike,
    unbalances: Sequence[Unbalance] = (),
    *,
    own: bool = True,
    supports: Sequence[Support] = (),
    stiffening: str = "auto",
    tolerance: float = 1e-9,
    residual: float = 1e-9,
) -> MotionShapes:
    """Return the shapes of the steady motion under unbalance at some spin speeds.

    Each label gives the largest displacement of any node of the mesh.

    Parameters
    ----------
    target : ReducedRotor, SolidRotor or linear model of these
        See :func:`linear_model`; a ReducedRotor must have kept its shapes.
    speeds : array_like, shape (s,)
        Ascending spin speeds above zero [rad/s].
    unbalances, own, supports, stiffening, tolerance, residual
        See :func:`unbalance_response`.

    Raises
    ------
    TypeError
        If the target, an unbalance or a support is of another kind.
    ValueError
        If the model has no mesh nodes, there is no unbalance, or speeds do not ascend from above
        zero.

    Examples
    --------
    >>> import numpy as np
    >>> from exudyn_rotor import SolidRotor, Support, Unbalance, response_shapes
    >>> rod = 1e8 * np.kron([[1, -1], [-1, 1]], np.diag([0.0, 0.0, 1.0]))
    >>> nodes = [[0.0, 0.0, -0.1], [0.0, 0.0, 0.1]]  # two masses of 2 kg on a rod
    >>> rotor = SolidRotor.from_matrices(2.0 * np.eye(6), rod, nodes, "z")
    >>> rotor = rotor.with_interface("left", [0]).with_interface("right", [1])
    >>> supports = [Support(name, 2e4) for name in ("left", "right")]
    >>> heavy = Unbalance("left", 1e-4)
    >>> shape = response_shapes(rotor, [50.0], heavy, supports=supports)
    >>> round(float(shape.displacement(0, 0.0)[0, 0]), 9)  # U Ω² / (k − m Ω²)
    1.6667e-05
    """
    values = ascending_from_zero(speeds, "speeds")
    if values[0] == 0.0:
        raise ValueError("speeds: needs spin speeds above zero, where an unbalance has a load")
    unbalances = checks.instances(unbalances, "unbalances", Unbalance)
    checks.flag(own, "own")
    tolerance = options.accuracy(tolerance, "tolerance")
    residual = options.accuracy(residual, "residual")
    model, mesh = _with_mesh(target, supports, stiffening)
    load = unbalance_load(model, unbalances, own)
    space = model.space(_MODES, values[-1], loads=[load], residual=residual)
    motions = [
        space.steady_motion(speed, {0: speed**2 * load + 0j}, 0.0, tolerance) for speed in values
    ]
    orders = np.array(sorted({n for motion in motions for n in motion}))
    zero = np.zeros(model.size, dtype=complex)
    motion = np.array(
        [[mesh.columns @ found.get(n, zero) for n in orders] for found in motions], dtype=complex
    )
    return MotionShapes(
        **_surface(mesh),
        speeds=values,
        labels=tuple(f"unbalance, largest {_largest(orders, part):.3g} m" for part in motion),
        rates=np.zeros(len(values)),
        frequencies=values,
        orders=orders,
        motion=motion,
    )


def _largest(orders: np.ndarray, motion: np.ndarray) -> float:
    """Return the largest displacement of a node in a revolution, of harmonics (h, 3n)."""
    turns = np.exp(1j * np.outer(np.linspace(0.0, 2.0 * np.pi, _ANGLES, endpoint=False), orders))
    each = (np.linalg.norm((turn @ motion).real.reshape(-1, 3), axis=1).max() for turn in turns)
    return float(max(each))


def _unit(motion: np.ndarray) -> np.ndarray:
    """Return harmonics (h, 3n) whose largest nodal one has the length one.

    The largest entry is real, so that most of the motion is seen at the time zero.
    """
    largest = np.linalg.norm(motion.reshape(len(motion), -1, 3), axis=2).max() or 1.0
    entry = motion.ravel()[np.argmax(np.abs(motion))]
    return motion * np.exp(-1j * np.angle(entry)) / largest


def _with_mesh(
    target: Target, supports: Sequence[Support], stiffening: str
) -> tuple[LinearModel, Mesh]:
    model = linear_model(target, supports=supports, stiffening=stiffening)
    if model.mesh is None:
        raise ValueError(
            "target: its linear model has no mesh nodes to show; take a rotor on supports, reduced "
            "with keep_shapes=True, and not a scene"
        )
    return model, model.mesh


def _surface(mesh: Mesh) -> dict[str, np.ndarray]:
    return {
        "positions": mesh.nodes,
        "triangles": mesh.triangles,
        "direction": mesh.axis.direction,
        "point": mesh.axis.point,
    }
