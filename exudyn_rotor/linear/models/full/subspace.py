"""Solutions of a full finite-element rotor in a subspace, checked by the residual.

The equations are projected on a real subspace V that serves all speeds. V begins with the rigid
motions, the lowest modes at rest and the static responses to the loads, and grows by the
preconditioned residuals of the motions wanted (generalised Davidson method), with one factorisation
of ``K + αM`` as the preconditioner, until the residual of the full equations is small. Source:
Sleijpen, Booten, Fokkema, Van der Vorst, "Jacobi–Davidson type methods for generalized
eigenproblems and polynomial eigenproblems", BIT 36 (1996).
"""

from __future__ import annotations

from collections.abc import Callable, Iterable, Mapping, Sequence
from dataclasses import replace

import numpy as np
import scipy.sparse as sp

from exudyn_rotor.linear.models.full.full_equations import FullEquations
from exudyn_rotor.linear.models.rotor.rotor_on_supports import LinearRotor
from exudyn_rotor.linear.models.rotor.spin import seeds
from exudyn_rotor.linear.periodic.floquet_modes import FloquetModes, floquet_modes
from exudyn_rotor.linear.periodic.harmonic_balance import forced_motion, senses_of_turning
from exudyn_rotor.linear.periodic.periodic_system import PeriodicSystem, UnconvergedError
from exudyn_rotor.reduction.fields import ReducedInterface
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.solvers.factor import SparseCholesky
from exudyn_rotor.solvers.lanczos import WIDE, dense_modes, is_small, lanczos_modes
from exudyn_rotor.theory.rotating_axes import axes_of
from exudyn_rotor.theory.spin_terms import SpinTerms
from exudyn_rotor.theory.stiffening import Stiffening

_MOST_ROUNDS = 40  # in which the subspace grows
_MOST_COLUMNS = 600  # that it may have
# share of the largest residual allowed below which a direction is not worth a column
_NEGLIGIBLE = 0.1


