"""A rotor's coordinates turned about its axis: which of them are waves, and what is not even.

A motion of an axisymmetric rotor that is turned about the axis by an angle α is a motion again, and
of the same energy. In modal coordinates ``x = T c`` whose columns are waves of n nodal diameters,
``c_j → exp(i n_j α) c_j``, so that

    y = exp(Gα) x,    G = T diag(i n) T⁻¹

are the coordinates x as seen from axes that turn by −α. G is found from the modes at rest: of each
group of one frequency the mean wave number is made extremal and rounded to a whole number. More
than four nodal diameters are not looked at; such motions keep to the frame of the rotor.

Matrices of an axisymmetric rotor do not change in ``exp(−Gα)ᵀ X exp(−Gα)``. Those of a mesh or of
another rotor are Fourier sums in α, of which the mean over a turn is the axisymmetric part.
"""

from __future__ import annotations

from collections.abc import Callable
from dataclasses import dataclass

import numpy as np
import scipy.linalg as la

from exudyn_rotor.linear.models.rotor.rotor_on_supports import LinearRotor
from exudyn_rotor.linear.models.waves import HIGHEST, wave_amplitudes
from exudyn_rotor.linear.periodic.periodic_system import Terms
from exudyn_rotor.reduction.mode_kind import ModeKind
from exudyn_rotor.theory.rotating_axes import turning_harmonics

_POINTS = 800  # of the mesh, at most, by which waves are told
_GROUP = 5e-2  # frequencies that differ by less may be of one pair, which a mesh splits
_SEEN = 1e-8  # share of the largest energy below which a mode is not seen
_RIGID_PAIRS = (
    (ModeKind.TRANSLATION_1, ModeKind.TRANSLATION_2),
    (ModeKind.TILT_1, ModeKind.TILT_2),
)
_PAIR = np.array([[1.0, 1.0], [-1j, 1j]]) / np.sqrt(2.0)  # waves of n = 1 and −1
_NOTHING = 1e-13  # share of a matrix that is round-off
_FREE = 1e-12  # share of the largest squared frequency that is round-off of a free motion


@dataclass(frozen=True, eq=False)
class Turning:
    """How the coordinates of a rotor turn about its axis.

    Attributes
    ----------
    T, inverse : ndarray, shape (k, k)
        Waves as columns, and ``T⁻¹``; of unit modal mass.
    waves : ndarray of int, shape (k,)
        Their n; 0 also for those that keep to the frame of the rotor.
    weights : ndarray, shape (k,)
        ``1/(1 + ω²/ω₁²)`` of the frequencies at rest and the lowest flexible one: how much a wave
        counts in slow motions.
    """

    T: np.ndarray
    inverse: np.ndarray
    waves: np.ndarray
    weights: np.ndarray

    @classmethod
    def of(cls, rotor: LinearRotor) -> Turning:
        """Find the waves of a rotor without supports."""
        inv, kinds = rotor.invariants, rotor.rotor.rigid_kinds
        squares, V = la.eigh(inv.K, inv.M)
        # free motions are of one group, those of a rotor without rigid coordinates, too
        omega = np.sqrt(np.where(squares > _FREE * squares.max(), squares, 0.0))
        rigid = len(kinds)
        omega[:rigid], V[:, :rigid] = 0.0, np.eye(len(V), rigid)
        first = omega[omega > 0.0].min(initial=np.inf)
        E, waves = _flexible_waves(rotor, V, omega, rigid)
        for pair in _RIGID_PAIRS:
            if set(pair) <= set(kinds):
                columns = [kinds.index(kind) for kind in pair]
                E[np.ix_(columns, columns)] = _PAIR
                waves[columns] = 1, -1
        T = V @ E
        weights = 1.0 / (1.0 + (omega / first) ** 2)
        return cls(T, T.conj().T @ inv.M, waves, weights)

    @classmethod
    def beside(cls, pairs: int, still: int) -> Turning:
        """Return how what is beside rotors turns: pairs along (n1, n2), then what stands."""
        T = la.block_diag(np.kron(np.eye(pairs), _PAIR), np.eye(still))
        waves = np.r_[np.tile([1, -1], pairs), np.zeros(still, dtype=int)].astype(int)
        return cls(T, T.conj().T, waves, np.zeros(len(waves)))

    def widened(self, rotor: LinearRotor) -> Turning:
        """Return how a rotor turns that has further coordinates after these.

        They are mass-orthonormal, diagonalise the stiffness, and turn by themselves. Their
        weights are zero.
        """
        kept = len(self.waves)
        omega = np.sqrt(rotor.invariants.K.diagonal()[kept:])
        V = np.eye(rotor.size)[:, kept:]
        E, waves = _flexible_waves(rotor, V, omega, 0)
        return Turning(
            la.block_diag(self.T, E),
            la.block_diag(self.inverse, E.conj().T),
            np.r_[self.waves, waves],
            np.r_[self.weights, np.zeros(len(waves))],
        )

    @property
    def generator(self) -> np.ndarray:
        """G, shape (k, k)."""
        return (self.T @ ((1j * self.waves)[:, None] * self.inverse)).real

    def form(self, X: np.ndarray) -> dict[int, np.ndarray]:
        """Return the Fourier terms in α of ``exp(−Gα)ᵀ X exp(−Gα)`` for a matrix X (k, k)."""
        within = self.T.T @ X @ self.T
        harmonics = -np.add.outer(self.waves, self.waves)
        return _terms(within, harmonics, lambda Y: self.inverse.T @ Y @ self.inverse, X)

    def motion(self, U: np.ndarray) -> dict[int, np.ndarray]:
        """Return the Fourier terms of ``R(α) U exp(−Gα)`` for the motion U (6, k) of a place."""
        terms: dict[int, np.ndarray] = {}
        within = U @ self.T
        for n, R in turning_harmonics(len(U)).items():
            for m, X in _terms(R @ within, n - self.waves[None, :], self._back, U).items():
                terms[m] = terms.get(m, 0.0) + X
        return terms

    def unevenness(self, form: Terms, whole: np.ndarray) -> float:
        """Return the share of a matrix in slow motions that is not axisymmetric."""
        return _share(form, whole, lambda X: self.weights[:, None] * self._within(X) * self.weights)

    def unevenness_at(self, motion: Terms, whole: np.ndarray) -> float:
        """Return the share of the motion of a place that is not axisymmetric."""
        # squared, as each wave's part of the flexibility there
        return _share(motion, whole, lambda X: X @ self.T * np.sqrt(self.weights))

    def _within(self, X: np.ndarray) -> np.ndarray:
        return self.T.T @ X @ self.T

    def _back(self, rows: np.ndarray) -> np.ndarray:
        return rows @ self.inverse


