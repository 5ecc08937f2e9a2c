"""Reynolds' equation on a grid of finite volumes, as a system with a small band.

With the journal's surface at the speed ΩR, the film's equation times R² is

    ∂φ(h³ ∂φ p) + h³ ∂ζζ p = 12 μ R² (Ω/2 ∂φ h + ∂t h),        ζ = z/R                    (1)

p = 0 at the ends ζ = ±L/(2R) and at the pads' edges. Finite volumes in φ and, in ζ, either
finite volumes of the half length, or the one function ``f = 1 − cosh ζ / cosh(L/2R)`` with
Galerkin's condition: exact for small eccentricities of a whole circle, where p ~ sin φ, and in
proportion to the parabola of a short bearing. The thickness depends on φ alone, so both give
``(faces of φ) ⊗ mass + (h³ Δφ) ⊗ stiffness`` with a diagonal mass.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from exudyn_rotor.bearings.film.pads import WHOLE, Pad, direction


@dataclass(frozen=True, eq=False)
class Axial:
    """What the grid is along ζ, of the whole length, by the integrals of each unknown's function f.

    `mass` and `weights` (m,) are ∫ f² dζ and ∫ f dζ, `stiffness` (m, m) is ∫ f' f' dζ, of at most
    three diagonals, `edge` (m,) the slope −∂p/∂ζ at one end; `shapes` (k, m) gives the pressure at
    the `places` ζ (k,) from the middle on.
    """

    mass: np.ndarray
    weights: np.ndarray
    stiffness: np.ndarray
    edge: np.ndarray
    places: np.ndarray
    shapes: np.ndarray

    @classmethod
    def volumes(cls, half: float, count: int) -> Axial:
        """Return finite volumes about two nodes or more from the middle on, the end left out."""
        step = half / count
        width = np.full(count, step)
        width[0] *= 0.5
        slope = np.eye(count, count + 1) - np.eye(count, count + 1, 1)
        stiffness = (slope.T @ slope)[:count, :count] / step
        edge = np.zeros(count)
        edge[-2:] = np.array([-0.5, 2.0]) / step
        places = step * np.arange(count + 1)
        return cls(2 * width, 2 * width, 2 * stiffness, edge, places, np.eye(count + 1, count))

    @classmethod
    def profile(cls, half: float) -> Axial:
        """Return the one function f."""
        places, decayed = np.linspace(0.0, half, 21), np.exp(-2.0 * half)
        edge = np.tanh(half)
        weight = np.array([2.0 * (half - edge)])
        stiffness = edge - 4.0 * half * decayed / (1.0 + decayed) ** 2
        shapes = 1.0 - (np.exp(places - half) + np.exp(-places - half)) / (1.0 + decayed)
        # ∫ f f'' = −∫ f'², and f'' = f − 1
        mass, stiff = weight - stiffness, np.array([[stiffness]])
        return cls(mass, weight, stiff, np.array([edge]), places, shapes[:, None])


class Grid:
    """Nodes of all pads, their neighbours, and the band of the equations.

    Of every node (n,) the `angle` φ, the width `step` of its volume, the index of its `pad`, and
    its neighbours `left` and `right`, −1 at an edge; in the middle, at the left and the right face
    of each volume ``u = (cos φ, sin φ)``, (3, n, 2), and the thickness `offset` about a journal in
    the middle, (3, n) [m].
    """

    def __init__(self, pads: tuple[Pad, ...], nodes: int, axial: Axial) -> None:
        self.pads, self.axial = pads, axial
        self.width = len(axial.mass)
        counts = [max(round(nodes * pad.arc / WHOLE), 4) for pad in pads]
        steps = [pad.arc / count for pad, count in zip(pads, counts, strict=True)]
        inner = [np.arange(1 - pad.closed, n) for pad, n in zip(pads, counts, strict=True)]
        self.pad = np.repeat(np.arange(len(pads)), [len(nodes) for nodes in inner])
        self.step = np.array(steps)[self.pad]
        starts = np.array([pad.start for pad in pads])
        self.angle = starts[self.pad] + np.concatenate(inner) * self.step
        size = len(self.angle)
        self.left, self.right = np.arange(size) - 1, np.arange(size) + 1
        rank = np.arange(size)
        if pads[0].closed:
            self.left[0], self.right[-1] = size - 1, 0
            half = (size + 1) // 2
            rank = np.concatenate([2 * rank[:half], 2 * (size - 1 - rank[half:]) + 1])
        else:
            first = np.flatnonzero(np.diff(self.pad, prepend=-1))
            self.left[first] = -1
            self.right[np.append(first[1:], size) - 1] = -1
        clearance = np.array([pad.clearance for pad in pads])[self.pad]
        center = np.array([pad.center for pad in pads])[self.pad]
        # the middle of the volume and its two faces
        shift = np.array([[0.0], [-0.5], [0.5]])
        self.u = direction(self.angle + shift * self.step)
        self.offset = clearance + np.sum(self.u * center, axis=-1)
        self._number(rank)

    def _number(self, rank: np.ndarray) -> None:
        """Set the places of all couplings in LAPACK's band storage."""
        m = self.width
        self.unknown = rank[:, None] * m + np.arange(m)
        reach = 2 * m if self.pads[0].closed else m
        self.band = max(reach, 1)
        self.rows = 3 * self.band + 1
        own = self.unknown
        self.at_left, self.at_right = self.left >= 0, self.right >= 0
        self.to_own = self._place(own, own)
        # rows of the neighbour, columns of the node: what the node gives to its neighbour
        self.to_left = self._place(own[self.left][self.at_left], own[self.at_left])
        self.to_right = self._place(own[self.right][self.at_right], own[self.at_right])
        self.to_above = self._place(own[:, :-1], own[:, 1:])
        self.to_below = self._place(own[:, 1:], own[:, :-1])

    def _place(self, row: np.ndarray, column: np.ndarray) -> np.ndarray:
        return column * self.rows + 2 * self.band + row - column
