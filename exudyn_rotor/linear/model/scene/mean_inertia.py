"""Mean inertia forces of a rotor in a scene whose own unbalance is left out.

Over a revolution in a steady motion the momentum of a rotor does not change: the mean loads of
bearings carry the weight by the lever rule, as at rest. In linear coordinates an eccentric rotor
lacks the work of its bearings' steady forces ``m e Ω²`` on displacements of second order. By that
the static tilt moves the rotor along the axis, and the thrust bearing has a moment about the
centre of mass. Where unbalance is left out, so are mean forces and moments of the rotor's inertia.
"""

from __future__ import annotations

import numpy as np
from scipy.linalg import block_diag

from exudyn_rotor.linear.model.scene.probe import Probe
from exudyn_rotor.linear.model.scene.searched_scene import Scene
from exudyn_rotor.reduction.mode_kind import RIGID_KINDS
from exudyn_rotor.theory.nodal import skew

_ACROSS = [[0, 1], [3, 4]]  # pairs of translations and rotations among (n1, n2, e)
_HELD = 1e-9  # of a motion that the rotor cannot make


def mean_inertia(scene: Scene, probe: Probe, orders: np.ndarray) -> np.ndarray:
    """Return the loads (h k, h k) by a motion's harmonics that inertia has in the mean.

    None where unbalance is not left out. Only the first harmonics have any.
    """
    loads = np.zeros((len(orders), scene.size, scene.size), dtype=complex)
    if scene.about == "equilibrium":
        mean = _by_first_harmonic(scene, probe)
        loads[orders == 1], loads[orders == -1] = mean, mean.conj()
    return block_diag(*loads)


def _by_first_harmonic(scene: Scene, probe: Probe) -> np.ndarray:
    """Return the loads (k, k) by the first harmonic.

    ``M C (Cᴴ M C)⁻¹ Cᴴ Z``: with the rotor's own mass matrix M and dynamic stiffness Z of the first
    harmonic, in turning axes, and C its rigid motions that stand still in space.
    """
    T, T1, T2 = scene.turn(0.0)
    speed = probe.speed
    M, D, K, _ = probe.rotor_terms(0.0)
    Z = T.T @ (speed**2 * M @ (T2 + 2.0j * T1 - T) + speed * D @ (T1 + 1.0j * T) + K @ T)
    C = _standing(scene)
    MC = T.T @ (M @ (T @ C))
    return MC @ np.linalg.solve(C.conj().T @ MC, C.conj().T @ Z)


def _standing(scene: Scene) -> np.ndarray:
    """Return motions (k, p) whose first harmonic stands still: across the axis, and tilts.

    Tilts are about a point of the axis, which they do not move along it.
    """
    rigid = _rigid_columns(scene)
    moved = _at_axis(scene) @ rigid
    targets = np.eye(6)[:, _ACROSS].transpose(1, 0, 2)
    pairs = []
    for pair in targets:
        found = np.linalg.lstsq(moved, pair)[0]
        if np.abs(moved @ found - pair).max() < _HELD:
            pairs.append(rigid @ found @ [1.0, 1.0j])
    return np.reshape(pairs, (len(pairs), scene.size)).T


def _rigid_columns(scene: Scene) -> np.ndarray:
    """Return the rotor's rigid motions (k, r)."""
    kinds = scene.body.selection.kinds
    rigid = [scene.count + i for i, kind in enumerate(kinds) if kind in RIGID_KINDS]
    return scene.N[[*range(scene.count), *rigid]].T


def _at_axis(scene: Scene) -> np.ndarray:
    """Return displacement and rotation (6, k) by rigid motions at the axis, along (n1, n2, e)."""
    body, inertia = scene.body, scene.body.motion.invariants
    motion = np.zeros((6, len(scene.free)))
    motion[: scene.count, : scene.count] = np.eye(scene.count)
    motion[:3, scene.modal] = scene.axes.T @ inertia.S / inertia.mass
    motion[3:, scene.modal] = scene.axes.T @ inertia.mean_rotation
    offset = body.axis.radial(body.frame.origin + inertia.center)
    motion[:3] += skew(scene.axes.T @ offset) @ motion[3:]  # φ × (−offset)
    return motion @ scene.N
