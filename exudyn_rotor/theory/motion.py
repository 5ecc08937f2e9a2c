"""Equations of motion of every formulation: mass matrix, forces, Jacobian.

Coordinates ``q = (τ, θ, ζ)``, of which only the unknown ones exist. The terms stand in
:mod:`exudyn_rotor.theory.kernel`, and block by block as the paper prints them in
:mod:`exudyn_rotor.theory.terms`.

The kinetic energy behind the terms, with ``W = G + B`` and ``Ĉ = C − K2``
(:mod:`exudyn_rotor.theory.stiffening`; the paper's equations are B = K2 = 0), is

    T = ½m|τ̇|² + τ̇·A(ω(mχ* + S*ζ) + Sζ̇) + ½ω²(Θ + 2hᵀζ + ζᵀĈζ) + ωζ̇ᵀ(g + Wζ) + ½ζ̇ᵀMζ̇

Of a *frozen* free spin T lacks ``½ω²c + ωζ̇ᵀWζ`` with ``c = 2hᵀζ + ζᵀĈζ``, so that (85) is Θ and
(84) is g (``docs/theory/equations.md``). A static displacement adds ``−½ω⁴ζᵀK4ζ`` to the
Lagrangian function: the force ``−ω⁴K4ζ`` on the modes. A free spin does not take it.

Equation numbers: Zwölfer, Rasmussen, Santos, SSRN 4830498.
"""

from __future__ import annotations

from functools import cached_property
from typing import NamedTuple

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.theory.formulation import FloatingFrame
from exudyn_rotor.theory.kernel import ConstantPart, Kernel, constant_part
from exudyn_rotor.theory.terms import Terms, terms_of


class Energy(NamedTuple):
    """Energy of a rotor at an instant [J].

    Attributes
    ----------
    kinetic : float
        In the inertial frame, the spin included.
    elastic : float
    weight : float
        Potential of the weight; zero where the rotor stands as in its mesh, undeformed, at θ = 0.
    """

    kinetic: float
    elastic: float
    weight: float


