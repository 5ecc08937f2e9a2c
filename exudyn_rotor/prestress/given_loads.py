"""Static loads that are given, and the supports that take them and the centrifugal load up.

The supports hold mean motions ``B u`` of interfaces with springs k. With the elastic inverse E of
the rotor, inertia relief where it is free, and its rigid motions R, their forces ρ follow from

    (B E Bᵀ + k⁻¹) ρ + B R a = −B E f,    RᵀBᵀ ρ = −Rᵀ f,

the second line on the rigid motions that they hold.

The forces are dead loads: they keep their direction where the rotor tilts. A torque, spread as
tangential forces around an interface, is so a semi-tangential one, half-way between a torque that
keeps its axis and one that turns with the shaft; only its stiffness is symmetric.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Protocol

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.solid.rotor import FiniteElementRotor
from exudyn_rotor.solvers.inertia_relief import InertiaRelief
from exudyn_rotor.theory.rotating_axes import axes_of

Loads = Mapping[str | int, ArrayLike] | ArrayLike


class Spring(Protocol):
    """What the static solution needs of a :class:`exudyn_rotor.Support`."""

    interface: str
    stiffness_varies: bool

    def matrices(self, speed: float) -> tuple[np.ndarray, np.ndarray]: ...


_HELD = 1e-9  # of the largest: a rigid motion that the supports hold
_UNBALANCED = 1e-6  # share of a load that nothing takes up
_UNEVEN = 0.1  # share of a torque that pulls a plane of the interface, and not all around
_ROUNDING = 1e-9  # of a moment: part across the axis


def nodal_loads(rotor: FiniteElementRotor, loads: Loads) -> np.ndarray:
    """Return given loads as nodal forces, shape (3n,) [N]; see :meth:`SolidRotor.prestress`."""
    if not isinstance(loads, Mapping):
        return checks.array(loads, "loads", "N", shape=(rotor.node_count, 3)).ravel().copy()
    total = np.zeros(rotor.nodes.size)
    for key, value in loads.items():
        name = f"loads[{key!r}]"
        load = checks.vector(value, name, "N", size=None)
        if len(load) not in (3, 6):
            raise ValueError(f"{name}: needs 3 or 6 numbers [N], [N m], got {checks.shown(value)}")
        force, moment = load[:3], np.r_[load[3:], np.zeros(6 - len(load))]
        if not isinstance(key, str):
            node = checks.count(key, "loads: a node", most=rotor.node_count - 1)
            if np.any(moment):
                raise ValueError(f"{name}: a mesh node has no rotation; use an interface")
            total[3 * node : 3 * node + 3] += force
            continue
        checks.labels(key, "loads", rotor.interfaces)
        motion = rotor.interfaces[key].mean_motion(rotor.node_count)
        total += motion.T @ np.r_[force, np.zeros(3)]
        if np.any(moment):
            total += _torque(rotor, key, motion, moment)
    return total


def _torque(
    rotor: FiniteElementRotor, key: str, motion: sp.csr_array, moment: np.ndarray
) -> np.ndarray:
    """Return the nodal forces (3n,) of a torque about the axis."""
    e = rotor.axis.direction
    if np.linalg.norm(moment - e * (e @ moment)) > _ROUNDING * np.linalg.norm(moment):
        raise ValueError(
            f"loads[{key!r}]: a moment across the axis has no symmetric stiffness as a torque has; "
            "give it as forces at nodes, whose directions are kept"
        )
    forces = motion.T @ np.r_[np.zeros(3), moment]
    interface = rotor.interfaces[key]
    arms = rotor.nodes[interface.nodes] - interface.center
    spread = arms.T @ forces.reshape(-1, 3)[interface.nodes]
    if np.linalg.norm(spread + spread.T) > 2.0 * _UNEVEN * np.linalg.norm(spread):
        raise ValueError(
            f"loads[{key!r}]: the torque pulls the interface one way more than the other, a quasi-"
            "tangential one; prestress takes semi-tangential torques, alike around the axis: give "
            "an interface all around the shaft"
        )
    return forces


def checked_supports(supports: Sequence[Spring] | Spring) -> tuple[Spring, ...]:
    """Return supports as a tuple; TypeError for anything else than a Support or several."""
    listed = [supports] if hasattr(supports, "matrices") else supports
    found = checks.items(listed, "supports", "a Support or a sequence of them")
    for one in found:
        if not (hasattr(one, "matrices") and hasattr(one, "stiffness_varies")):
            raise TypeError(f"supports: needs objects of kind Support, got {checks.shown(one)}")
    return found


def support_forces(
    rotor: FiniteElementRotor, supports: Sequence[Spring], relief: InertiaRelief, load: np.ndarray
) -> np.ndarray:
    """Return the nodal forces (3n,) by which supports take up a load (3n,)."""
    rows, stiffness = _springs(rotor, supports)
    if not len(stiffness):
        return np.zeros_like(load)
    columns = rows.T.toarray()
    rigid = rows @ relief.rigid
    _, sizes, turned = np.linalg.svd(rigid)
    held = turned[: np.count_nonzero(sizes > _HELD * sizes.max(initial=0.0))].T
    count, few = len(stiffness), held.shape[1]
    A, b = np.zeros((count + few, count + few)), np.zeros(count + few)
    A[:count, :count] = rows @ relief.solve(columns) + np.diag(1.0 / stiffness)
    A[:count, count:] = rigid @ held
    A[count:, :count] = A[:count, count:].T
    b[:count] = -(rows @ relief.solve(load))
    b[count:] = -(held.T @ (relief.rigid.T @ load))
    scale = 1.0 / np.sqrt(np.r_[np.diag(A)[:count], np.ones(few)])
    forces = scale * np.linalg.solve(scale[:, None] * A * scale, scale * b)
    return columns @ forces[:count]


def _springs(
    rotor: FiniteElementRotor, supports: Sequence[Spring]
) -> tuple[sp.csr_array, np.ndarray]:
    """Return motions (m, 3n) of interfaces, and the stiffness of springs that hold them (m,)."""
    axes = np.kron(np.eye(2), axes_of(rotor.axis))
    rows, stiffness = [sp.csr_array((0, rotor.nodes.size))], []
    for one in supports:
        if one.stiffness_varies:
            raise ValueError(
                f"supports: that at {one.interface!r} varies with the speed; the static solution "
                "needs one stiffness, give the support at one speed"
            )
        checks.labels(one.interface, "supports", rotor.interfaces)
        K = one.matrices(0.0)[0]
        values, directions = np.linalg.eigh(0.5 * (K + K.T))
        kept = values > _HELD * values.max(initial=0.0)
        motion = rotor.interfaces[one.interface].mean_motion(rotor.node_count)
        rows.append(sp.csr_array((axes @ directions[:, kept]).T) @ motion)
        stiffness += values[kept].tolist()
    return sp.csr_array(sp.vstack(rows)), np.array(stiffness)


def check_balanced(
    rotor: FiniteElementRotor, relief: InertiaRelief, load: np.ndarray, forces: np.ndarray
) -> None:
    """Refuse loads that supports, by their `forces` (3n,), do not take up."""
    size = np.abs(relief.rigid).T @ np.abs(load)
    left = np.abs(relief.rigid.T @ (load + forces))
    if np.any(left > _UNBALANCED * np.maximum(size, 1e-300)):
        e, total = rotor.axis.direction, (load + forces).reshape(-1, 3).sum(axis=0)
        moment = np.cross(rotor.nodes - rotor.axis.point, (load + forces).reshape(-1, 3)).sum(0)
        raise ValueError(
            f"loads: nothing takes up {e @ total:.4g} N along the axis, "
            f"{np.linalg.norm(total - e * (e @ total)):.4g} N across it, and a torque of "
            f"{e @ moment:.4g} N m; give the other loads, or supports=[Support(…)] that hold it "
            "(a 3 × 3 stiffness acts along the axis, too)"
        )
