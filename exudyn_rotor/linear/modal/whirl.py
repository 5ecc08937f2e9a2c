"""How a mode turns: its circumferential content, its whirl, its frequency seen from outside.

In cylindrical coordinates about the axis every motion ``Re(φ exp(iνt))`` is a sum of waves
``exp(i(νt − nα))``; n > 0 travels with a positive spin, n < 0 against it. The angle seen from
outside is ``α + Ωt``, so that the wave n has the inertial frequency ``ν + nΩ``. A foundation stands
still, as n = 0 does; a mode is its own where it has most of the energy ``Σ m|x|²``. Rigid
translation, tilt and bending are n = ±1, with ``z = u_1 + i u_2 = a exp(iνt) + b̄ exp(−iνt)``: a is
n = +1 and b is n = −1. Axial motion and torsion are n = 0. Source: Genta,
Dynamics of Rotating Systems (2005).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
from scipy.optimize import linear_sum_assignment

from exudyn_rotor.cached import kept
from exudyn_rotor.linear.modal.one_sense import as_waves
from exudyn_rotor.linear.models.protocol import LinearModel, PointMotions
from exudyn_rotor.linear.models.waves import HIGHEST, averaged, compressed, stacked, wave_amplitudes
from exudyn_rotor.linear.periodic.floquet_modes import FloquetModes
from exudyn_rotor.threads import one_thread

WHIRLS = (
    "forward", "backward", "mixed", "axial", "torsional", "radial", "static", "unknown",
    "foundation", "overdamped",
)  # fmt: skip
FORWARD, BACKWARD, MIXED, AXIAL, TORSIONAL, RADIAL, STATIC, UNKNOWN, FOUNDATION, OVERDAMPED = range(
    len(WHIRLS)
)

# kinds of motion: 'lateral' has one nodal diameter, 'disc' more; 'other' are radial ones and those
# that neither shapes nor interfaces show; 'foundation' moves more mass beside the rotor than in it
FAMILIES = ("lateral", "torsional", "axial", "disc", "other", "foundation")

# a mode is mixed when the weaker sense has more than this share of the energy of the stronger
MIXED_SHARE = 0.25
# share of energy that two frequencies seen from outside may differ by and count as equally strong
_EVEN = 0.05
# a mode has n nodal diameters when ±n hold this share of its energy, or, where the waves along a
# shaft are too many for the fit, the second share of what is fitted
DIAMETER_SHARE, _PURE_SHARE = 0.7, 0.9
# least fitted share for that, and share below which more nodal diameters are all there is
_FITTED, _NOT_FITTED = 0.1, 0.05

# inertial frequencies below these shares of the speed and of the resolution are round-off
_STATIC, _ROUNDING = 1e-7, 1e-6
# share of the mean wave number that turns one way in one motion of a pair
_CIRCULAR = 0.8
# 1 − cosine of vectors that are one, and share of the largest that others span beyond the rest
_SAME, _DEPENDENT = 1e-12, 1e-3
_SAMPLES = 8000  # nodes; of fewer, energies of waves depend on how the mesh numbers them
_MANY = 100_000  # entries of vectors


Named = tuple[np.ndarray, np.ndarray, np.ndarray, np.ndarray]


@dataclass(frozen=True, eq=False)
class WhirlContent:
    """Maps coordinates to the amplitudes of circumferential waves.

    Attributes
    ----------
    orders : ndarray of int, shape (o,)
        The waves n, from −4 to 4.
    waves : ndarray, shape (o, p, c)
        Amplitudes of each wave per coordinate; their squared norm is its energy.
    axial, tangential, radial, whole : ndarray, shape (p, c)
        Amplitudes of the axial part of n = 0, of the motion along the circumference and along the
        radius, and of the whole motion.
    standing : ndarray, shape (p, c)
        Amplitudes of what stands still beside the rotor.
    rows : ndarray of int or None, shape (c,)
        Which coordinates count; all by default.
    """

    orders: np.ndarray
    waves: np.ndarray
    axial: np.ndarray
    tangential: np.ndarray
    radial: np.ndarray
    whole: np.ndarray
    standing: np.ndarray
    rows: np.ndarray | None = None

    @classmethod
    def of(cls, model: LinearModel) -> WhirlContent:
        """Build the content of a linear model from mode shapes, or from its interfaces.

        Equal weights for up to 8000 mesh nodes, 400 of a SolidRotor, spread over the node numbers.
        Without mode shapes, rings of points that move with the interfaces take their place.
        """
        return cls.from_points(model.point_motions(_SAMPLES))

    @staticmethod
    def from_points(points: PointMotions) -> WhirlContent:
        """Build the content from points and their motions; made once for each of these."""
        return _content_of(points)

    def within(self, basis: np.ndarray | None) -> WhirlContent:
        """Return the content of a basis (c, r) of the coordinates; None for all of them."""
        if basis is None:
            return self
        V = self._chosen(basis[None])[0]
        parts = {
            name: getattr(self, name) @ V
            for name in ("waves", "axial", "tangential", "radial", "whole", "standing")
        }
        return replace(self, rows=None, **parts)

    def energies(self, vectors: np.ndarray) -> np.ndarray:
        """Return the energy of each wave (h, o, k) of `vectors` (h, c, k)."""
        moved = self.waves @ self._chosen(vectors)[:, None]
        return np.sum(moved.real**2 + moved.imag**2, axis=2)

    def polarised(self, vectors: np.ndarray, orders: np.ndarray) -> np.ndarray:
        """Turn modes (n, h, c, g) of one eigenvalue so that each holds waves of one sense.

        Unit vectors, in n groups; `orders` (h,) are the multiples of Ω by which the harmonics turn.
        The combinations make the mean wave number seen from outside extremal: circular motion
        instead of motion in two planes.
        """
        count, width, result = len(vectors), vectors.shape[3], vectors.astype(complex)
        flat = vectors.reshape(count, -1, width)
        first = _first_alike(flat)
        twins = np.any(first != np.arange(width), axis=1)
        for i in np.flatnonzero(twins):  # as the two copies of a free motion
            once, place = np.unique(first[i], return_inverse=True)
            turned = self.polarised(vectors[i : i + 1, :, :, once], orders)[0]
            nearest = np.abs(flat[i][:, once].conj().T @ turned.reshape(flat.shape[1], -1))
            result[i] = turned[:, :, linear_sum_assignment(-nearest)[1][place]]
        span, lengths, _ = np.linalg.svd(flat, full_matrices=False)
        # not copies of a defective eigenvalue
        clear = ~twins & (lengths[:, -1] >= _DEPENDENT * lengths[:, 0])
        if lengths.shape[1] == width and np.any(clear):
            turned = self._extremal(span[clear].reshape(-1, *vectors.shape[1:]), orders)
            result[clear] = turned / np.linalg.norm(turned, axis=(1, 2), keepdims=True)
        return result

    def _extremal(self, span: np.ndarray, orders: np.ndarray) -> np.ndarray:
        """Return combinations of motions (n, h, c, g) whose mean wave number is extremal."""
        chosen, width = self._chosen(span), span.shape[3]
        moved = (self.waves @ chosen[:, :, None]).reshape(len(span), -1, width)
        seen = np.add.outer(orders, self.orders).repeat(self.waves.shape[1])
        # 0.4 lies between the waves, so that axial motion parts from torsion
        axial, whole = (
            (part @ chosen).reshape(len(span), -1, width) for part in (self.axial, self.whole)
        )
        mean = _gram(moved, seen) + _gram(axial, 0.4)
        gram = _gram(whole, 1.0)
        traces = np.trace(gram, axis1=1, axis2=2).real[:, None, None]
        lower = np.linalg.cholesky(gram + 1e-12 * np.maximum(traces, 1e-300) * np.eye(width))
        half = np.linalg.solve(lower, mean).conj().swapaxes(1, 2)
        turned = np.linalg.solve(lower, half)
        _, directions = np.linalg.eigh(0.5 * (turned + turned.conj().swapaxes(1, 2)))
        turn = np.linalg.solve(lower.conj().swapaxes(1, 2), directions)
        return span @ turn[:, None]

    def turn_both_ways(
        self, first: np.ndarray, second: np.ndarray, orders: np.ndarray
    ) -> np.ndarray:
        """Return whether combinations of two motions turn one way each, shape (j,).

        Of each pair, one of `first` and one of `second` (h, c, j); `orders` (h,) as in
        :meth:`polarised`. The mean wave number of a combination, over its mean size, is a quotient
        of two Hermitian forms; it takes all values between their two eigenvalues, which have to
        lie on both sides of ``±0.8``.
        """
        one, other = (self.waves @ self._chosen(vectors)[:, None] for vectors in (first, second))
        products = [
            np.sum(a.conj() * b, axis=2) for a, b in ((one, one), (other, other), (one, other))
        ]
        seen = np.add.outer(orders, self.orders)
        mean, size = (
            np.array([np.tensordot(weights, product, 2) for product in products])
            for weights in (seen, np.abs(seen))
        )
        beyond = [mean + sign * _CIRCULAR * size for sign in (1.0, -1.0)]
        determinants = [(a * b).real - np.abs(c) ** 2 for a, b, c in beyond]
        # zero where both are the same motion
        return np.max(determinants, axis=0) < -1e-12 * (size[0] + size[1]).real ** 2

    def named(self, modes: FloquetModes, speed: float) -> Named:
        """Return vectors, repeated modes as waves of one sense, and what :meth:`classify` does.

        Modes with Im λ < 0 are looked at as their conjugates.
        """
        return self.named_at([modes], [speed])[0]

    def named_at(self, modes: Sequence[FloquetModes], speeds: Sequence[float]) -> list[Named]:
        """Return what :meth:`named` does, for several speeds at once."""
        vectors = as_waves(modes, self.polarised)
        alike: dict[tuple, list[int]] = {}
        for index, entry in enumerate(modes):
            alone = index if entry.vectors.size > _MANY else None  # saves time for small ones only
            alike.setdefault((entry.orders.tobytes(), alone), []).append(index)
        result: dict[int, Named] = {}
        for rows in alike.values():
            counts = [modes[row].values.size for row in rows]
            nu = np.abs(np.concatenate([modes[row].values.imag for row in rows]))
            classified = self.classify(
                np.concatenate([vectors[row] for row in rows], axis=2),
                modes[rows[0]].orders,
                nu,
                np.repeat([speeds[row] for row in rows], counts),
                _ROUNDING * np.repeat([modes[row].resolution for row in rows], counts),
            )
            parts = (np.split(array, np.cumsum(counts)[:-1]) for array in classified)
            for row, *entries in zip(rows, *parts, strict=True):
                result[row] = (vectors[row], *entries)
        return [result[row] for row in range(len(modes))]

    def classify(
        self,
        vectors: np.ndarray,
        orders: np.ndarray,
        nu: np.ndarray,
        speed: float | np.ndarray,
        rounding: float | np.ndarray = 0.0,
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return inertial frequency [rad/s], index into :data:`WHIRLS`, and nodal diameter.

        Parameters
        ----------
        vectors : ndarray, shape (h, c, k)
            Harmonics of the modes.
        orders : ndarray of int, shape (h,)
        nu : ndarray, shape (k,)
            Frequencies in the rotor frame, ≥ 0 [rad/s].
        speed, rounding : float, or ndarray of shape (k,)
            Ω, and what of a frequency is rounding [rad/s].

        Notes
        -----
        The frequency is the one with the most energy seen from outside, of all waves that turn
        together. A motion that stands in the rotor frame, as that of a single blade, has as much at
        ``ν + nΩ`` as at ``ν − nΩ``; where less than 5 % tells them apart the first counts. The mode
        is mixed where the weaker sense has more than a quarter of the energy of the stronger (half
        its amplitude), static where its strongest wave stands still, unknown where nothing of it is
        seen, or only nodal diameters above four; then n is taken as 0.
        """
        energy = self.energies(vectors)  # (h, o, k)
        beside, total = self.beside(vectors), self.whole_energy(vectors)
        stands = np.sum(beside, axis=0) > 0.5 * total
        # what moves most is looked at alone
        zero = np.flatnonzero(self.orders == 0)[0]
        energy[:, zero] = np.maximum(energy[:, zero] - beside, 0.0)
        energy[:, :, stands] = 0.0
        energy[:, zero, stands] = beside[:, stands]
        n = self.orders[None, :, None]
        seen = nu + (orders[:, None, None] + n) * speed
        turns = np.sign(n * seen) * np.where(np.less(speed, 0.0), -1.0, 1.0)
        turns = np.where(np.abs(seen) <= _STATIC * np.abs(speed) + rounding, 0.0, turns)
        flat = energy.reshape(-1, energy.shape[2])
        best = self._strongest(flat, np.add.outer(orders, self.orders).ravel(), speed)
        columns = np.arange(flat.shape[1])
        frequency = np.abs(seen.reshape(flat.shape)[best, columns])
        forward = np.sum(energy * (turns > 0), axis=(0, 1))
        backward = np.sum(energy * (turns < 0), axis=(0, 1))
        code = np.where(forward >= backward, FORWARD, BACKWARD)
        weaker, stronger = np.minimum(forward, backward), np.maximum(forward, backward)
        code[weaker > MIXED_SHARE * stronger] = MIXED
        wave = np.broadcast_to(n, energy.shape).reshape(flat.shape)[best, columns]
        code[(turns.reshape(flat.shape)[best, columns] == 0) & (wave != 0)] = STATIC
        still = wave == 0
        code[still] = self._without_waves(vectors[:, :, still])
        code[stands] = FOUNDATION
        unseen = total <= 1e-12 * np.max(total, initial=0.0)
        unseen |= self._not_fitted(vectors, energy, total) & ~stands
        code[unseen] = UNKNOWN
        strongest = orders[np.argmax(np.sum(np.abs(vectors) ** 2, axis=1), axis=0)]
        frequency = np.where(unseen, np.abs(nu + strongest * speed), frequency)
        return frequency, code, self._diameters(energy, np.abs(total - np.sum(beside, axis=0)))

    @staticmethod
    def _strongest(
        energy: np.ndarray, multiples: np.ndarray, speed: float | np.ndarray
    ) -> np.ndarray:
        """Return the strongest wave, of energies (w, k), of the strongest frequency, shape (k,).

        Waves of one of the `multiples` (w,) of Ω have one frequency seen from outside.
        """
        known, place = np.unique(multiples, return_inverse=True)
        together = np.zeros((known.size, energy.shape[1]))
        np.add.at(together, place, energy)
        # the known ones are even about zero, and ascend
        first = np.argmax(together, axis=0)
        upper = known.size // 2 + np.abs(first - known.size // 2) * np.where(speed < 0.0, -1, 1)
        even = np.take_along_axis(together, upper[None], 0)[0] >= (1.0 - _EVEN) * together.max(0)
        first = np.where(even, upper, first)
        return np.argmax(np.where(place[:, None] == first, energy, -1.0), axis=0)

    def beside(self, vectors: np.ndarray) -> np.ndarray:
        """Return the energy of what stands still, which counts as waves n = 0, shape (h, k)."""
        return _energy(self.standing, self._chosen(vectors))

    def mean_waves(self, vectors: np.ndarray) -> np.ndarray:
        """Return the mean wave numbers of motions (s, c, k) that are one harmonic, (s, k)."""
        return averaged(self.orders, self.waves, self._chosen(vectors))

    def whole_energy(self, vectors: np.ndarray) -> np.ndarray:
        """Return the energy of the whole motion, all harmonics, shape (k,)."""
        return np.sum(_energy(self.whole, self._chosen(vectors)), axis=0)

    def _without_waves(self, vectors: np.ndarray) -> np.ndarray:
        """Return axial, torsional or radial for modes with n = 0."""
        strongest = np.argmax(self._parts(vectors), axis=0)
        return np.array([AXIAL, TORSIONAL, RADIAL])[strongest]

    def _parts(self, vectors: np.ndarray) -> np.ndarray:
        """Return the energy along the axis of n = 0, the circumference and the radius (3, k)."""
        chosen = self._chosen(vectors)
        parts = (self.axial, self.tangential, self.radial)
        return np.array([np.sum(_energy(component, chosen), axis=0) for component in parts])

    def _not_fitted(self, vectors: np.ndarray, energy: np.ndarray, total: np.ndarray) -> np.ndarray:
        """Return which modes have more nodal diameters than are looked at, shape (k,)."""
        few = energy.sum(axis=(0, 1)) < _NOT_FITTED * total
        few[few] = self._parts(vectors[:, :, few]).max(axis=0) < 0.5 * total[few]
        return few

    def _diameters(self, energy: np.ndarray, whole: np.ndarray) -> np.ndarray:
        """Return n where ±n hold most of the energy, −1 elsewhere."""
        by_order = np.sum(energy, axis=0)
        counts = np.arange(self.orders.max() + 1)
        pairs = np.array([by_order[np.abs(self.orders) == n].sum(axis=0) for n in counts])
        whole, fitted, most = np.maximum(whole, 1e-300), pairs.sum(axis=0), pairs.max(axis=0)
        # on a coarse mesh fields of several n may cancel each other
        clear = most >= DIAMETER_SHARE * np.maximum(whole, fitted)
        clear |= (fitted >= _FITTED * whole) & (most >= _PURE_SHARE * fitted)
        return np.where(clear, np.argmax(pairs, axis=0), -1)

    def _chosen(self, vectors: np.ndarray) -> np.ndarray:
        return vectors if self.rows is None else vectors[..., self.rows, :]


