"""Shapes of whirl modes, and of the steady motion under unbalance."""

from __future__ import annotations

from collections.abc import Mapping, Sequence

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.bearings.support import Support
from exudyn_rotor.linear.equations import UnconvergedError
from exudyn_rotor.linear.modal.whirl import WHIRLS, Content, rounded
from exudyn_rotor.linear.model.build import Target, linear_model, warn_of_omissions
from exudyn_rotor.linear.model.linear_model import LinearModel
from exudyn_rotor.linear.over import motions_over, warn_of
from exudyn_rotor.linear.response.loads import Unbalance, unbalance_load
from exudyn_rotor.linear.solve.forced import forced_motions
from exudyn_rotor.pictures.motion_shapes import MotionShapes

_ANGLES = 90  # of a revolution, at which the size of a response is looked up: 0.1 % of an ellipse


def mode_shapes(
    target: Target,
    speed: float,
    *,
    supports: Sequence[Support] = (),
    modes: int = 6,
    stiffening: str = "auto",
    axes: str = "auto",
    tolerance: float = 1e-6,
) -> MotionShapes:
    """Return the shapes of the lowest modes at one spin speed, by frequency seen from outside.

    Parameters
    ----------
    target : ReducedRotor, SolidRotor or linear model of these
        See :func:`linear_model`; a ReducedRotor must have kept its shapes.
    speed : float
        Spin speed [rad/s].
    supports, stiffening, axes, tolerance
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
    >>> from exudyn_rotor import Support, mode_shapes, rotor_example
    >>> rotor = rotor_example()  # two masses of 2 kg on a rod
    >>> supports = [Support(name, 2e4) for name in ("left", "right")]
    >>> mode_shapes(rotor, 50.0, supports=supports, modes=3).frequencies.round(6)
    array([  0., 100., 100.])
    """
    speed = checks.number(speed, "speed", "rad/s")
    count = checks.count(modes, "modes", least=1)
    tolerance = checks.tolerance(tolerance)
    model = _with_mesh(target, supports, stiffening, axes)
    warn_of_omissions(model, what="mode_shapes finds modes")
    motions = motions_over(model, [speed], tolerance=tolerance, warns=False)
    named = Content.of(model).named(motions)
    lost = np.isnan(motions.values)
    named = named.columns(np.lexsort((rounded(named.inertial), lost))[:, : np.sum(~lost)])
    named = named.columns(np.arange(min(count, named.inertial.shape[1]))[None])
    warn_of(model, motions, named.motions)
    values, vectors = named.motions.values[0], named.motions.vectors[0]
    vectors = np.where(values.imag < 0.0, vectors[::-1].conj(), vectors)
    by_order = dict(zip(motions.orders.tolist(), vectors, strict=True))
    orders, motion = _of_nodes(model, by_order, speed)
    return MotionShapes(
        **_surface(model),
        speeds=np.full(len(values), speed),
        labels=tuple(f"mode {i}, {WHIRLS[code]}" for i, code in enumerate(named.codes[0], start=1)),
        rates=np.abs(values.imag),
        frequencies=named.inertial[0],
        orders=orders,
        motion=_unit(motion),
    )