class Motion(FloatingFrame):
    """Equations of motion ``M(q) q̈ = f(t, q, q̇)`` of one formulation.

    Methods take the time t [s], and the unknowns q and their rates q_t, shape (size,): translations
    [m], the angle θ [rad], modal coordinates.

    Parameters
    ----------
    invariants : Invariants
        With the origin on the spin axis.
    formulation : Formulation
    second_order : Stiffening
    orientation : ndarray, shape (3, 3), optional
        Rotation from rotor axes at θ = 0 to inertial axes.
    plane : array_like, shape (3, 2), optional
        Inertial directions of the in-plane translations, ``N`` (89). Of no effect where the
        formulation has none; any number of columns will do then.
    gravity : array_like, shape (3,), optional
        Acceleration, inertial axes [m/s²] (App. A).

    Attributes
    ----------
    size : int
        Number of unknowns: translations, then θ, then modal coordinates.
    free_directions : ndarray, shape (3, 0…3)
        Inertial directions of the unknown translations, ``N`` (89).
    spin_terms : SpinTerms
        What the spin adds to the equations of the modal coordinates.
    translations, modes : slice
        Where the translations and the modal coordinates stand among the unknowns.
    is_coupled, has_body_force : bool
        Whether translations are coupled with other unknowns, and whether gravity or the frame's
        acceleration acts on any but them. Terms that vanish are left out of every step.
    weight : ndarray
        Gravity on the unknown translations [N].

    Raises
    ------
    TypeError, ValueError
        If shapes do not fit, an entry is not finite, or the orientation is no rotation. The
        methods refuse coordinates of a wrong number or kind alike.

    Examples
    --------
    A unit mass at x = 2 on springs of 9 N/m, spinning freely at 1 rad/s:

    >>> import numpy as np
    >>> from exudyn_rotor import Formulation, Invariants, Motion
    >>> from exudyn_rotor.theory.stiffening import stiffening
    >>> unit = np.eye(3)
    >>> point = Invariants.of([[2.0, 0, 0]], unit, 9.0 * unit, None, unit, [0, 0, 1])
    >>> motion = Motion(point, Formulation("none", "free"), stiffening(point, "none"))
    >>> rest, spinning = np.zeros(4), np.array([1.0, 0, 0, 0])  # θ, then the displacements
    >>> print(motion.forces(0.0, rest, spinning), motion.energy(0.0, rest, spinning).kinetic)
    [0. 2. 0. 0.] 2.0
    """

    @cached_property
    def _kernel(self) -> Kernel:
        return Kernel(self, range(self.size), self.size)

    @cached_property
    def _constant_part(self) -> ConstantPart:
        return constant_part(self)

    @cached_property
    def _constant_mass(self) -> np.ndarray:
        """(41) and (42); of a spin (84) and (85) without displacements."""
        inv, spin, mass = self.invariants, self._spin, np.zeros((self.size, self.size))
        mass[self.translations, self.translations] = inv.mass * np.eye(self.translations.stop)
        mass[self.modes, self.modes] = inv.M
        if self.formulation.has_spin:
            mass[spin, spin], mass[spin, self.modes] = inv.Theta, inv.g
            mass[self.modes, spin] = inv.g[:, None]
        return mass

    @property
    def is_constant(self) -> bool:
        """True when all matrices and forces are constant: Eq. (109) and its uncoupled kin."""
        form = self.formulation
        varies = self.is_coupled or form.moves_origin or self.has_body_force
        return form.is_constant_speed and not varies

    def mass_matrix(self, t: float, q: ArrayLike) -> np.ndarray:
        """Return the mass matrix (65, 41–43, 84, 85), shape (size, size)."""
        kernel, mass = self._kernel, self._constant_mass.copy()
        values = kernel.mass_entries(checks.number(t, "t", "s"), self._checked(q, "q").tolist())
        mass[kernel.rows, kernel.columns] = mass[kernel.columns, kernel.rows] = values
        return mass

    def forces(self, t: float, q: ArrayLike, q_t: ArrayLike) -> np.ndarray:
        """Return velocity-dependent, elastic, damping and gravity forces, shape (size,).

        (66), (86), (87), the prescribed accelerations of (108), and App. A.
        """
        t, q, q_t = checks.number(t, "t", "s"), self._checked(q, "q"), self._checked(q_t, "q_t")
        fixed = self._constant_part
        constant = fixed.force - fixed.stiffness @ q - fixed.damping @ q_t
        return constant + self._kernel.forces(t, q.tolist(), q_t.tolist())

    def jacobian(self, t: float, q: ArrayLike, q_t: ArrayLike) -> tuple[np.ndarray, np.ndarray]:
        """Return the derivatives of :meth:`forces` by q and by q̇, each (size, size)."""
        t, q, q_t = checks.number(t, "t", "s"), self._checked(q, "q"), self._checked(q_t, "q_t")
        state, fixed = (t, q.tolist(), q_t.tolist()), self._constant_part
        by_q = -fixed.stiffness - self._kernel.jacobian(*state, 1.0, 0.0)
        by_v = -fixed.damping - self._kernel.jacobian(*state, 0.0, 1.0)
        return by_q, by_v

    def energy(
        self, t: float, q: ArrayLike, q_t: ArrayLike, gravity: ArrayLike | None = None
    ) -> Energy:
        """Return the energy in the inertial frame, θ and τ unknowns or prescribed.

        The kinetic energy is T of :mod:`exudyn_rotor.theory.motion`, from the velocities
        ``τ̇ + A (ω ẽ r + Ψζ̇)``, less ``(3/2)ω⁴ζᵀK4ζ`` with a stiffness per ω⁴. `gravity` (3,) is
        along inertial axes [m/s²], by default that of the equations.
        """
        now, q, q_t = self.at(t, q, q_t), np.asarray(q), np.asarray(q_t)
        g = self.gravity if gravity is None else checks.vector(gravity, "gravity", "m/s²")
        form, inv, terms = self.formulation, self.invariants, self.spin_terms
        omega, zeta, zeta_t = now.omega, now.zeta, now.zeta_t
        if form.moves_origin:
            moved = form.translation
            shift, rate = (np.asarray(f(t), dtype=float) for f in (moved.value, moved.rate))
        else:
            shift, rate = (self.free_directions @ x[self.translations] for x in (q, q_t))
        # a frozen spin has the inertia of the undeformed rotor, so that its equations keep the sum
        bent = np.zeros_like(zeta) if form.has_frozen_spin else zeta
        kinetic = (
            0.5 * inv.mass * rate @ rate
            + rate @ now.A @ (inv.S @ zeta_t + omega * self.unbalance(zeta))
            + 0.5 * omega**2 * self._spin_inertia(bent)
            + omega * (terms.g + terms.W @ bent) @ zeta_t
            + 0.5 * zeta_t @ (inv.M @ zeta_t)
            - 1.5 * omega**4 * self._fourth(bent)
        )
        place = shift + (now.A - self.orientation) @ inv.center
        weight = -g @ (inv.mass * place + now.A @ (inv.S @ zeta))
        return Energy(float(kinetic), float(0.5 * zeta @ (inv.K @ zeta)), float(weight))

    def terms(self, t: float, q: ArrayLike, q_t: ArrayLike) -> Terms:
        """Return every block by its name and equation; see :mod:`exudyn_rotor.theory.terms`."""
        return terms_of(self, t, q, q_t)

    def drive_torque(self, t: float, q: ArrayLike, q_t: ArrayLike, zeta_tt: ArrayLike) -> float:
        """Return the torque about e that a prescribed spin needs, external loads left out [N m].

        The row of θ that a prescribed spin removes: (84–86) times the accelerations.
        """
        terms, now = self.spin_terms, self.at(t, q, q_t)
        zeta_tt = checks.vector(zeta_tt, "zeta_tt", size=self.invariants.size)
        inertia = self._spin_inertia(now.zeta) - 6.0 * now.omega**2 * self._fourth(now.zeta)
        torque = inertia * now.omega_t
        torque += (terms.g + terms.W @ now.zeta) @ zeta_tt
        torque += 2.0 * now.omega * (self._centrifugal(now.zeta) @ now.zeta_t)
        torque += now.zeta_t @ (terms.B @ now.zeta_t)
        if terms.K4 is not None:
            torque -= 4.0 * now.omega**3 * (now.zeta @ (terms.K4 @ now.zeta_t))
        if self.has_body_force:
            torque -= self.unbalance(now.zeta) @ self.body_acceleration(t, now.A)
        return float(torque)

    def body_acceleration(self, t: float, A: np.ndarray) -> np.ndarray:
        """Return gravity less the frame's prescribed acceleration (108), rotor axes [m/s²]."""
        acceleration = self.gravity
        if self.formulation.moves_origin:
            prescribed = self.formulation.translation.acceleration(t)
            acceleration = acceleration - np.asarray(prescribed, dtype=float)
        return A.T @ acceleration

    def body_forces(self, t: float, q: ArrayLike, acceleration: ArrayLike) -> np.ndarray:
        """Return the forces (size,) of gravity (App. A) or another uniform acceleration [m/s²]."""
        acceleration = checks.vector(acceleration, "acceleration", "m/s²")
        now, force = self.at(t, q, np.zeros(self.size)), np.zeros(self.size)
        force[self.translations] = self.invariants.mass * (self.free_directions.T @ acceleration)
        self._add_body_force(now.zeta, now.A.T @ acceleration, force)
        return force

    def _centrifugal(self, zeta: np.ndarray) -> np.ndarray:
        """``h + Ĉζ``, the centrifugal load per ω² of (87)."""
        return self.spin_terms.h + self.spin_terms.C_hat @ zeta

    def _spin_inertia(self, zeta: np.ndarray) -> float:
        """(85)."""
        return self.invariants.Theta + (self.spin_terms.h + self._centrifugal(zeta)) @ zeta

    def _fourth(self, zeta: np.ndarray) -> float:
        """``ζᵀK4ζ``."""
        K4 = self.spin_terms.K4
        return 0.0 if K4 is None else float(zeta @ (K4 @ zeta))

    def _add_body_force(self, zeta: np.ndarray, local: np.ndarray, force: np.ndarray) -> None:
        """Add gravity (App. A) and the frame's prescribed acceleration (108), rotor axes."""
        force[self.modes] += self.invariants.S.T @ local
        if self.formulation.has_spin:
            force[self._spin] += self.unbalance(zeta) @ local
