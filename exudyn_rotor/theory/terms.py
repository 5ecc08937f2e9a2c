"""Every block of the equations of motion by its name and by the number of its equation.

The blocks are written out as the paper prints them, from the invariants of a
:class:`~exudyn_rotor.theory.motion.Motion`, which has the same equations arranged for a time step.
With centrifugal stiffening ``Ĉ = C − K2`` and ``W = G + B`` take the place of C and G, as there.

Equation numbers: Zwölfer, Rasmussen, Santos, SSRN 4830498.
"""

from __future__ import annotations

import re
from collections.abc import Iterable, Iterator, Mapping
from dataclasses import dataclass
from typing import Any, NamedTuple, Protocol

import numpy as np
import scipy.sparse as sp
from numpy.typing import ArrayLike

from exudyn_rotor.theory.formulation import Formulation
from exudyn_rotor.theory.invariants import Invariants
from exudyn_rotor.theory.nodal import skew
from exudyn_rotor.theory.spin_terms import SpinTerms


class Instant(NamedTuple):
    """One instant of a motion, split into its parts."""

    omega: float  # spin speed, and its prescribed rate; zero for a free spin, whose rate is unknown
    omega_t: float
    zeta: np.ndarray  # (m,) Modal coordinates and their rates
    zeta_t: np.ndarray
    A: np.ndarray  # (3, 3) Rotor axes → inertial axes (55)


class Equations(Protocol):
    """What the blocks and the kernel read of a :class:`~exudyn_rotor.theory.motion.Motion`."""

    invariants: Invariants
    spin_terms: SpinTerms
    formulation: Formulation
    orientation: np.ndarray
    gravity: np.ndarray
    free_directions: np.ndarray
    static_unbalance: np.ndarray
    S1: np.ndarray
    translations: slice
    modes: slice
    size: int
    weight: np.ndarray
    is_coupled: bool
    has_body_force: bool

    def at(self, t: float, q: ArrayLike, q_t: ArrayLike) -> Instant:
        """Return an instant, split into its parts."""

    def unbalance(self, zeta: np.ndarray) -> np.ndarray:
        """``mχ* + S*ζ``, the bracket of (65)."""


@dataclass(frozen=True, eq=False)
class Term:
    """A block of the equations of motion.

    Attributes
    ----------
    name : str
        Symbol: t, θ, ζ stand for translation, spin angle and modal coordinates.
    equation : str
        Numbers in the paper, e.g. ``'84'`` or ``'110–114'``; empty for what it does not have.
    value : float, ndarray or sparse array
        In SI units; A and what it turns in inertial axes, all else in rotor axes.
    meaning : str
    """

    name: str
    equation: str
    value: Any
    meaning: str

    @property
    def numbers(self) -> frozenset[int]:
        """The numbers of `equation` one by one."""
        ends = (re.findall(r"\d+", part) for part in self.equation.split(","))
        return frozenset(n for end in ends if end for n in range(int(end[0]), int(end[-1]) + 1))

    @property
    def shape(self) -> tuple[int, ...]:
        """Shape of the value; () for a number."""
        return np.shape(self.value) if not sp.issparse(self.value) else self.value.shape