class Subspace:
    """A mass-orthonormal subspace for motions of a full rotor, which grows; see :class:`Space`.

    Parameters
    ----------
    full : FullEquations
        With its spin, see :meth:`FullEquations.with_spin`.
    count : int
        Number of modes that will be asked for.
    fastest : float
        Largest spin speed or frequency [rad/s], which sets the shift α of the preconditioner.
    loads : sequence of ndarray, each (3n,)
        All loads that will be applied, in any scaling; complex.
    held : bool
        Whether a spin that nothing holds follows θ = Ωt and is no coordinate.
    residual : float
        Largest residual r. Of a mode x, ``rᴴ(K + αM)⁻¹r`` against ``xᴴ(K + αM)x``; of a steady
        motion, against the same of the loads; square-rooted.
    """

    is_shared = True

    def __init__(
        self,
        full: FullEquations,
        count: int,
        fastest: float,
        *,
        loads: Sequence[np.ndarray] = (),
        held: bool = False,
        residual: float = 1e-7,
    ) -> None:
        self.full, self.count, self.residual = full, count, residual
        self.held = held and full.free_spin is not None
        inv = full.invariants
        stiffness = inv.K
        for support, U in zip(full.supports, full.motions, strict=True):
            spring = support.matrices(0.0)[0]
            stiffness = stiffness + U.T @ sp.csr_array(0.5 * (spring + spring.T)) @ U
        self._shifted = sp.csr_array(stiffness + _shift(stiffness, inv.M, fastest) * inv.M)
        self._factor = SparseCholesky(self._shifted)
        self.basis = np.zeros((full.size, 0))
        self._small: LinearRotor | None = None
        given = tuple(name for name in ("K2", "K4", "H") if getattr(inv, name) is not None)
        names = ("M", "K", "D", "G", "C", *given)
        self._projected = {name: np.zeros((0, 0)) for name in names}
        # one by one, so that each stays a column of its own: a free one is told by its stiffness
        spin, others = seeds(full.rotor)
        spin = spin if full.spin is None else full.spin.motion[:, None]
        for column in np.hstack([spin, others]).T:
            self.grow(column[:, None])
        self.rigid = self.basis.shape[1]
        wanted = min(2 * count + 8, full.size - 1)
        self.grow(self._lowest(wanted))
        if loads:
            columns = _parts(loads)
            self.grow(self.solve(columns[:, np.any(columns, axis=0)]))

    def _lowest(self, count: int) -> np.ndarray:
        """Return the lowest modes of the shifted stiffness."""
        mass = self.full.invariants.M
        if is_small(self.full.size, count):
            return dense_modes(self._shifted.toarray(), mass.toarray(), count)[1]
        width = WIDE if self._factor.by_blocks else 2
        return lanczos_modes(mass, self._factor.solve, count, 1e-6, width)[1]

    def at(self, speed: float) -> PeriodicSystem:
        """Return the projected equations at a spin speed [rad/s]."""
        system = self.projected.at(speed)
        # the spin is the first column
        return system.projected(np.eye(system.size)[:, 1:]) if self.held else system

    def prepared(self, speeds: Sequence[float]) -> Subspace:
        """Return the subspace itself: all speeds share it."""
        return self

    def ask_for_more(self) -> bool:
        """Raise the number of modes by a half, or return False where there are no more."""
        more = min(self.count + self.count // 2 + 1, _MOST_COLUMNS // 4, self.full.size // 4)
        if more <= self.count:
            return False
        self.count = more
        return True

    def modes(self, speed: float, tolerance: float) -> FloquetModes:
        """Return the lowest modes in |Im λ| at a spin speed, vectors in all 3n coordinates.

        Raises
        ------
        ValueError
            If the residual does not fall below its limit.
        """
        return self._converged(speed, lambda modes: np.arange(self.count), tolerance)

    def modes_at(self, speeds: Sequence[float], tolerance: float) -> None:
        """Return None: the subspace grows from speed to speed."""

    def constant_motions(self, speeds: Sequence[float]) -> None:
        """Return None, see :meth:`modes_at`."""

    def motions(
        self, speed: float, method: str, tolerance: float, shapes: bool = True
    ) -> tuple[FloquetModes, PeriodicSystem]:
        """Return one mode of each pair, those of smallest |λ|; see :class:`Space`.

        Not of smallest |Im λ|: damping of the material makes the highest modes overdamped.

        Raises
        ------
        ValueError
            For a method other than 'auto', and where `tolerance` or the residual is not reached.
        """
        if method != "auto":
            raise ValueError(
                f"method={method!r} needs a reduced rotor; a large SolidRotor takes 'auto' only"
            )

        def slowest(modes: FloquetModes) -> np.ndarray:
            return np.argsort(np.abs(modes.values), kind="stable")[: self.count]

        lowest = self._converged(speed, slowest, tolerance)
        return replace(lowest, values=lowest.values.astype(complex)), self.at(speed)

    def _converged(
        self, speed: float, choose: Callable[[FloquetModes], np.ndarray], tolerance: float
    ) -> FloquetModes:
        """Return chosen modes; the subspace has grown until they meet the full equations."""
        for _ in range(_MOST_ROUNDS):
            trial = floquet_modes(self.at(speed), tolerance=tolerance)
            modes = self._lifted(trial, choose(trial))
            errors, corrections = self._errors(speed, modes)
            if np.all(errors <= self.residual):
                return modes
            if self.basis.shape[1] > _MOST_COLUMNS:
                break
            wrong = np.repeat(errors > self.residual, corrections.shape[1] // len(errors))
            self.grow(_parts(corrections[:, wrong].T))
        raise UnconvergedError(
            f"full model at {speed:.6g} rad/s: the residual stays at {errors.max():.1e} with "
            f"{self.basis.shape[1]} vectors; ask for fewer modes or give a larger tolerance"
        )

    def _lifted(self, modes: FloquetModes, chosen: np.ndarray) -> FloquetModes:
        """Return some modes in all 3n coordinates."""
        basis = self.basis[:, 1:] if self.held else self.basis
        vectors = np.einsum("cv,hvk->hck", basis, modes.vectors[:, :, chosen])
        return replace(modes.columns(chosen), vectors=vectors)

    def holds(self, motions: Sequence[tuple[float, FloquetModes]]) -> bool:
        """Return whether motions meet the full equations; else the subspace has grown for them."""
        wrong = []
        for speed, modes in motions:
            errors, corrections = self._errors(speed, modes)
            if np.any(errors > self.residual):
                wrong += list(corrections.T)
        if wrong:
            self.grow(_parts(wrong))
        return not wrong

    def _errors(self, speed: float, modes: FloquetModes) -> tuple[np.ndarray, np.ndarray]:
        """Return the relative residual of each mode (k,), and corrections (3n, k h)."""
        stack = dict(zip(modes.orders.tolist(), modes.vectors, strict=True))
        left = self.full.residual(speed, modes.values, stack, torsion=self._torsion(speed))
        squared, size, corrections = 0.0, 0.0, []
        for n, residual in left.items():
            if self.held:  # but for the torque of the drive
                residual = self.full.spin.without_torque(residual)
            answer = self.solve(residual.astype(complex))
            squared = squared + np.einsum("ck,ck->k", residual.conj(), answer).real
            size = size + np.einsum("ck,ck->k", stack[n].conj(), self._shifted @ stack[n]).real
            corrections.append(answer)
        errors = np.sqrt(np.maximum(squared, 0.0) / size)
        return errors, np.stack(corrections, axis=2).reshape(self.full.size, -1)

    def steady_motion(
        self, speed: float, loads: Mapping[int, np.ndarray], rate: float, tolerance: float
    ) -> dict[int, np.ndarray]:
        """Return the harmonics (3n,) of the steady motion under harmonics of a load, rotor frame.

        Raises
        ------
        ValueError
            If there is no steady motion, or the residual does not fall below its limit.
        """
        if speed == 0.0:  # θ stands still: all harmonics are one
            loads = {0: sum(loads.values())}
        size = self._size(loads.values())
        # the spin where no support resists it: the drive does
        driven = () if self.full.free_spin is None or self.held else (0,)
        first = int(self.held)
        for _ in range(_MOST_ROUNDS):
            basis = self.basis
            projected = {n: basis.T[first:] @ load for n, load in loads.items()}
            motion = forced_motion(self.at(speed), projected, rate, tolerance, driven)
            motion = {n: np.pad(x, (first, 0)) for n, x in motion.items()}
            error, corrections = self._left(speed, rate, loads, motion, size)
            if error <= self.residual:
                return {n: basis @ x for n, x in motion.items()}
            self.grow(corrections)
            if not basis.shape[1] < self.basis.shape[1] <= _MOST_COLUMNS:
                break
        raise UnconvergedError(
            f"full model at {speed:.6g} rad/s: the residual stays at {error:.1e} of the loads with "
            f"{self.basis.shape[1]} vectors, above residual={self.residual:.1e}; give a larger "
            "one, or reduce the rotor"
        )

    def steady_motions(
        self, speed: float, loads: Sequence[Mapping[int, np.ndarray]], rate: float, tolerance: float
    ) -> list[dict[int, np.ndarray]]:
        """Return the steady motion under each of several loads, with its own corrections each."""
        return [self.steady_motion(speed, each, rate, tolerance) for each in loads]

    def _size(self, forces: Iterable[np.ndarray]) -> float:
        """Return the norm of forces, the root of ``Σ fᴴ(K + αM)⁻¹f``."""
        stack = _parts(forces)
        return float(np.sqrt(np.sum(stack * self.solve(stack))))

    def _left(
        self,
        speed: float,
        rate: float,
        loads: Mapping[int, np.ndarray],
        motion: Mapping[int, np.ndarray],
        size: float,
    ) -> tuple[float, np.ndarray]:
        """Return the relative residual, and the directions (3n, c) that would lower it."""
        basis = self.basis
        stack = {n: (basis @ x)[:, None] for n, x in motion.items()}
        free = self.rigid
        strained = {n: (basis[:, free:] @ x[free:])[:, None] for n, x in motion.items()}
        left = self.full.residual(
            speed, np.array([1j * rate]), stack, strained, self._torsion(speed)
        )
        columns, H = [], self.full.invariants.H
        for n, force in left.items():
            force = force[:, 0] - loads.get(n, 0.0)
            if self.held:  # but for the torque of the drive
                force = self.full.spin.without_torque(force[:, None])[:, 0]
            sense = senses_of_turning(rate, n, speed)
            if H is not None:
                force = force + 1j * sense * (H @ strained[n][:, 0])
            if sense == 0.0:
                force = self._without_rigid(force)
            columns += [force.real, force.imag]
        residual = np.column_stack(columns)
        answer = self.solve(residual)
        squares = np.maximum(np.sum(residual * answer, axis=0), 0.0) / size**2
        worth = np.sqrt(squares) > _NEGLIGIBLE * self.residual
        return float(np.sqrt(squares.sum())), answer[:, worth]

    def _without_rigid(self, force: np.ndarray) -> np.ndarray:
        """Return a constant force (3n,) without its resultants.

        The projected equations hold for rigid motions. What is left there is the torque of the
        drive, and the rounding of loads on free motions, which harmonic balance takes out.
        """
        rigid = self.basis[:, : self.rigid]
        return force - self.full.invariants.M @ (rigid @ (rigid.T @ force))

    @property
    def projected(self) -> LinearRotor:
        """The rotor in the basis, with its supports."""
        if self._small is None:
            self._small = self._project()
        return self._small

    def _project(self) -> LinearRotor:
        full, rotor = self.full, self.full.rotor
        inv = full.invariants
        blocks = {name: X.copy() for name, X in self._projected.items()}
        # exactly, so that rounding does not hold what is free
        for name in {"K", "H"} & blocks.keys():
            blocks[name][: self.rigid] = blocks[name][:, : self.rigid] = 0.0
        # as one contiguous matrix, which is many times faster than nine products
        P = (np.ascontiguousarray(inv.P).reshape(9, -1) @ self.basis).reshape(3, 3, -1)
        invariants = replace(inv, S=inv.S @ self.basis, P=P, **blocks)
        V, W = full.tilt
        interfaces = {
            s.interface: ReducedInterface(
                rotor.interfaces[s.interface].reference,
                rotor.interfaces[s.interface].center,
                rotor.interfaces[s.interface].radius,
                np.kron(np.eye(2), axes_of(full.axis)) @ (U @ self.basis),
            )
            for s, U in zip(full.supports, full.motions, strict=True)
        }
        reduced = ReducedRotor(
            full.axis, rotor.center_of_mass, invariants, (), interfaces, blocks["M"]
        )
        unit = np.eye(1, self.basis.shape[1])[0]
        spin = full.spin
        if spin is not None:
            whirling = self.basis.T @ spin.whirling
            spin = replace(spin, motion=unit, momentum=unit, whirling=whirling)
        tilt = V @ self.basis
        K2 = tilt.T @ W @ tilt + blocks.get("K2", 0.0)
        levels = Stiffening(0.5 * (K2 + K2.T), 0.0 * K2, blocks.get("K4"))
        terms = SpinTerms.of(invariants, levels)
        return LinearRotor(
            reduced, full.supports, invariants, terms, spin, stiffening=full.stiffening
        )

    def solve(self, forces: np.ndarray) -> np.ndarray:
        """Return ``(K + αM)⁻¹ f`` for forces (3n, k), real or complex."""
        if np.iscomplexobj(forces):
            return self._factor.solve(forces.real) + 1j * self._factor.solve(forces.imag)
        return self._factor.solve(forces)

    def _torsion(self, speed: float) -> float:
        """Return the stiffness of a coupled spin by steady forces, see :class:`LinearRotor`."""
        spin = self.full.spin
        return self.projected.steady_torsion(speed) if spin is not None and spin.coupled else 0.0

    def grow(self, columns: np.ndarray) -> None:
        """Add directions to the basis, and their rows and columns to the projected matrices."""
        if columns.shape[1] == 0:
            return
        inv = self.full.invariants
        # scaled first, so that rounding can be told from small corrections
        columns = columns / np.sqrt(np.maximum(_norms(columns, inv.M), 1e-300))
        for _ in range(3):
            columns = columns - self.basis @ (self.basis.T @ (inv.M @ columns))
            gram = columns.T @ (inv.M @ columns)
            values, turn = np.linalg.eigh(0.5 * (gram + gram.T))
            independent = values > 1e-13
            columns = columns @ (turn[:, independent] / np.sqrt(values[independent]))
        for name in self._projected:
            image = getattr(inv, name) @ columns
            side, corner = self.basis.T @ image, columns.T @ image
            sign = -1.0 if name == "G" else 1.0
            old = self._projected[name]
            self._projected[name] = np.block(
                [[old, side], [sign * side.T, 0.5 * (corner + sign * corner.T)]]
            )
        self.basis = np.hstack([self.basis, columns])
        self._small = None


def _parts(columns: Iterable[np.ndarray]) -> np.ndarray:
    """Return real and imaginary parts of vectors (3n,) as columns."""
    return np.column_stack([part for column in columns for part in (column.real, column.imag)])


def _shift(stiffness: sp.csr_array, mass: sp.csr_array, speed: float) -> float:
    """Return α [1/s²] of the order of the lowest flexible modes; it only steers convergence."""
    mesh = np.median(stiffness.diagonal()) / np.median(mass.diagonal())
    elements_across = max(mass.shape[0] / 3.0, 1.0) ** (1.0 / 3.0)
    # no stiffness along most directions, as of masses on a rod: any shift tells free motions apart
    return max(speed**2, mesh / (10.0 * elements_across) ** 2) or 1.0


def _norms(columns: np.ndarray, mass: sp.csr_array) -> np.ndarray:
    return np.einsum("ck,ck->k", columns, mass @ columns)
