"""Axes that stand still: how the coordinates of a rotor turn about its axis.

A lateral motion of a round rotor comes in pairs of waves with one nodal diameter. A wave that is
turned about the axis by an angle α is multiplied by ``exp(±iα)``. In coordinates ``x = T c`` whose
columns are such waves,

    η = exp(Nα) x,    N = T diag(i n) T⁻¹,    n = 1, −1 for a pair, 0 for all other motions,

are the coordinates as seen from axes that stand still. Supports see the mean motion of an
interface, which has no other waves than these: in η they act as they are. Motions with more nodal
diameters do not move an interface's mean; their coordinates stay in the frame of the rotor. Three
and more equal sectors are round in this sense, too: a pair of bending modes holds further waves
beside n = ±1, and turns by N all the same.

The matrices of a round rotor do not change in ``exp(−Nα)ᵀ X exp(−Nα)``. The matrices of a mesh do a
little: their mean over a turn is the round part, and the rest is the unevenness.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
import scipy.linalg as la

from exudyn_rotor.calls import kept
from exudyn_rotor.linear.equations import add, without_rounding
from exudyn_rotor.reduction.reduced_rotor import ModeKind, ReducedRotor
from exudyn_rotor.theory.invariants import Invariants
from exudyn_rotor.theory.rotating_axes import axes_of, turning_harmonics

_CORNERS = 8  # points of a ring
ACROSS = np.eye(3)[:, :2]  # a pair along (n1, n2) as a vector
HIGHEST = 4  # largest |n| that is looked at
# how many T_q(z) with each of 1, r², r⁴: shafts bend in many waves, discs have nodal circles
_AXIAL_TERMS = (10, 6, 2)
# share of a field that others of its wave must leave over to count as new: what is less tells noise
_NEW_SHARE = 3e-2
# share of a field, squared, that those of lower waves must leave over in the points: of less the
# fit makes large fields of two waves that cancel each other
_DEPENDENT = 1e-2
_POINTS = 800  # of the mesh, at most, by which waves are told
_GROUP = 5e-2  # frequencies that differ by less may be of one pair, which a mesh splits
_SEEN = 1e-8  # share of the largest energy below which a motion is not seen
_TURNS = 0.05  # share of a motion's energy that one lateral wave has more than the opposite one
_PURE = 0.5  # share of both lateral waves that one of them has more in one motion of a pair
_HALF = 0.5  # share of lateral waves in a motion that has no partner: half of a pair
_RIGID_PAIRS = (
    (ModeKind.TRANSLATION_1, ModeKind.TRANSLATION_2),
    (ModeKind.TILT_1, ModeKind.TILT_2),
)
_PAIR = np.array([[1.0, 1.0], [-1j, 1j]]) / np.sqrt(2.0)  # waves of n = 1 and −1


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


@kept
def radius_of_gyration(invariants: Invariants) -> float:
    """Return the radius of gyration about the centre of mass [m]."""
    return float(np.sqrt(np.trace(invariants.J) / invariants.mass))


def wave_amplitudes(
    points: np.ndarray, motion: np.ndarray
) -> tuple[np.ndarray, list[np.ndarray], np.ndarray]:
    """Return the waves n from −4 to 4, the amplitudes of each, and the axial ones of n = 0.

    Amplitudes (p, c) per coordinate are those of smooth fields, fitted by least squares; their
    squared norm is the energy of a wave, summed over the points.

    Parameters
    ----------
    points : ndarray, shape (s, 3)
        Coordinates along (n1, n2, e) from a point of the axis [m].
    motion : ndarray, shape (3s, c)
        Displacement of the points along (n1, n2, e) per coordinate.
    """
    spaces, told = _wave_fields(points, HIGHEST + 1)
    basis = np.hstack([space @ chosen for space, chosen in zip(spaces, told, strict=True)])
    ends = np.cumsum([space.shape[1] for space in spaces])
    fitted = la.block_diag(*told) @ np.linalg.solve(
        basis.T @ basis, basis.T @ motion.reshape(len(points), -1)
    )
    steady, *others = np.split(fitted.reshape(len(fitted), 3, -1).transpose(1, 0, 2), ends[:-1], 1)
    waves = {0: steady.astype(complex)}
    # in cosines and sines, which is real; exp(±ilα) is a unitary combination of them
    for count, fit in enumerate(others, start=1):
        cosine, sine = np.split(fit, 2, axis=1)
        forward = np.sqrt(0.5) * (cosine - 1j * sine)
        waves |= {count: forward, -count: forward.conj()}
    orders = np.arange(-HIGHEST, HIGHEST + 1)
    amplitudes = []
    for n in orders:
        # in Cartesian components the wave n has the angular dependence n − 1, n + 1 and n
        (u1, u2, _), (v1, v2, _) = waves[1 - n], waves[-1 - n]
        a, b = np.sqrt(0.5) * (u1 + 1j * u2), np.sqrt(0.5) * (v1 - 1j * v2)
        amplitudes.append(np.vstack([a, b, waves[-n][2]]))
    return orders, amplitudes, steady[2]


def _wave_fields(points: np.ndarray, highest: int) -> tuple[list[np.ndarray], list[np.ndarray]]:
    """Return cosines, then sines of the fields of the waves ``exp(ilα)`` at points, (s, p) per l.

    Those of ``r^|l| (1, r², r⁴) T_q(z) exp(ilα)``, and their combinations (p, q) that the points
    tell from the waves of lower |l|: where the points are too few to tell waves apart, as on the
    edges of a bar, they are of low |l|.
    """
    x, y, z = points.T
    radius = np.hypot(x, y)
    length, widest = np.ptp(z), radius.max(initial=0.0)
    # points that are on the axis to rounding have no angle
    radius = np.where(radius <= 1e-9 * max(length, widest), 0.0, radius)
    scaled = radius / (radius.max(initial=0.0) or 1.0)
    along = np.polynomial.chebyshev.chebvander(
        2.0 * (z - z.min()) / length - 1.0 if length > 0.0 else np.zeros_like(z),
        max(_AXIAL_TERMS) - 1,
    )
    steady = np.hstack(
        [along[:, :count] * scaled[:, None] ** (2 * p) for p, count in enumerate(_AXIAL_TERMS)]
    )
    turning = np.vander(scaled * np.exp(1j * np.arctan2(y, x)), highest + 1, increasing=True)
    spaces, told, known = [], [], np.zeros((len(points), 0))
    for count in range(highest + 1):
        fields = la.orth(turning[:, count, None] * steady, rcond=_NEW_SHARE)
        # both senses at once, so that neither is preferred: one has the conjugate fields
        both = np.sqrt(2.0) * np.hstack([fields.real, fields.imag]) if count else fields.real
        spaces.append(both)
        rest = both - known @ (known.T @ both)
        lengths, directions = np.linalg.eigh(rest.T @ rest)
        new = lengths > _DEPENDENT
        told.append(directions[:, new])
        known = np.hstack([known, rest @ directions[:, new] / np.sqrt(lengths[new])])
    return spaces, told


def compressed(rows: np.ndarray, least: float = 0.0) -> np.ndarray:
    """Return fewest rows of the same energy ``|R x|²``, without those of `least` or less."""
    squares, turn = np.linalg.eigh(rows.conj().T @ rows)
    chosen = squares > least
    return np.sqrt(squares[chosen])[:, None] * turn[:, chosen].conj().T


@dataclass(frozen=True, eq=False)
class Turning:
    """How the coordinates of a rotor turn about its axis.

    Attributes
    ----------
    T : ndarray, shape (k, k)
        Waves as columns, unitary: the coordinates are mass-orthonormal.
    waves : ndarray of int, shape (k,)
        Their n, one of −1, 0, 1.
    frequencies : ndarray, shape (k,)
        Their frequencies at rest [rad/s]; 0 of rigid motions.
    halves : ndarray of bool, shape (k,)
        Which are half of a lateral pair, whose other half the number of modes has cut off. They
        have n = 0, and are real.
    """

    T: np.ndarray
    waves: np.ndarray
    frequencies: np.ndarray
    halves: np.ndarray

    @property
    def generator(self) -> np.ndarray:
        """N, shape (k, k), skew."""
        return (self.T * (1j * self.waves) @ self.T.conj().T).real

    def within(self, basis: np.ndarray) -> Turning:
        """Return how coordinates turn that are those of an orthonormal basis (k, r), real.

        The basis holds every wave or nothing of it.
        """
        T = basis.T @ self.T
        held = np.linalg.norm(T, axis=0) > 0.5
        return Turning(T[:, held], self.waves[held], self.frequencies[held], self.halves[held])

    @property
    def still(self) -> np.ndarray:
        """Projector on motions that are no lateral waves, shape (k, k)."""
        return (self.T * (self.waves == 0) @ self.T.conj().T).real

    def mean(self, X: np.ndarray) -> np.ndarray:
        """Return the mean over a turn of ``exp(−Nα)ᵀ X exp(−Nα)`` for a matrix X (k, k)."""
        within = self.T.T @ X @ self.T
        within[np.add.outer(self.waves, self.waves) != 0] = 0.0
        return (self.T.conj() @ within @ self.T.conj().T).real

    def motion(self, U: np.ndarray) -> dict[int, np.ndarray]:
        """Return the Fourier terms of ``R(α) U exp(−Nα)`` for the motion U (3 or 6, k) of a place.

        The term 0 is what a support that stands still sees.
        """
        terms: dict[int, np.ndarray] = {}
        for wave, part in self.parts(U).items():
            add(terms, {n - wave: R @ part for n, R in turning_harmonics(len(U)).items()})
        return without_rounding(terms)

    def parts(self, rows: np.ndarray) -> dict[int, np.ndarray]:
        """Return rows (…, k) as the sum of what acts on each wave, by its n."""
        return {
            wave: (rows @ self.T) * (self.waves == wave) @ self.T.conj().T for wave in (-1, 0, 1)
        }

    def unevenness(self, matrices: Sequence[np.ndarray], places: Sequence[np.ndarray]) -> float:
        """Return the largest share of matrices (k, k) and places (6, k) that is not round.

        In slow motions: waves count by ``1/(1 + ω²/ω₁²)`` in the matrices, halves of pairs left
        out, and by their flexibility ``1/ω²`` in the lateral motion of places. Without places the
        share of halves of pairs counts.
        """
        squares = self.frequencies**2
        elastic = squares > 0.0
        flexibility = np.divide(1.0, squares, out=np.zeros(len(squares)), where=elastic)
        slow = np.where(self.halves, 0.0, 1.0 / (1.0 + squares * flexibility.max(initial=0.0)))

        def size(X: np.ndarray) -> float:
            return np.linalg.norm(slow[:, None] * (self.T.T @ X @ self.T) * slow)

        def flexible(U: np.ndarray) -> float:
            return np.linalg.norm(U @ self.T * np.sqrt(flexibility)) ** 2

        shares = [size(X - self.mean(X)) / (size(X) or 1.0) for X in matrices]
        if not places:
            shares.append(flexibility[self.halves].sum() / (flexibility.sum() or 1.0))
        for U in places:
            rest = (U - self.motion(U)[0])[:2]
            shares.append(flexible(rest) / (flexible(U[:2]) or 1.0))
        return float(max(shares))


@kept
def turning_of(rotor: ReducedRotor, inner: ReducedRotor | None = None) -> Turning:
    """Find the waves of a reduced rotor: those of its rigid motions, and of its modes at rest.

    Of each group of nearly equal frequencies the combinations with the most of one lateral wave,
    and the least of the opposite one, are a pair. The attachments of an `inner` rotor have no mode
    shapes: with them a rotor has the waves of that one, and those that interfaces tell of the rest.
    """
    known = _rigid_waves(rotor) if inner is None else turning_of(inner)
    T, whole = known.T, ~known.halves
    rest, omega = np.eye(rotor.size)[:, T.shape[1] :], rotor.frequencies[T.shape[1] :]
    if inner is not None:
        T = inner.in_attached @ T[:, whole]
        rest = la.null_space(np.vstack([T.real.T, T.imag.T]))
        squares, modes = np.linalg.eigh(rest.T @ rotor.invariants.K @ rest)
        rest, omega = rest @ modes, np.sqrt(np.maximum(squares, 0.0))
    size, forms = len(omega), [rest.T @ form @ rest for form in _energies(rotor)]
    waves, halves = np.zeros(size, dtype=int), np.zeros(size, dtype=bool)
    found, order = np.eye(size, dtype=complex), np.argsort(omega, kind="stable")
    apart = np.diff(omega[order]) > _GROUP * omega[order[1:]]
    for group in np.split(order, np.flatnonzero(apart) + 1) if size else ():
        at = np.ix_(group, group)
        found[at], waves[group], halves[group] = _pairs(*(form[at] for form in forms))
    return Turning(
        np.hstack([T, rest @ found]),
        np.r_[known.waves[whole], waves],
        np.r_[known.frequencies[whole], omega],
        np.r_[known.halves[whole], halves],
    )


def _rigid_waves(rotor: ReducedRotor) -> Turning:
    """Return the waves of the rigid motions that have names; others count as modes."""
    kinds = [kind for kind in rotor.rigid_kinds if kind is not ModeKind.FREE]
    T, waves = np.eye(rotor.size, len(kinds), dtype=complex), np.zeros(len(kinds), dtype=int)
    for pair in _RIGID_PAIRS:
        if set(pair) <= set(kinds):
            columns = [kinds.index(kind) for kind in pair]
            T[np.ix_(columns, columns)], waves[columns] = _PAIR, (1, -1)
    return Turning(T, waves, np.zeros(len(kinds)), np.zeros(len(kinds), dtype=bool))


def _energies(rotor: ReducedRotor) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the energies of the waves 1 and −1, and of all, as quadratic forms (k, k).

    At points of the mesh and, as much again, at the interfaces: interfaces see motions with many
    waves along the axis, which the points do not resolve.
    """
    points, motion = rotor_points(rotor, _POINTS)
    orders, amplitudes, _ = wave_amplitudes(points, motion)
    forms = {n: W.conj().T @ W for n, W in zip(orders.tolist(), amplitudes, strict=True)}
    weight = len(points) / max(len(rotor.interfaces), 1)
    for name, place in rotor.interfaces.items():
        U = np.repeat([1.0, place.radius], 3)[:, None] * interface_motion(rotor, name)
        for n, turn in turning_harmonics(6).items():  # R_n projects on what turns with n
            forms[n] = forms[n] + weight * (turn @ U).conj().T @ (turn @ U)
    whole = sum(form.real for form in forms.values())
    floor = _SEEN * whole.diagonal().max(initial=0.0) or 1.0
    return forms[1], forms[-1], whole + floor * np.eye(rotor.size)


def _pairs(
    forward: np.ndarray, backward: np.ndarray, whole: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return waves as orthonormal columns (g, g), their n, and which are halves of pairs.

    By the energies of both lateral waves and of all motion. Waves that are no pair are real.
    """
    more, columns = la.eigh(forward - backward, whole)
    both = np.einsum("ij,ik,kj->j", columns.conj(), forward + backward, columns).real
    # of half a pair together with another motion both waves are strong
    F = columns[:, (more > _TURNS) & (more > _PURE * both)]
    F = F / np.linalg.norm(F, axis=0)
    pairs = la.polar(np.hstack([F, F.conj()]))[0]  # the nearest orthonormal ones
    still = la.null_space(np.vstack([F.real.T, F.imag.T]))
    lateral = still.T @ (forward + backward).real @ still
    share, alone = la.eigh(lateral, still.T @ whole @ still)
    # halves stand by themselves, so that they can be left out
    alone = np.linalg.qr(still @ alone[:, ::-1])[0]
    n = np.repeat([1, -1, 0], [F.shape[1], F.shape[1], len(share)])
    halves = np.r_[np.zeros(pairs.shape[1], dtype=bool), share[::-1] > _HALF]
    return np.hstack([pairs, alone]), n, halves
