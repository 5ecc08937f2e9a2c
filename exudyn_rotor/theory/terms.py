"""Every block of the equations of motion by its name and by the number of its equation.

The blocks are written out as the paper prints them, from the invariants of a
:class:`~exudyn_rotor.theory.motion.Motion`, which has the same equations arranged for a time step.
With centrifugal stiffening ``Ĉ = C − K2`` and ``W = G + B`` take the place of C and G, as there.

Equation numbers: Zwölfer, Rasmussen, Santos, SSRN 4830498.
"""

from __future__ import annotations

import re
from collections.abc import Iterable
from typing import NamedTuple

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike

from exudyn_rotor.theory.axis import skew
from exudyn_rotor.theory.formulation import FloatingFrame, Instant


class Term(NamedTuple):
    """A block of the equations of motion."""

    name: str  # symbol: t, θ, ζ stand for translation, spin angle and modal coordinates
    equation: str  # numbers in the paper, e.g. '84' or '110–114'; empty for what it does not have
    # in SI units; A and what it turns in inertial axes, all else in rotor axes
    value: float | np.ndarray | sp.csr_array
    meaning: str

    @property
    def numbers(self) -> frozenset[int]:
        """The numbers of `equation` one by one."""
        ends = (re.findall(r"\d+", part) for part in self.equation.split(","))
        return frozenset(n for end in ends if end for n in range(int(end[0]), int(end[-1]) + 1))


class Terms(dict[str | int, Term]):
    """Blocks by their names, or by the number of an equation that only one of them has.

    Examples
    --------
    >>> from exudyn_rotor.theory.terms import Term, Terms
    >>> terms = Terms([Term("M_θθ", "75, 85", 4.0, "moment of inertia about the axis")])
    >>> terms["M_θθ"].equation, terms[85].value
    ('75, 85', 4.0)
    >>> print(terms)
    M_θθ      75, 85        ()           moment of inertia about the axis
    """

    def __init__(self, terms: Iterable[Term]) -> None:
        super().__init__({term.name: term for term in terms})

    def __missing__(self, key: str | int) -> Term:
        """Return the one block of an equation."""
        found = [term for term in self.values() if key in term.numbers]
        if len(found) == 1:
            return found[0]
        names = ", ".join(term.name for term in found) or "no block"
        raise KeyError(f"{key}: {names}; ask by a name out of {', '.join(self)}")

    def __str__(self) -> str:
        """Return a line per block: name, equation, shape, meaning."""
        return "\n".join(
            f"{term.name:9} {term.equation:13} {np.shape(term.value)!s:12} {term.meaning}"
            for term in self.values()
        )


def terms_of(motion: FloatingFrame, t: float, q: ArrayLike, q_t: ArrayLike) -> Terms:
    """Return all blocks of a motion at an instant, those of coordinates that it prescribes, too.

    Of the full model (Ψ = I) its own numbers of equations stand first.
    """
    now = motion.at(t, q, q_t)
    parts = [_invariants(motion), _translation(motion, now), _in_plane(motion, now)]
    parts += [_spin_and_modes(motion, now), _prescribed(motion, now, t), _gravity(motion, now)]
    return Terms(term for part in parts for term in part)


def _invariants(motion: FloatingFrame) -> list[Term]:
    inv, spin, turn = motion.invariants, motion.spin_terms, skew(motion.invariants.direction)
    terms = [
        Term("m", "31", inv.mass, "mass"),
        Term("χ", "32", inv.center, "centre of mass"),
        Term("χ*", "67", motion.static_unbalance / inv.mass, "ẽχ"),
        Term("χ**", "68", turn @ motion.static_unbalance / inv.mass, "ẽẽχ"),
        Term("M_ψψ", "34", inv.M, "mass matrix"),
        Term("K_ψψ", "19", inv.K, "stiffness matrix"),
        Term("D_ψψ", "20", inv.D, "damping matrix"),
        Term("M_φψ", "37", inv.S, "first moments of mass of the modes, ΦᵀMΨ"),
        Term("M*_φψ", "69", motion.S1, "ẽM_φψ"),
        Term("M**_φψ", "70", turn @ motion.S1, "ẽẽM_φψ"),
        Term("Θ*_u", "79", inv.Theta, "moment of inertia about the axis, undeformed"),
        Term("M*_ψ̃ψ", "80", inv.G, "G, gyroscopic matrix"),
        Term("M*_ψ̃ψ̃", "81", inv.C, "C, spin softening per ω²"),
        Term("M*_x̃ψ", "82", -inv.g, "−g"),
        Term("M*_x̃ψ̃", "83", inv.h, "h, centrifugal load per ω²"),
        Term("Ĉ", "", spin.C_hat, "C less the centrifugal stiffness K2"),
        Term("W", "", spin.W, "G and the stiffness B of the Euler field"),
    ]
    return terms if spin.K4 is None else [*terms, Term("K4", "", spin.K4, "stiffness per ω⁴")]