@kept
@one_thread()
def _content_of(points: PointMotions) -> WhirlContent:
    none = np.zeros((0, points.motion.shape[1]))
    standing = none if points.standing is None else points.standing
    starts = points.ends[:-1]
    coordinates = np.split(points.points, starts)
    motions = np.split(points.motion, [3 * start for start in starts])
    still = [standing, *[none] * len(starts)]
    orders, *each = zip(*map(_operators, coordinates, motions, still), strict=True)
    # the energies of several rotors add up
    operators = (np.concatenate(parts, axis=-2) for parts in each)
    return WhirlContent(orders[0], *operators, standing, points.rows)


def families(codes: np.ndarray, diameters: np.ndarray) -> np.ndarray:
    """Return which of :data:`FAMILIES` modes belong to, from whirl codes and nodal diameters."""
    special = {TORSIONAL: 1, AXIAL: 2, RADIAL: 4, UNKNOWN: 4, FOUNDATION: 5}
    kinds = np.where(np.asarray(diameters) >= 2, 3, 0)
    for code, kind in special.items():
        kinds = np.where(np.asarray(codes) == code, kind, kinds)
    return np.array(FAMILIES)[kinds]


def named_still(codes: np.ndarray, overdamped: np.ndarray, static: np.ndarray) -> np.ndarray:
    """Return whirl codes; lateral motions that are overdamped or stand still have no sense."""
    lateral = np.isin(codes, (FORWARD, BACKWARD, MIXED, STATIC))
    codes = np.where(static & lateral, STATIC, codes)
    return np.where(overdamped & lateral, OVERDAMPED, codes)