class Terms(Mapping[str, Term]):
    """Blocks by their names, or by the number of an equation that only one of them has.

    ``print`` shows all of them.

    Examples
    --------
    >>> from exudyn_rotor.theory.terms import Term, Terms
    >>> terms = Terms([Term("M_θθ", "75, 85", 4.0, "moment of inertia about the axis")])
    >>> terms["M_θθ"].equation, terms[85].value
    ('75, 85', 4.0)
    >>> print(terms)
    name  equation  shape  largest  meaning
    M_θθ  75, 85    -      4        moment of inertia about the axis
    """

    def __init__(self, terms: Iterable[Term]) -> None:
        self._terms = {term.name: term for term in terms}

    def __getitem__(self, key: str | int) -> Term:
        if not isinstance(key, int) or isinstance(key, bool):
            if key in self._terms:
                return self._terms[key]
            raise KeyError(f"no block {key!r}; there are: {', '.join(self._terms)}")
        found = [term for term in self._terms.values() if key in term.numbers]
        if len(found) == 1:
            return found[0]
        names = ", ".join(term.name for term in found) or "no block"
        raise KeyError(f"equation {key}: {names}; ask by a name out of {', '.join(self._terms)}")

    def __iter__(self) -> Iterator[str]:
        return iter(self._terms)

    def __len__(self) -> int:
        return len(self._terms)

    def __repr__(self) -> str:
        return f"Terms({', '.join(self._terms)})"

    def __str__(self) -> str:
        return self.table()

    def table(self) -> str:
        """Return a line per block: name, equation, shape, largest entry, meaning."""
        lines = [("name", "equation", "shape", "largest", "meaning")]
        for term in self.values():
            shape = " × ".join(map(str, term.shape)) or "-"
            lines.append((term.name, term.equation, shape, _largest(term.value), term.meaning))
        widths = [max(map(len, column)) for column in zip(*lines, strict=True)]
        rows = ("  ".join(map(str.ljust, line, widths)).rstrip() for line in lines)
        return "\n".join(rows)


def terms_of(motion: Equations, t: float, q: ArrayLike, q_t: ArrayLike) -> Terms:
    """Return all blocks of a motion at an instant, those of coordinates that it prescribes, too.

    Parameters
    ----------
    motion : Motion
        Of component modes, or of the full model (Ψ = I), whose numbers stand first then.
    t : float
        Time [s].
    q, q_t : array_like, shape (size,)
        Unknowns of `motion` and their rates.

    Raises
    ------
    TypeError, ValueError
        For coordinates of a wrong number or kind.
    """
    now = motion.at(t, q, q_t)
    parts = [_invariants(motion), _translation(motion, now), _in_plane(motion, now)]
    parts += [_spin_and_modes(motion, now), _prescribed(motion, now, t), _gravity(motion, now)]
    return Terms(term for part in parts for term in part)


def _invariants(motion: Equations) -> list[Term]:
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


def _translation(motion: Equations, now: Instant) -> list[Term]:
    inv = motion.invariants
    coupling, force = now.A @ motion.unbalance(now.zeta), now.A @ _inertia_force(motion, now)
    return [
        Term("A", "55", now.A, "rotor axes → inertial axes"),
        Term("M_tt", "41", inv.mass * np.eye(3), "mI"),
        Term("M_tζ", _number(motion, "43", "58"), now.A @ inv.S, "A M_φψ"),
        Term("M_tθ", _number(motion, "65", "58"), coupling, "A (mχ* + M*_φψ ζ)"),
        Term("Q_t", _number(motion, "66", "58"), force, "centrifugal, Coriolis"),
    ]


def _in_plane(motion: Equations, now: Instant) -> list[Term]:
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


def _spin_and_modes(motion: Equations, now: Instant) -> list[Term]:
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


def _prescribed(motion: Equations, now: Instant, t: float) -> list[Term]:
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


def _gravity(motion: Equations, now: Instant) -> list[Term]:
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


def _inertia_force(motion: Equations, now: Instant) -> np.ndarray:
    """Bracket of (66), its sign included, rotor axes."""
    centrifugal = skew(motion.invariants.direction) @ motion.unbalance(now.zeta)
    return -(now.omega**2) * centrifugal - 2.0 * now.omega * (motion.S1 @ now.zeta_t)


def _number(motion: Equations, reduced: str, full: str = "58, 94, 100") -> str:
    """Numbers of a block; those of its full form come first for a full model."""
    return f"{full}, {reduced}" if motion.invariants.is_sparse else reduced


def _largest(value: Any) -> str:
    entries = value.data if sp.issparse(value) else np.ravel(value)
    return f"{entries[np.argmax(np.abs(entries))]:.4g}" if np.size(entries) else "-"