def _translation(motion: FloatingFrame, now: Instant) -> list[Term]:
    inv = motion.invariants
    coupling, force = now.A @ motion.unbalance(now.zeta), now.A @ _inertia_force(motion, now)
    return [
        Term("A", "55", now.A, "rotor axes → inertial axes"),
        Term("M_tt", "41", inv.mass * np.eye(3), "mI"),
        Term("M_tζ", _number(motion, "43", "58"), now.A @ inv.S, "A M_φψ"),
        Term("M_tθ", _number(motion, "65", "58"), coupling, "A (mχ* + M*_φψ ζ)"),
        Term("Q_t", _number(motion, "66", "58"), force, "centrifugal, Coriolis"),
    ]


def _in_plane(motion: FloatingFrame, now: Instant) -> list[Term]:
    if motion.formulation.translation_count != 2:
        return []
    inv, A = motion.invariants, motion.free_directions.T @ now.A
    numbers = _number(motion, "95–97", "94")
    force = A @ _inertia_force(motion, now)
    return [
        Term("A*", "91", A, "NᵀA"),
        Term("M*_tt", numbers, inv.mass * np.eye(2), "mI*"),
        Term("M*_tζ", numbers, A @ inv.S, "A* M_φψ"),
        Term("M*_tθ", numbers, A @ motion.unbalance(now.zeta), "A* (mχ* + M*_φψ ζ)"),
        Term("Q*_t", _number(motion, "98", "94"), force, "centrifugal, Coriolis"),
    ]


def _spin_and_modes(motion: FloatingFrame, now: Instant) -> list[Term]:
    """(84–87), the same as (74–77) contracted beforehand."""
    inv, spin = motion.invariants, motion.spin_terms
    omega, zeta, rate = now.omega, now.zeta, now.zeta_t
    inertia = inv.Theta + 2.0 * spin.h @ zeta + zeta @ (spin.C_hat @ zeta)
    coupling = inv.g + spin.W @ zeta
    torque = -2.0 * omega * (spin.h + spin.C_hat @ zeta) @ rate
    if motion.formulation.has_frozen_spin:
        inertia, coupling, torque = inv.Theta, inv.g, 0.5 * torque
    else:
        torque -= rate @ (spin.B @ rate)
    force = spin.load(omega) - spin.stiffness(omega) @ zeta - spin.damping(omega) @ rate
    return [
        Term("M_ζζ", _number(motion, "42"), inv.M, "mass matrix"),
        Term("M_θζ", _number(motion, "74, 84"), coupling, "(g + Wζ)ᵀ"),
        Term("M_θθ", _number(motion, "75, 85"), float(inertia), "Θ + 2hᵀζ + ζᵀĈζ"),
        Term("Q_θ", _number(motion, "76, 86"), float(torque), "Coriolis torque"),
        Term("Q_ζ", _number(motion, "77, 87"), force, "centrifugal, Coriolis"),
    ]


def _prescribed(motion: FloatingFrame, now: Instant, t: float) -> list[Term]:
    """(104), (105) of the full model, (108), (109) of component modes."""
    inv, spin, form = motion.invariants, motion.spin_terms, motion.formulation
    if form.has_spin:
        return []
    numbers = "104" if inv.is_sparse else "108"
    if form.is_constant_speed:
        numbers += ", 105" if inv.is_sparse else ", 109"
    load = spin.load(now.omega, now.omega_t)
    if form.moves_origin:
        load = load - inv.S.T @ (now.A.T @ np.asarray(form.translation.acceleration(t)))
    stiffness = inv.K + spin.stiffness(now.omega, now.omega_t)
    return [
        Term("D(ω)", numbers, inv.D + spin.damping(now.omega), "D + 2ωG"),
        Term("K(ω)", numbers, stiffness, "K + ω̇W − ω²Ĉ"),
        Term("f(ω)", numbers, load, "ω²h − ω̇g − M_φψᵀAᵀτ̈"),
    ]


def _gravity(motion: FloatingFrame, now: Instant) -> list[Term]:
    inv, g = motion.invariants, motion.gravity
    local = now.A.T @ g
    terms = [
        Term("f_g", "110–114", inv.S.T @ local, "gravity on the modal coordinates"),
        Term("f_t,g", "", inv.mass * g, "gravity on the translation"),
        Term("m_θ,g", "", float(motion.unbalance(now.zeta) @ local), "gravity on the spin"),
    ]
    if inv.is_sparse:
        terms += [
            Term("M_φ", "106", inv.S.T, "MΦ"),
            Term("f_g,inertial", "115", inv.S.T @ g, "nodal forces of gravity, inertial axes"),
        ]
    return terms


def _inertia_force(motion: FloatingFrame, now: Instant) -> np.ndarray:
    """Bracket of (66), its sign included, rotor axes."""
    centrifugal = skew(motion.invariants.direction) @ motion.unbalance(now.zeta)
    return -(now.omega**2) * centrifugal - 2.0 * now.omega * (motion.S1 @ now.zeta_t)


def _number(motion: FloatingFrame, reduced: str, full: str = "58, 94, 100") -> str:
    """Numbers of a block; those of its full form come first for a full model."""
    return f"{full}, {reduced}" if motion.invariants.is_sparse else reduced
