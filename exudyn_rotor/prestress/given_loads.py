"""Static loads that are given, and the supports that take them and the centrifugal load up.

The supports hold mean motions of interfaces with springs
(:class:`exudyn_rotor.solvers.constrained.ConstrainedInverse`). The forces are dead loads: they keep
their direction where the rotor tilts. A torque, spread as tangential forces around an interface, is
so a semi-tangential one, half-way between a torque that keeps its axis and one that turns with the
shaft; only its stiffness is symmetric.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from typing import Any

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.solid.rotor import FiniteElementRotor
from exudyn_rotor.solvers.constrained import ConstrainedInverse
from exudyn_rotor.solvers.inertia_relief import InertiaRelief
from exudyn_rotor.theory.rotating_axes import axes_of

Loads = Mapping[str | int, ArrayLike] | ArrayLike
Spring = Any  # a Support, of the layer above


_HELD = 1e-9  # of the largest: a rigid motion that the supports hold
_UNBALANCED = 1e-6  # share of a load that nothing takes up
_UNEVEN = 0.1  # share of a torque that pulls a plane of the interface, and not all around
_ROUNDING = 1e-9  # of a moment: part across the axis
_STEPS, _SEED = 20, 3  # of the iteration on the buckling load


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


class HeldRotor:
    """Static solutions of a rotor on supports; parameters as of :meth:`SolidRotor.prestress`.

    `free` (3n, f) are the rigid motions that nothing holds.
    """

    def __init__(
        self, rotor: FiniteElementRotor, supports: Sequence[Spring] | Spring, relief: InertiaRelief
    ) -> None:
        self._rotor, self._relief = rotor, relief
        rows, springs = _springs(rotor, supports)
        self._stiffness = rotor.stiffness + rows.T @ sp.diags_array(springs) @ rows
        _, sizes, turned = np.linalg.svd(rows @ relief.rigid)
        count = np.count_nonzero(sizes > _HELD * sizes.max(initial=0.0))
        held, self.free = np.split(relief.rigid @ turned.T, [count], axis=1)
        self._inverse: InertiaRelief | ConstrainedInverse = relief
        if springs.size:
            self._inverse = ConstrainedInverse(relief, rows, 1.0 / springs, held)

    def reactions(self, load: np.ndarray) -> np.ndarray:
        """Return the forces of the supports under a load, both (3n,)."""
        if self._inverse is self._relief:
            return np.zeros_like(load)
        return self._inverse.reactions(load)

    def check_balanced(self, load: np.ndarray, forces: np.ndarray) -> None:
        """Refuse loads that supports, by their `forces` (3n,), do not take up."""
        rotor, rigid, total = self._rotor, self._relief.rigid, (load + forces).reshape(-1, 3)
        size = np.abs(rigid).T @ np.abs(load)
        if np.any(np.abs(rigid.T @ total.ravel()) > _UNBALANCED * np.maximum(size, 1e-300)):
            force = total.sum(axis=0)
            moment = np.cross(rotor.nodes - rotor.axis.point, total).sum(axis=0)
            raise ValueError(
                f"loads: nothing takes up the force {force.round(6).tolist()} N and the moment "
                f"{moment.round(6).tolist()} N m about a point of the axis; give the other loads, "
                "or supports=[Support(…)] that hold it (a 3 × 3 stiffness acts along the axis, too)"
            )

    def buckling_shares(self, geometric: sp.csr_array) -> np.ndarray:
        """Return shares of the buckling load, ascending, of the loads of a stiffness K_G.

        They are μ in ``−K_G v = μ K v`` with the stiffness K on the supports; a tension has
        negative ones. On rigid motions a that nothing holds, K_G decides alone: dead loads that
        press a free shaft turn it over, however small they are, and supports that come later must
        prevent that. There the work ``½ (v + Ra)ᵀ K_G (v + Ra)`` is taken where it is stationary
        in a: the shaft is hinged where the loads act, and its buckling load is Euler's.
        """
        forces = geometric @ self.free
        block = self.free.T @ forces
        terms = np.abs(self.free).T @ (abs(geometric) @ np.abs(self.free))
        values, turn = np.linalg.eigh(0.5 * (block + block.T))
        felt = np.abs(values) > _HELD * terms.max(initial=0.0)
        columns = forces @ turn[:, felt]

        def load(motion: np.ndarray) -> np.ndarray:
            return columns @ ((columns.T @ motion) / values[felt]) - geometric @ motion

        def size(motion: np.ndarray) -> float:
            return np.sqrt(max(motion @ (self._stiffness @ motion), 0.0))

        start = np.random.default_rng(_SEED).standard_normal(geometric.shape[0])
        basis = loads = np.zeros((start.size, 0))
        new = self._inverse.solve(start)
        for _ in range(_STEPS):
            whole = size(new)
            for _ in range(2):  # one pass loses orthogonality
                new = new - basis @ (basis.T @ (self._stiffness @ new))
            if size(new) <= _HELD * whole:
                break
            new = new / size(new)
            basis, loads = np.column_stack([basis, new]), np.column_stack([loads, load(new)])
            new = self._inverse.solve(loads[:, -1])
        return np.linalg.eigvalsh(basis.T @ loads)


def _springs(
    rotor: FiniteElementRotor, supports: Sequence[Spring] | Spring
) -> tuple[sp.csr_array, np.ndarray]:
    """Return motions (m, 3n) of interfaces, and the stiffness of springs that hold them (m,)."""
    listed = [supports] if hasattr(supports, "matrices") else supports
    axes = np.kron(np.eye(2), axes_of(rotor.axis))
    rows, stiffness = [sp.csr_array((0, rotor.nodes.size))], []
    for one in checks.items(listed, "supports", "a Support or a sequence of them"):
        if not (hasattr(one, "matrices") and hasattr(one, "stiffness_varies")):
            raise TypeError(f"supports: needs objects of kind Support, got {checks.shown(one)}")
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
