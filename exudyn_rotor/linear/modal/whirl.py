"""How a motion turns: its circumferential waves, its whirl, its frequency seen from outside.

In cylindrical coordinates about the axis every motion ``Re(φ exp(iνt))`` of a rotor is a sum of
waves ``exp(i(νt − nα))``; n > 0 travels with a positive spin, n < 0 against it. Rigid translation,
tilt and bending are n = ±1, axial motion and torsion n = 0. Coordinates that stand still show a
wave at the frequency ν with which it is seen from outside; in the frame of the rotor the wave n is
seen at ``ν + nΩ``. A foundation stands still; a motion is the foundation's where that has most of
the energy. Source: Genta, Dynamics of Rotating Systems (2005).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from typing import NamedTuple

import numpy as np
import scipy.linalg as la

from exudyn_rotor.linear.model.assembly import rotors_of
from exudyn_rotor.linear.model.body import RotorBody
from exudyn_rotor.linear.model.linear_model import LinearModel
from exudyn_rotor.linear.model.points import rotor_points
from exudyn_rotor.linear.model.waves import wave_amplitudes
from exudyn_rotor.linear.solve.motions import Motions

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
# a mode has n nodal diameters when ±n hold this share of its energy, or, where the waves along a
# shaft are too many for the fit, the second share of what is fitted
_DIAMETER_SHARE, _PURE_SHARE = 0.7, 0.9
_FITTED, _NOT_FITTED = 0.1, 0.05  # least fitted share for that, and share that tells nothing
_STATIC = 1e-7  # share of the speed: a frequency seen from outside that is round-off
_SAME = 1e-8  # relative distance of λ of repeated motions
_NO_OSCILLATION = 1e-6  # share of |λ| below which a frequency is that of critical damping
_GONE = 100.0  # decay over Ω of a real exponent that is over before the rotor turns
_SAMPLES = 8000  # nodes of the mesh


class Named(NamedTuple):
    """Motions at one speed with their names.

    Attributes
    ----------
    motions : Motions
        Repeated ones as waves of one sense.
    inertial, rotor : ndarray, shape (k,)
        Frequencies seen from outside, and in the frame of the rotor, of the strongest wave [rad/s].
    codes, diameters : ndarray of int, shape (k,)
        Index into :data:`WHIRLS`, and nodal diameters, −1 where they are not known.
    """

    motions: Motions
    inertial: np.ndarray
    rotor: np.ndarray
    codes: np.ndarray
    diameters: np.ndarray

    def columns(self, chosen: np.ndarray) -> Named:
        """Return some of the motions."""
        return Named(self.motions.columns(chosen), *(each[chosen] for each in self[1:]))


@dataclass(frozen=True, eq=False)
class Content:
    """Quadratic forms of the coordinates of a model that tell the energy of waves.

    Attributes
    ----------
    waves : ndarray of int, shape (w,)
        The wave n of each form.
    shifts : ndarray of float, shape (w,)
        By how many Ω the frequency of that form seen from outside is above the harmonic's.
    spins : ndarray of float, shape (w,)
        n times the speed ratio of its rotor: how many Ω lie between both frames.
    forms : ndarray, shape (w, k, k)
        Energy ``xᴴ F x`` of each.
    axial, tangential, radial, whole, standing : ndarray, shape (k, k)
        Energy along the axis, along the circumference and along the radius, of all motion of the
        rotors, and of what stands still beside them.
    """

    waves: np.ndarray
    shifts: np.ndarray
    spins: np.ndarray
    forms: np.ndarray
    axial: np.ndarray
    tangential: np.ndarray
    radial: np.ndarray
    whole: np.ndarray
    standing: np.ndarray

    @classmethod
    def of(cls, model: LinearModel) -> Content:
        """Build the forms of a model from mode shapes, or from its interfaces."""
        assembly = model.assembly(1.0)
        k, found = assembly.size, []
        parts = {name: np.zeros((k, k)) for name in ("axial", "tangential", "radial", "whole")}
        share = 0.0
        for body, place in zip(assembly.bodies, assembly.slices, strict=True):
            if not isinstance(body, RotorBody):
                continue
            points, motion = rotor_points(body.alone.rotor, _SAMPLES)
            motion = motion @ body.alone.Q
            share = max(share, len(points) / body.alone.invariants.mass)
            orders, amplitudes, axial = wave_amplitudes(points, motion)
            for n, W in zip(orders.tolist(), amplitudes, strict=True):
                found += _forms_of(body, n, W, place, k)
            for name, rows in _components(points, motion, axial).items():
                parts[name][place, place] += rows.T @ rows
        standing = np.zeros((k, k))
        for body, place in zip(assembly.bodies, assembly.slices, strict=True):
            if not isinstance(body, RotorBody):  # mass for mass as large as the rotor's
                standing[place, place] = share * body.M
        found = found or [(0, 0.0, 0.0, np.zeros((k, k)))]  # no point that moves: no whirl
        waves, shifts, spins, forms = zip(*found, strict=True)
        return cls(np.array(waves), np.array(shifts), np.array(spins), np.array(forms), **parts,
                   standing=standing)  # fmt: skip

    def named(self, motions: Motions, *, apart: bool = False) -> Named:
        """Return motions with their names; repeated ones are waves of one sense where `apart`."""
        motions = motions if apart else self._as_waves(motions)
        values, speed = motions.values, motions.speed
        nu = np.abs(np.nan_to_num(values.imag))
        vectors = np.where(values.imag < 0.0, motions.vectors[::-1].conj(), motions.vectors)
        vectors = np.nan_to_num(vectors)
        energy = energy_of(self.forms, vectors)  # (h, w, k)
        standing, whole = (
            energy_of(form[None], vectors).sum(axis=(0, 1)) for form in (self.standing, self.whole)
        )
        seen = nu + (motions.orders[:, None, None] + self.shifts[None, :, None]) * speed
        n = self.waves[None, :, None]
        turns = np.sign(n * seen) * (-1.0 if speed < 0.0 else 1.0)
        turns = np.where(np.abs(seen) <= _STATIC * abs(speed) + motions.bound, 0.0, turns)
        best = _strongest(energy, motions.orders[:, None] + self.shifts[None, :])
        columns = np.arange(len(values))
        inertial = np.abs(seen.reshape(-1, len(values))[best, columns])
        forward = np.sum(energy * (turns > 0), axis=(0, 1))
        backward = np.sum(energy * (turns < 0), axis=(0, 1))
        codes = np.where(forward >= backward, FORWARD, BACKWARD)
        weaker, stronger = np.minimum(forward, backward), np.maximum(forward, backward)
        codes[weaker > MIXED_SHARE * stronger] = MIXED
        wave = np.broadcast_to(n, energy.shape).reshape(-1, len(values))[best, columns]
        spins = np.broadcast_to(self.spins[None, :, None], energy.shape)
        spin = spins.reshape(-1, len(values))[best, columns]
        rotor = np.abs(seen.reshape(-1, len(values))[best, columns] - spin * speed)
        still = wave == 0
        codes[(turns.reshape(-1, len(values))[best, columns] == 0) & ~still] = STATIC
        components = [
            energy_of(form[None], vectors).sum(axis=(0, 1))
            for form in (self.axial, self.tangential, self.radial)
        ]
        named = np.array([AXIAL, TORSIONAL, RADIAL])[np.argmax(components, axis=0)]
        codes = np.where(still, named, codes)
        fitted = energy.sum(axis=(0, 1))
        unseen = whole <= 1e-12 * np.max(whole, initial=0.0)
        unseen |= (fitted < _NOT_FITTED * whole) & (np.max(components, axis=0) < 0.5 * whole)
        main = motions.orders[np.argmax(np.sum(np.abs(vectors) ** 2, axis=1), axis=0)]
        heard = np.abs(nu + main * speed)
        stands = standing > whole
        codes = np.where(unseen, UNKNOWN, codes)
        codes = np.where(stands, FOUNDATION, codes)
        inertial = np.where(unseen | stands, heard, inertial)
        rotor = np.where(unseen | stands, nu, rotor)
        diameters = np.where(stands, 0, self._diameters(energy, whole))
        found = Named(motions, inertial, rotor, codes.astype(np.int64), diameters)
        return _still(found)

    def _diameters(self, energy: np.ndarray, whole: np.ndarray) -> np.ndarray:
        """Return n where ±n hold most of the energy, −1 elsewhere."""
        by_wave = energy.sum(axis=0)
        counts = np.arange(np.abs(self.waves).max() + 1)
        pairs = np.array([by_wave[np.abs(self.waves) == n].sum(axis=0) for n in counts])
        whole, fitted, most = np.maximum(whole, 1e-300), pairs.sum(axis=0), pairs.max(axis=0)
        clear = most >= _DIAMETER_SHARE * np.maximum(whole, fitted)
        clear |= (fitted >= _FITTED * whole) & (most >= _PURE_SHARE * fitted)
        return np.where(clear, np.argmax(pairs, axis=0), -1)

    def _as_waves(self, motions: Motions) -> Motions:
        """Return repeated motions, whose shapes are arbitrary, as waves of one sense each."""
        values, vectors = motions.values, motions.vectors
        scale = _SAME * np.maximum(np.abs(values), abs(motions.speed)) + motions.bound
        changed, left = vectors, list(np.flatnonzero(np.isfinite(values)))
        while left:
            first = left[0]
            group = [i for i in left if abs(values[i] - values[first]) <= scale[first]]
            left = [i for i in left if i not in group]
            if len(group) > 1:
                turned = self.extremal(vectors[:, :, group])
                changed = vectors.astype(complex) if changed is vectors else changed
                changed[:, :, group] = turned
        if changed is vectors:
            return motions
        return Motions(motions.speed, values, changed, motions.orders, motions.bound)

    def extremal(self, vectors: np.ndarray, weights: np.ndarray | None = None) -> np.ndarray:
        """Return combinations of motions (h, c, g) whose mean wave number is extremal.

        Or the mean of other weights (h, w) of harmonics and forms.
        """
        flat = vectors.reshape(-1, vectors.shape[2])
        flat = flat / np.abs(flat).max(axis=0)
        span, lengths, _ = np.linalg.svd(flat, full_matrices=False)
        if lengths[-1] < 1e-3 * lengths[0]:  # a defective eigenvalue has one shape only
            return vectors
        span = span.reshape(vectors.shape)
        # 0.4 lies between the waves, so that axial motion parts from torsion
        weights = np.tile(self.waves, (len(span), 1)) if weights is None else weights
        means = np.tensordot(weights, self.forms, axes=1) + 0.4 * self.axial
        form = sum(x.conj().T @ F @ x for x, F in zip(span, means, strict=True))
        whole = sum(x.conj().T @ (self.whole + self.standing) @ x for x in span)
        sizes, parts = la.eigh(0.5 * (whole + whole.conj().T))
        seen = sizes > 1e-9 * max(sizes[-1], 1e-300)  # others move nothing that has waves
        unit = parts[:, seen] / np.sqrt(sizes[seen])
        _, inner = la.eigh(unit.conj().T @ (0.5 * (form + form.conj().T)) @ unit)
        turn = np.hstack([parts[:, ~seen], unit @ inner])
        turned = span @ (turn / np.abs(turn).max(axis=0))
        return turned / np.linalg.norm(turned.reshape(-1, turned.shape[2]), axis=0)


def _forms_of(body: RotorBody, n: int, W: np.ndarray, place: slice, k: int) -> list:
    """Return the forms of a wave, for each kind of coordinates that turn alike."""
    found = []
    parts = {0: W}
    if body.mean:
        turning = body.alone.turning
        parts = {s: (W @ turning.T) * (turning.waves == s) @ turning.T.conj().T for s in (-1, 0, 1)}
    for s, rows in parts.items():
        if not np.any(np.abs(rows) > 0.0):
            continue
        form = np.zeros((k, k), dtype=complex)
        form[place, place] = rows.conj().T @ rows
        found.append((n, n * body.ratio - s * body.drift, n * body.ratio, form))
    return found


def _components(points: np.ndarray, motion: np.ndarray, axial: np.ndarray) -> dict[str, np.ndarray]:
    u1, u2, _ = motion.reshape(len(points), 3, -1).transpose(1, 0, 2)
    angle = np.arctan2(points[:, 1], points[:, 0])[:, None]
    return {
        "axial": axial,
        "tangential": np.cos(angle) * u2 - np.sin(angle) * u1,
        "radial": np.cos(angle) * u1 + np.sin(angle) * u2,
        "whole": motion,
    }


def energy_of(forms: np.ndarray, vectors: np.ndarray) -> np.ndarray:
    """Return the energies (h, w, k) of harmonics (h, c, k)."""
    moved = forms[None] @ vectors[:, None]
    return np.sum(vectors[:, None].conj() * moved, axis=2).real


def _strongest(energy: np.ndarray, multiples: np.ndarray) -> np.ndarray:
    """Return which entry (h, w) has the strongest wave of the strongest frequency, shape (k,).

    Waves of one of the `multiples` (h, w) of Ω have one frequency seen from outside.
    """
    flat = energy.reshape(-1, energy.shape[2])
    known, place = np.unique(np.round(multiples.ravel(), 6), return_inverse=True)
    together = np.zeros((known.size, flat.shape[1]))
    np.add.at(together, place, flat)
    first = np.argmax(together, axis=0)
    return np.argmax(np.where(place[:, None] == first, flat, -1.0), axis=0)


def _still(found: Named) -> Named:
    """Return names of which motions that do not oscillate have the frequency 0."""
    growth, speed = found.motions.values.real, abs(found.motions.speed)
    moves = oscillates(growth, found.inertial, found.motions.bound)
    # what is over before the rotor turns has no frequency of its own
    moves &= oscillates(growth, found.rotor) | (-growth <= _GONE * speed)
    decays = growth < -found.motions.bound
    lateral = np.isin(found.codes, (FORWARD, BACKWARD, MIXED, STATIC))
    codes = np.where(lateral & ~moves, np.where(decays, OVERDAMPED, STATIC), found.codes)
    return found._replace(inertial=np.where(moves, found.inertial, 0.0), codes=codes)


def oscillates(
    growth: np.ndarray, frequency: np.ndarray, bound: float | np.ndarray = 0.0
) -> np.ndarray:
    """Return where motions oscillate seen from outside: neither overdamped nor free."""
    return frequency > np.maximum(_NO_OSCILLATION * np.abs(growth), bound)


def damping_of(growth: np.ndarray, frequency: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
    """Return damping ratio and logarithmic decrement at inertial frequencies [rad/s].

    The ratio lies from −1 to 1. The decrement is NaN where a motion decays or grows without
    oscillating.
    """
    size = np.hypot(growth, frequency)
    still = ~oscillates(growth, frequency)
    ratio = np.where(still, -np.sign(growth), -growth / np.where(size > 0.0, size, 1.0))
    decrement = -2.0 * np.pi * growth / np.where(still, np.nan, frequency)
    return ratio + 0.0, np.where(growth == 0.0, 0.0, decrement) + 0.0


def families(codes: np.ndarray, diameters: np.ndarray) -> np.ndarray:
    """Return which of :data:`FAMILIES` modes belong to, from whirl codes and nodal diameters."""
    special = {TORSIONAL: 1, AXIAL: 2, RADIAL: 4, UNKNOWN: 4, FOUNDATION: 5}
    kinds = np.where(np.asarray(diameters) >= 2, 3, 0)
    for code, kind in special.items():
        kinds = np.where(np.asarray(codes) == code, kind, kinds)
    return np.array(FAMILIES)[kinds]


def signed_diameters(codes: np.ndarray, diameters: np.ndarray) -> np.ndarray:
    """Return the signed nodal diameters, ascending from backward to forward waves."""
    signs = np.where(codes == FORWARD, 1, np.where(codes == BACKWARD, -1, 0))
    return signs * diameters


def names_of(motions: Sequence[Motions], content: Content) -> list[Named]:
    """Return the motions at several speeds with their names."""
    return [content.named(each) for each in motions]


__all__ = ["FAMILIES", "WHIRLS", "Content", "Named", "damping_of", "families", "names_of",
           "oscillates", "rotors_of", "signed_diameters"]  # fmt: skip