def response_shapes(
    target: Target,
    speeds: ArrayLike,
    unbalances: Sequence[Unbalance] = (),
    *,
    own: bool = True,
    supports: Sequence[Support] = (),
    stiffening: str = "auto",
    axes: str = "auto",
    tolerance: float = 1e-6,
) -> MotionShapes:
    """Return the shapes of the steady motion under unbalance at some spin speeds.

    Each label gives the largest displacement of any node of the mesh.

    Parameters
    ----------
    target : ReducedRotor, SolidRotor or linear model of these
        See :func:`linear_model`; a ReducedRotor must have kept its shapes.
    speeds : array_like, shape (s,)
        Ascending spin speeds above zero [rad/s].
    unbalances, own, supports, stiffening, axes, tolerance
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
    >>> from exudyn_rotor import Support, Unbalance, response_shapes, rotor_example
    >>> rotor = rotor_example()  # two masses of 2 kg on a rod
    >>> supports = [Support(name, 2e4) for name in ("left", "right")]
    >>> heavy = Unbalance("left", 1e-4)
    >>> shape = response_shapes(rotor, [50.0], heavy, supports=supports)
    >>> round(float(shape.displacement(0, 0.0)[0, 0]), 9)  # U Ω² / (k − m Ω²)
    1.6667e-05
    """
    values = checks.ascending_from_zero(speeds, "speeds")
    if values[0] == 0.0:
        raise ValueError("speeds: needs spin speeds above zero, where an unbalance has a load")
    unbalances = checks.instances(unbalances, "unbalances", Unbalance)
    checks.flag(own, "own")
    tolerance = checks.tolerance(tolerance)
    model = _with_mesh(target, supports, stiffening, axes).for_responses
    load, held = unbalance_load(model, unbalances, own), model.held_basis
    loads = {n: values[:, None] ** 2 * F for n, F in load.items()}
    none = np.zeros(len(values))
    stack = model.at_all(values)
    found = forced_motions(stack, loads, none, held=held, tolerance=tolerance)
    orders, motion = _of_nodes(model, {n: X.T for n, X in found.items()}, 1.0)
    if np.any(np.isnan(motion)):
        raise UnconvergedError("response_shapes: there is no steady motion at one of the speeds")
    return MotionShapes(
        **_surface(model),
        speeds=values,
        labels=tuple(f"unbalance, largest {_largest(orders, part):.3g} m" for part in motion),
        rates=np.zeros(len(values)),
        frequencies=values,
        orders=orders,
        motion=motion,
    )


def _largest(orders: np.ndarray, motion: np.ndarray) -> float:
    """Return the largest displacement of a node in a revolution, of harmonics (h, n, 3)."""
    turns = np.exp(1j * np.outer(np.linspace(0.0, 2.0 * np.pi, _ANGLES, endpoint=False), orders))
    each = (np.linalg.norm(np.tensordot(turn, motion, 1).real, axis=1).max() for turn in turns)
    return float(max(each))


def _unit(motion: np.ndarray) -> np.ndarray:
    """Return harmonics (i, h, n, 3) whose largest nodal one has the length one.

    The largest entry is real, so that most of the motion is seen at the time zero.
    """
    flat, lengths = motion.reshape(len(motion), -1), np.linalg.norm(motion, axis=3)
    entry = flat[np.arange(len(flat)), np.abs(flat).argmax(axis=1)]
    scale = np.exp(-1j * np.angle(entry)) / np.maximum(lengths.max(axis=(1, 2)), 1e-300)
    return motion * scale[:, None, None, None]


def _with_mesh(
    target: Target, supports: Sequence[Support], stiffening: str, axes: str
) -> LinearModel:
    model = linear_model(target, supports=supports, stiffening=stiffening, axes=axes)
    if len(model.rotors) > 1 or model.bodies[0].alone.rotor.shapes is None:
        raise ValueError(
            "target: its linear model has no mesh nodes to show; take a single rotor on supports, "
            "reduced with its shapes, and neither a scene nor a RotorTrain"
        )
    return model


def _of_nodes(
    model: LinearModel, motion: Mapping[int, np.ndarray], speed: float
) -> tuple[np.ndarray, np.ndarray]:
    """Return orders (h,) and harmonics (i, h, n, 3) of the nodes in the frame of the rotor.

    Along mesh axes, from those (k, i) of the coordinates of a model.
    """
    body = model.assembly(speed).bodies[0]
    found, parts = {}, body.by_wave(body.alone.rotor.shapes.matrix)  # U exp(−Nθ)
    for m, x in motion.items():
        for wave, U in parts.items():
            if wave == 0 or np.any(U):
                found[m - wave] = found.get(m - wave, 0.0) + U @ x[: body.size]
    orders = sorted(found)
    seen = np.array([found[n].T for n in orders]).swapaxes(0, 1)
    return np.array(orders), seen.reshape(*seen.shape[:2], -1, 3)


def _surface(model: LinearModel) -> dict[str, np.ndarray]:
    rotor = model.bodies[0].alone.rotor
    return {
        "positions": rotor.shapes.nodes,
        "triangles": rotor.shapes.triangles,
        "direction": rotor.axis.direction,
        "point": rotor.axis.point,
    }