def _amplitudes(rotor: LinearRotor, V: np.ndarray) -> tuple[np.ndarray, list[np.ndarray]]:
    """Return the waves n, and the amplitudes of each for motions V (k, c).

    At points of the mesh and, as much again, at the interfaces: these see motions with many waves
    along the axis, which the points do not resolve.
    """
    points = rotor.point_motions(_POINTS)
    orders, amplitudes, _ = wave_amplitudes(points.points, points.motion @ V)
    places = rotor.rotor.interfaces
    weight = np.sqrt(len(points.points) / max(len(places), 1))
    for name, place in places.items():
        U = np.repeat([1.0, place.radius], 3)[:, None] * (rotor.interface_motion(name) @ V)
        for n, turn in turning_harmonics(len(U)).items():
            at = HIGHEST + n
            # R_n projects on what turns with n
            amplitudes[at] = np.vstack([amplitudes[at], weight * (turn @ U)])
    return orders, amplitudes


def _flexible_waves(
    rotor: LinearRotor, V: np.ndarray, omega: np.ndarray, rigid: int
) -> tuple[np.ndarray, np.ndarray]:
    """Return the waves of modes V (k, c) as columns of E (c, c), and their n; the first not."""
    orders, amplitudes = _amplitudes(rotor, V)
    gram = sum((W.conj().T @ W).real for W in amplitudes)
    floor = _SEEN * gram.diagonal().max(initial=0.0) or 1.0
    E, waves = np.eye(len(omega), dtype=complex), np.zeros(len(omega), dtype=int)
    for group in _groups(omega, rigid):
        energies = np.array([W[:, group].conj().T @ W[:, group] for W in amplitudes])
        seen = gram[np.ix_(group, group)] + floor * np.eye(len(group))
        E[np.ix_(group, group)], waves[group] = _waves_of(orders, energies, seen)
    return E, waves


def _groups(omega: np.ndarray, rigid: int) -> list[np.ndarray]:
    """Return the columns of ascending frequencies in groups, without the rigid motions."""
    apart = np.diff(omega[rigid:]) > _GROUP * omega[rigid + 1 :]
    groups = np.split(np.arange(rigid, len(omega)), np.flatnonzero(apart) + 1)
    return [group for group in groups if group.size]


def _waves_of(
    orders: np.ndarray, energies: np.ndarray, gram: np.ndarray
) -> tuple[np.ndarray, np.ndarray]:
    """Return waves as orthonormal columns (g, g) and their whole numbers n (g,).

    From the energies (o, g, g) of the waves `orders` and of all that is seen (g, g). Each wave
    stands beside its conjugate, which has −n.
    """
    numbers = np.rint(la.eigh(np.tensordot(orders, energies, 1), gram)[0]).astype(int)
    columns, n = [], []
    for number in np.unique(numbers[numbers > 0]):
        # those with the least energy in all other waves
        others = np.tensordot((orders - number) ** 2, energies, 1)
        count = int(np.sum(numbers == number))
        columns.append(la.eigh(others, gram)[1][:, :count])
        n += [number] * count
    F = np.hstack([np.zeros((len(gram), 0)), *columns])
    F = F / np.linalg.norm(F, axis=0)
    pairs = np.hstack([F, F.conj()])
    span, _, turn = np.linalg.svd(pairs, full_matrices=True)
    count = pairs.shape[1]
    pairs = span[:, :count] @ turn[:count]  # the nearest orthonormal ones, pair by pair
    rest = np.eye(len(gram)) - (pairs @ pairs.conj().T).real
    still = np.linalg.eigh(rest)[1][:, count:]
    n = np.array(n, dtype=int)
    return np.hstack([pairs, still]), np.r_[n, -n, np.zeros(len(gram) - count, dtype=int)]


def _terms(
    within: np.ndarray,
    harmonics: np.ndarray,
    back: Callable[[np.ndarray], np.ndarray],
    given: np.ndarray,
) -> dict[int, np.ndarray]:
    """Return the parts of a matrix of waves by their harmonic; none that is round-off."""
    harmonics = np.broadcast_to(harmonics, within.shape)
    least = _NOTHING * np.abs(given).max(initial=0.0)
    terms = {}
    for m in np.unique(harmonics):
        X = back(np.where(harmonics == m, within, 0.0))
        if m == 0 or np.abs(X).max() > least:
            terms[int(m)] = X.real if m == 0 else X
    return terms


def _share(terms: Terms, whole: np.ndarray, weighed: Callable[[np.ndarray], np.ndarray]) -> float:
    size = np.linalg.norm(weighed(whole))
    return float(np.linalg.norm(weighed(whole - terms[0])) / size) if size > 0.0 else 0.0
