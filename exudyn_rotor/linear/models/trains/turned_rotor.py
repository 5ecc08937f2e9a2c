"""One rotor of several, in axes that turn with the common speed Ω instead of its own rΩ.

With α = wθ, w = r − 1, and the generator G of :mod:`exudyn_rotor.linear.models.trains.turning`, the
rotor's own coordinates are ``x = exp(−Gα) y``. Its equations ``Mẍ + Dẋ + Kx = f`` become

    M ÿ + (D − 2wΩ M G) ẏ + (K − wΩ D G + w²Ω² M G²) y = f,

each matrix X of the rotor in ``exp(−Gα)ᵀ X exp(−Gα)``, which is constant for an axisymmetric one.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np

from exudyn_rotor.cached import cached_property
from exudyn_rotor.linear.models.fourier_terms import add, whole
from exudyn_rotor.linear.models.rotor.rotor_on_supports import LinearRotor
from exudyn_rotor.linear.models.trains.turning import Turning
from exudyn_rotor.linear.periodic.periodic_system import Terms
from exudyn_rotor.theory.rotating_axes import axes_of


@dataclass(frozen=True, eq=False)
class TurnedRotor:
    """A rotor without supports in axes that turn with Ω.

    Attributes
    ----------
    name : str
    alone : LinearRotor
        The rotor, in its own frame.
    ratio : float
        r, its speed over Ω.
    turning : Turning or None
        None for the ratio 1 as it is, see :meth:`evened`.
    unevenness : float
        Share of its matrices, in slow motions, that is not axisymmetric; 0 for the ratio 1.
    is_even : bool
        Whether it is taken for axisymmetric, by the mean of its matrices over a turn.
    frame : {1.0, 0.0}
        Whether the axes turn with Ω, or stand still: w = r − 1 or r.
    """

    name: str
    alone: LinearRotor
    ratio: float
    turning: Turning | None = None
    unevenness: float = 0.0
    is_even: bool = True
    frame: float = 1.0

    @classmethod
    def of(
        cls,
        name: str,
        alone: LinearRotor,
        ratio: float,
        places: Sequence[str],
        largest: float,
        frame: float = 1.0,
    ) -> TurnedRotor:
        """Turn a rotor that is linked at some places; even up to a largest unevenness."""
        if ratio == frame:
            return cls(name, alone, ratio)
        turning = Turning.of(alone)
        uneven = _unevenness(alone, turning, places)
        return cls(name, alone, ratio, turning, uneven, uneven <= largest, frame)

    def evened(self) -> TurnedRotor:
        """Return the rotor, one of ratio 1 as an axisymmetric one."""
        return self if self.turning else replace(self, turning=Turning.of(self.alone))

    def mesh_unevenness(self, places: Sequence[str]) -> float:
        """Return the share that is not axisymmetric, also of a rotor that is taken as it is."""
        if self.turning is not None:
            return self.unevenness
        return _unevenness(self.alone, Turning.of(self.alone), places)

    @property
    def size(self) -> int:
        """Number of coordinates k."""
        return self.alone.size

    @property
    def drift(self) -> float:
        """w, by which its coordinates turn in its own frame, over Ω."""
        return self.ratio - self.frame

    @cached_property
    def _own(self) -> dict[str, dict[int, np.ndarray]]:
        """The matrices of the rotor by multiples of θ."""
        inv, terms = self.alone.invariants, self.alone.spin_terms
        own = {"D": inv.D, "G": inv.G, "K": inv.K, "C_hat": terms.C_hat, "K4": terms.K4}
        return {name: self._form(X) for name, X in own.items() if X is not None}

    def _form(self, X: np.ndarray) -> dict[int, np.ndarray]:
        if self.turning is None:
            return {0: X}
        return self._in_theta(self.turning.form(X))

    def _in_theta(self, terms: Terms) -> dict[int, np.ndarray]:
        """Return Fourier terms in α as those in θ; the mean where the rotor is even."""
        if self.is_even:
            return {0: terms[0]}
        what = (
            f"rotor {self.name!r}, whose unevenness is {self.unevenness:.2g} (a finer mesh has "
            "less, and a number of modes that leaves no pair of bending modes in halves; up to "
            "largest_unevenness=… its mean over a turn is taken),"
        )
        return {whole(m * self.drift, what): X for m, X in terms.items()}

    def terms(self, speed: float) -> tuple[Terms, Terms]:
        """Return the Fourier terms of damping and stiffness at Ω."""
        own, r, w = self._own, self.ratio, self.drift
        D, K = dict(own["D"]), dict(own["K"])
        for n, X in own["G"].items():
            add(D, n, 2.0 * r * speed * X)
        for n, X in own["C_hat"].items():
            add(K, n, -((r * speed) ** 2) * X)
        for n, X in own.get("K4", {}).items():
            add(K, n, (r * speed) ** 4 * X)
        if w != 0.0:
            G = self.turning.generator
            MG = self.alone.invariants.M @ G
            for n, X in D.items():
                add(K, n, -w * speed * X @ G)
            add(K, 0, (w * speed) ** 2 * MG @ G)
            add(D, 0, -2.0 * w * speed * MG)
        return D, K

    def motion(self, interface: str) -> Terms:
        """Return the motion (6, k) of an interface that supports see: without a free spin's."""
        U, spin = self.alone.interface_motion(interface), self.alone.spin
        if spin is not None:
            shift = np.r_[-(U @ spin.motion)[:3], np.zeros(3)]
            U = U + np.outer(shift, spin.momentum)
        return self._turned(U)

    def seen(self, interface: str) -> Terms:
        """Return the motion (6, k) of an interface."""
        return self._turned(self.alone.interface_motion(interface))

    def _turned(self, U: np.ndarray) -> Terms:
        return {0: U} if self.turning is None else self._in_theta(self.turning.motion(U))

    @cached_property
    def base_loads(self) -> np.ndarray:
        """Loads of unit accelerations of the ground, shape (3, k), of the axisymmetric part."""
        loads = self.alone.base_loads
        if self.drift == 0.0:
            return loads
        return self.turning.motion(np.vstack([loads, 0.0 * loads]))[0][:3]


def _unevenness(rotor: LinearRotor, turning: Turning, places: Sequence[str]) -> float:
    """Return the largest share of matrices and motions that is not axisymmetric."""
    inv, terms = rotor.invariants, rotor.spin_terms
    forms = [X for X in (inv.K, inv.G, terms.C_hat, terms.K4) if X is not None]
    shares = [turning.unevenness(turning.form(X), X) for X in forms]
    axes = axes_of(rotor.rotor.axis).T
    mean = np.vstack([axes @ inv.S / inv.mass, rotor.radius * axes @ inv.mean_rotation])
    lateral = np.repeat([1.0, 0.0], 3)[:, None]
    motions = [mean, *(lateral * rotor.interface_motion(name) for name in places)]
    return max(shares + [turning.unevenness_at(turning.motion(U), U) for U in motions])