def _energy(amplitudes: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    return np.sum(np.abs(amplitudes @ vectors) ** 2, axis=1)


def _gram(moved: np.ndarray, weights: np.ndarray | float) -> np.ndarray:
    """Return the weighted products of columns, (n, g, g), of amplitudes (n, p, g)."""
    return (moved.conj().swapaxes(1, 2) * weights) @ moved


def _first_alike(vectors: np.ndarray) -> np.ndarray:
    """Return for each column (n, g) of vectors (n, c, g) the first one that is the same."""
    products = np.abs(vectors.conj().swapaxes(1, 2) @ vectors)
    sizes = np.diagonal(products, axis1=1, axis2=2)
    return np.argmax(products >= (1.0 - _SAME) * sizes[:, None, :], axis=1)


def _operators(points: np.ndarray, motion: np.ndarray, standing: np.ndarray) -> tuple:
    """Return the fields of :class:`WhirlContent` up to `whole`."""
    orders, amplitudes, axial = wave_amplitudes(points, motion)
    amplitudes[HIGHEST] = np.vstack([amplitudes[HIGHEST], standing])
    waves = stacked(amplitudes)
    u1, u2, _ = motion.reshape(len(points), 3, -1).transpose(1, 0, 2)
    angle = np.arctan2(points[:, 1], points[:, 0])[:, None]
    radial = np.cos(angle) * u1 + np.sin(angle) * u2
    tangential = np.cos(angle) * u2 - np.sin(angle) * u1
    whole = np.vstack([motion, standing])
    return (orders, waves, axial, *(compressed(X) for X in (tangential, radial, whole)))
