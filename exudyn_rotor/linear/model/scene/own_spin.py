"""The rotor's own spin in a scene with an elastic drive: a component mode that the scene must hold.

Bearings at an arm ρ from the axis through the centre of mass resist a twist of linear coordinates.
A rotor that turns with its whole steady motion meets no resistance: the bearings' mean forces F,
constant in its frame, have by the displacement of second order ``−½φ²ρ`` the stiffness ``ΣF·ρ``,
which linear coordinates lack and which cancels the former. What is no more than that, and than the
rounding of differences of forces, is no stiffness.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from exudyn_rotor.linear.equations import UnconvergedError
from exudyn_rotor.linear.model.scene.scene_coordinates import SceneCoordinates
from exudyn_rotor.reduction.fields import RIGID_KINDS, ModeKind

_MARGIN = 2.0  # times its estimate that a stiffness may be none


@dataclass(frozen=True, eq=False)
class OwnSpin:
    """The rotor's own spin among the unknowns of a scene, and how the supports see it.

    Attributes
    ----------
    motion : ndarray, shape (k,)
        Of unit modal mass.
    beside : ndarray, shape (k, r)
        The other rigid motions.
    places : ndarray, shape (p, 6, k)
        Motions of the interfaces: displacement and rotation along (n1, n2, e).
    """

    motion: np.ndarray
    beside: np.ndarray
    places: np.ndarray

    @classmethod
    def of(cls, scene: SceneCoordinates, places: Sequence[np.ndarray]) -> OwnSpin | None:
        """Return the own spin of the rotor in a scene; None where it is no unknown."""
        kinds = scene.body.selection.kinds
        if ModeKind.SPIN not in kinds:
            return None
        spin = scene.count + kinds.index(ModeKind.SPIN)
        rigid = [scene.count + i for i, kind in enumerate(kinds) if kind in RIGID_KINDS]
        others = [*range(scene.count), *(i for i in rigid if i != spin)]
        return cls(scene.N[spin], scene.N[others].T, np.array(places))

    def least_stiffness(self, K: np.ndarray, forces: np.ndarray, rounding: float) -> float:
        """Return up to which stiffness [1/s²] a twist is free.

        Parameters
        ----------
        K : ndarray, shape (k, k)
            Mean stiffness.
        forces : ndarray, shape (k,)
            Mean forces of all but the rotor, in its frame.
        rounding : float
            Of the entries of K, relative to the stiffness against rigid motions.
        """
        if not len(self.places):
            return 0.0
        # the smallest forces at the interfaces that act on rigid motions as those of the scene
        acting = (self.places[:, :3] @ self.beside).reshape(-1, self.beside.shape[1])
        at_places = np.linalg.lstsq(acting.T, self.beside.T @ forces)[0].reshape(-1, 3)
        moved = self.places @ self.motion
        bends = np.linalg.norm(moved[:, :2], axis=1) * np.abs(moved[:, 5])
        lacking = np.linalg.norm(at_places[:, :2], axis=1) @ bends
        held = np.abs(np.diagonal(self.beside.T @ K @ self.beside)).max(initial=0.0)
        return float(_MARGIN * lacking + rounding * held)

    def torque(self, orders: np.ndarray) -> np.ndarray:
        """Return a constant torque on the spin as harmonics, shape (h k,)."""
        return np.outer(orders == 0, self.motion).ravel()

    def drive_torque(self, twist: np.ndarray, motion: np.ndarray, least: float) -> complex:
        """Return the torque that keeps the mean spin at zero where nothing else does, else 0.

        From the mean motions (k,) by a unit torque and by all loads, and :meth:`least_stiffness`.
        """
        flexibility = self.motion @ twist
        free = flexibility != 0.0 and 1.0 / np.abs(flexibility) <= least
        return self.motion @ motion / flexibility if free else 0.0

    def check_held(self, torque: complex, most: float, speed: float) -> None:
        """Refuse a torque of more than `most` on a spin that nothing holds."""
        if abs(torque) > most:
            raise UnconvergedError(
                f"linear scene at {speed:g} rad/s: drive='elastic' leaves the rotor's own spin to "
                "the scene, where nothing holds it against the torque of bearings and loads; add a "
                "torsional spring, or take drive='rigid'"
            )
