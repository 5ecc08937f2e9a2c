"""What acts on a rotor in a scene and is no support of this package, as one linear element.

Exudyn's forces have derivatives by the unknowns y of a scene. They act on the rotor by its markers:
with their motion and the unknowns beside the rotor, u = B y, is ``K_y = Bᵀ K B``, which tells the
stiffness K. As an element with the motion u it acts on a round rotor as supports do.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.linalg as la

from exudyn_rotor.linear.equations import Terms, UnconvergedError, stacked
from exudyn_rotor.linear.model.assembly import Element, Seen
from exudyn_rotor.linear.model.scene.linear_scene import LinearScene
from exudyn_rotor.linear.model.scene.probe import Probe
from exudyn_rotor.theory.rotating_axes import axial_rotation, axial_skew

ALL = ""  # the point of a body beside the rotor that has all of its coordinates
_ANGLES = (0.0, 1.0)  # rad, at which it has to be the same
# rows of markers, and share of singular values of their motion that counts: the first that do
_TRIED = tuple((rows, least) for rows in (3, 6) for least in (1e-3, 1e-5, 1e-7))
_SAME = 1e-5  # share of a matrix that may change with the angle, or that markers may miss
_ROUNDING = 1e-7  # share of a matrix of Exudyn's differences that is their rounding
State = Callable[[float], tuple[np.ndarray, np.ndarray]]  # of an angle: coordinates and rates


@dataclass(frozen=True, eq=False)
class Foreign:
    """Stiffness and damping between the markers of a rotor and what is beside it.

    Attributes
    ----------
    K, D : ndarray, shape (p, p)
        By `rows` of the motion of each marker, then by the unknowns beside the rotor.
    rows : int
        3 for displacements along (n1, n2, e), 6 for rotations, too.
    places : tuple of str
        Names of the markers.
    """

    K: np.ndarray
    D: np.ndarray
    rows: int
    places: tuple[str, ...]

    @classmethod
    def of(cls, scene: LinearScene, probe: Probe, state: State) -> Foreign:
        """Return what is foreign, about a motion that stands still.

        Raises
        ------
        UnconvergedError
            Where it acts on the rotor by other motions than those of markers, or changes as the
            rotor turns.
        """
        at_angles = [_slopes(scene, probe, theta, state) for theta in _ANGLES]
        _, K_y, D_y = at_angles[0]
        for rows, least in _TRIED:
            B, S, sizes = _motions(scene, rows, 0.0)
            inverse = np.linalg.pinv(sizes[:, None] * B, rcond=least) * sizes
            K, D = (inverse.T @ X @ inverse for X in (K_y, D_y))
            K = K - probe.speed * D @ S
            found = cls(_without_rounding(K), _without_rounding(D), rows, (*scene.foreign_places,))
            if all(found._tells(scene, probe.speed, *each) for each in at_angles):
                return found
        raise UnconvergedError(
            f"linear scene at {probe.speed:g} rad/s: an object acts on the rotor other than by "
            "markers of its body, or otherwise as the rotor turns; let it act at interfaces, "
            "body.marker(name), or add a Support of frame='rotor' in its place"
        )

    def _tells(
        self, scene: LinearScene, speed: float, theta: float, K_y: np.ndarray, D_y: np.ndarray
    ) -> bool:
        """Return whether it has the slopes by the unknowns at an angle."""
        B, S, _ = _motions(scene, self.rows, theta)
        missed = [B.T @ (self.K + speed * self.D @ S) @ B - K_y, B.T @ self.D @ B - D_y]
        stiff, damped, *left = (np.abs(X).max(initial=0.0) for X in (K_y, D_y, *missed))
        return left[0] <= _SAME * (stiff + abs(speed) * damped) and left[1] <= _SAME * damped

    def element(self, kind: str) -> Element:
        """Return the element; an 'undamped' one has gyroscopic terms in place of damping."""
        K, D, rows = self.K, self.D, self.rows
        if kind == "undamped":
            K, D = 0.5 * (K + K.T), 0.5 * (D - D.T)
        ends = [("", name) for name in self.places]
        has_others = len(K) > rows * len(ends)

        def motion(seen: Seen) -> Terms:
            parts = [{n: U[:rows] for n, U in seen(end).items()} for end in ends]
            return stacked([*parts, seen(("scene", ALL))] if has_others else parts)

        return Element(tuple(ends), lambda *_: (K, D), motion, varies=True, stiffness_varies=True)


def _slopes(
    scene: LinearScene, probe: Probe, theta: float, state: State
) -> tuple[float, np.ndarray, np.ndarray]:
    """Return an angle, and stiffness and damping by rotor and others there, (k, k)."""
    T, T1, _ = probe.turn(theta)
    _, K, D = probe.foreign(theta, *state(theta))
    damping = T.T @ D
    chosen = np.r_[np.flatnonzero(scene.touching), scene.others]
    slopes = T.T @ K @ T + probe.speed * damping @ T1, damping @ T
    return theta, *(X[np.ix_(chosen, chosen)] for X in slopes)


def _motions(
    scene: LinearScene, rows: int, theta: float
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return B of ``u = B y`` as seen from outside, S of ``u̇ = B ẏ + Ω S B y``, and sizes of u."""
    turn = np.kron(np.eye(rows // 3), axial_rotation(theta))
    count, beside = len(scene.foreign_places), len(scene.others)
    U = [np.zeros((0, int(scene.touching.sum())))]
    U += [turn @ motion[:rows] for motion in scene.foreign_places.values()]
    none = np.zeros((beside, beside))
    reach = np.repeat([1.0, scene.length], 3)[:rows]
    return (
        la.block_diag(np.vstack(U), np.eye(beside)),
        la.block_diag(axial_skew(rows * count), none),
        np.r_[np.tile(reach, count), np.ones(beside)],
    )


def _without_rounding(X: np.ndarray) -> np.ndarray:
    """Return a matrix of differences without a skew part that is their rounding."""
    symmetric = 0.5 * (X + X.T)
    noise = np.abs(X - symmetric).max(initial=0.0) <= _ROUNDING * np.abs(X).max(initial=0.0)
    return symmetric if noise else X
