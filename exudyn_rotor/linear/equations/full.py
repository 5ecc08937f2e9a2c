"""Lowest modes of a full finite-element rotor on supports, Eqs. (104) and (105).

The eigenproblem is projected on a real subspace V that serves all speeds. V begins with the lowest
modes at rest and grows by the preconditioned residuals of the modes wanted (generalised Davidson
method), with one factorisation of ``K + αM`` as the preconditioner, until the residual of the full
equations is small for each. Source: Sleijpen, Booten, Fokkema, Van der Vorst, "Jacobi–Davidson type
methods for generalized eigenproblems and polynomial eigenproblems", BIT 36 (1996).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from exudyn_rotor import checks
from exudyn_rotor.linear.equations.spin import Spin, seeds, spin_of
from exudyn_rotor.linear.equations.supports import Support, axes_of, check_interfaces
from exudyn_rotor.linear.equations.system import LinearRotor, warn_of_eccentricity
from exudyn_rotor.linear.modal.eigen import FloquetModes, floquet_modes
from exudyn_rotor.linear.modal.whirl import WhirlContent, spread
from exudyn_rotor.prestress.static_solution import relief_rotations
from exudyn_rotor.reduction.fields import ReducedInterface
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.solid_rotor import SolidRotor
from exudyn_rotor.solvers.factor import SparseCholesky
from exudyn_rotor.solvers.lanczos import lanczos_modes
from exudyn_rotor.theory.axis import SpinAxis
from exudyn_rotor.theory.invariants import Invariants
from exudyn_rotor.theory.stiffening import LEVELS, NO_PRESTRESS, relief_factors, tilt_factors

_MOST_ROUNDS = 40
_MOST_COLUMNS = 600


def _invariants(rotor: SolidRotor, origin: np.ndarray) -> Invariants:
    basis = sp.eye_array(3 * rotor.node_count, format="csr")
    matrices = (rotor.mass, rotor.stiffness, rotor.damping)
    return Invariants.of(rotor.nodes - origin, *matrices, basis, rotor.axis.direction)


def _second_order(
    rotor: SolidRotor, invariants: Invariants, level: str
) -> tuple[Invariants, tuple[np.ndarray, np.ndarray]]:
    """Return the invariants, with K_G at the level 'full', and the factors V and W of the rest.

    Raises
    ------
    ValueError
        For an unknown level, or 'full' with a rotor that carries no prestress.
    """
    checks.choice(level, "stiffening", LEVELS)
    if level == "full":
        if rotor.carried_prestress is None:
            raise ValueError(NO_PRESTRESS)
        factors = relief_factors(invariants, relief_rotations(rotor)[0])
        return replace(invariants, K2=rotor.carried_prestress.matrix), factors
    V, W = tilt_factors(invariants)
    return invariants, (V, W if level == "tilt" else 0.0 * W)


@dataclass(frozen=True, eq=False)
class FullRotor:
    """A solid rotor with linear supports, unreduced: sparse equations at any spin speed.

    Attributes
    ----------
    axis : SpinAxis
    nodes : ndarray, shape (n, 3)
        Mesh coordinates [m].
    supports : tuple of Support
    motions : tuple of scipy.sparse.csr_array, each (6, 3n)
        Interface motion of every support along (n1, n2, e).
    invariants : Invariants
        Sparse, about the foot of the centre of mass on the axis; K2 only at the level 'full'.
    tilt : tuple of ndarray, (6, 3n) and (6, 6)
        V and W of the centrifugal stiffening ``K2 + VᵀWV`` per Ω².
    rotor : SolidRotor
    spin : Spin, optional
        The spin as a coordinate; see :meth:`with_spin`.
    """

    axis: SpinAxis
    nodes: np.ndarray
    supports: tuple[Support, ...]
    motions: tuple[sp.csr_array, ...]
    invariants: Invariants
    tilt: tuple[np.ndarray, np.ndarray]
    rotor: SolidRotor
    spin: Spin | None = None

    @classmethod
    def of(
        cls, rotor: SolidRotor, supports: Sequence[Support] = (), stiffening: str = "tilt"
    ) -> FullRotor:
        """Put a solid rotor on supports.

        Raises
        ------
        ValueError
            For an unknown interface or level of stiffening.
        """
        check_interfaces(supports, rotor.interfaces)
        origin = rotor.axis.project(rotor.center_of_mass)
        invariants, tilt = _second_order(rotor, _invariants(rotor, origin), stiffening)
        turn = np.kron(np.eye(2), axes_of(rotor.axis).T)
        motions = tuple(
            sp.csr_array(turn @ rotor.interfaces[s.interface].mean_motion(rotor.node_count))
            for s in supports
        )
        return cls(rotor.axis, rotor.nodes, tuple(supports), motions, invariants, tilt, rotor)

    @property
    def size(self) -> int:
        """Number of coordinates 3n."""
        return self.invariants.size

    @property
    def unit_unbalance(self) -> np.ndarray:
        """Load of the rotor's own eccentricity per Ω², ``h`` (83), shape (3n,), rotor frame."""
        return self.invariants.h

    @property
    def free_spin(self) -> Spin | None:
        """The spin where nothing holds it, else None."""
        return self.spin if self.spin is not None and self.spin.free else None

    def with_spin(self) -> FullRotor:
        """Return the same with the spin as a coordinate, as all analyses need it."""
        own = spin_of(self.rotor)
        if self.spin is not None or own is None:
            return self
        spin = Spin.of(*own, self.supports, self.motions, self.invariants, self.axis)
        warn_of_eccentricity(self.invariants, spin)
        return replace(self, spin=spin)

    def interface_motion(self, name: str) -> np.ndarray:
        """Return the interface's motion (6, 3n): displacement and rotation along (n1, n2, e)."""
        turn = np.kron(np.eye(2), axes_of(self.axis).T)
        return turn @ self.rotor.interfaces[name].mean_motion(self.rotor.node_count).toarray()

    def node_motion(self, number: int) -> np.ndarray:
        """Return a mesh node's displacement along (n1, n2, e), shape (6, 3n); no rotation."""
        rows = np.zeros((6, self.size))
        rows[:3, 3 * number : 3 * number + 3] = axes_of(self.axis).T
        return rows

    def at(self, speed: float) -> None:
        """Refuse: the equations of a full model are not formed as dense matrices."""
        raise ValueError(
            f"the full model has {self.size} degrees of freedom, too many for this analysis; "
            "reduce the rotor first, e.g. rotor.reduce(30)"
        )

    def residual(
        self,
        speed: float,
        values: np.ndarray,
        stack: dict[int, np.ndarray],
        strained: dict[int, np.ndarray] | None = None,
        torsion: float = 0.0,
    ) -> dict[int, np.ndarray]:
        """Return what modes leave of the equations, per harmonic (3n, k) [N].

        ``r_n = (s²M + s(D + 2ΩG) + K + Ω²(K2 − C)) X_n + supports`` with ``s = λ + inΩ``. K
        is applied to `strained`, the stack itself by default; without free rigid motions in it,
        rounding does not make forces of them. `torsion` is that of :meth:`Subspace.torsion`.
        """
        inv, left = self.invariants, {}
        strained = stack if strained is None else strained
        for n, X in stack.items():
            rate = values + 1j * n * speed
            left[n] = (
                inv.M @ (X * rate**2)
                + (inv.D @ X + 2.0 * speed * (inv.G @ X)) * rate
                + inv.K @ strained[n]
                + speed**2 * self._centrifugal(X)
            )
            if torsion:
                left[n] += torsion * np.outer(self.spin.momentum, self.spin.amount(X))
        for index, support in enumerate(self.supports):
            damping, stiffness = support.terms(speed)
            if speed == 0.0:  # θ stands still: all harmonics are one
                zero = np.zeros((6, 6))
                damping = {0: sum(damping.values(), zero)}
                stiffness = {0: sum(stiffness.values(), zero)}
            moved = {m: self._moved(index, X) for m, X in stack.items()}
            for n, residual in left.items():
                for m, u in moved.items():
                    rate = values + 1j * m * speed
                    force = 0.0
                    if n - m in stiffness:
                        force = stiffness[n - m] @ u
                    if n - m in damping:
                        force = force + damping[n - m] @ (u * rate)
                    if np.ndim(force):
                        residual += self._pulled(index, force)
        return left

    def _centrifugal(self, X: np.ndarray) -> np.ndarray:
        """Return ``(K2 − C) X``, shape (3n, k)."""
        V, W = self.tilt

        def apply(Y: np.ndarray) -> np.ndarray:
            rigid = V.T @ (W @ (V @ Y)) - self.invariants.C @ Y
            return rigid if self.invariants.K2 is None else rigid + self.invariants.K2 @ Y

        return apply(X) if self.spin is None else self.spin.uncoupled(apply, X)

    def _moved(self, index: int, X: np.ndarray) -> np.ndarray:
        """Return the motion (6, k) at a support."""
        u = self.motions[index] @ X
        if self.spin is not None:
            u = u + np.outer(self.spin.shifts[index], self.spin.amount(X))
        return u

    def _pulled(self, index: int, force: np.ndarray) -> np.ndarray:
        """Return the nodal forces (3n, k) of forces and moments (6, k) at a support."""
        nodal = self.motions[index].T @ force
        if self.spin is not None:
            nodal = nodal + np.outer(self.spin.momentum, self.spin.shifts[index] @ force)
        return nodal

    def whirl_sample(self, most: int) -> tuple[np.ndarray, np.ndarray, np.ndarray, bool]:
        """Return points, their motion and the coordinates they use, for WhirlContent."""
        axes = axes_of(self.axis)
        nodes = spread(len(self.nodes), most // 2)
        rows = (3 * nodes[:, None] + np.arange(3)).ravel()
        points = (self.nodes[nodes] - self.axis.point) @ axes
        return points, np.kron(np.eye(len(nodes)), axes.T), rows, True


class Subspace:
    """A mass-orthonormal subspace for the modes of a full rotor, which grows as needed.

    Parameters
    ----------
    full : FullRotor
    count : int
        Number of modes that will be asked for.
    speed : float
        Largest spin speed [rad/s], which sets the shift α of the preconditioner.
    """

    def __init__(self, full: FullRotor, count: int, speed: float) -> None:
        self.full = full
        inv = full.invariants
        held = inv.K
        for support, U in zip(full.supports, full.motions, strict=True):
            stiffness = support.matrices(0.0)[0]
            held = held + U.T @ sp.csr_array(0.5 * (stiffness + stiffness.T)) @ U
        self._shifted = sp.csr_array(held + _shift(held, inv.M, speed) * inv.M)
        self._factor = SparseCholesky(self._shifted)
        self.V = np.zeros((full.size, 0))
        self._small: LinearRotor | None = None
        names = ("M", "K", "D", "G", "C") + (() if inv.K2 is None else ("K2",))
        self._projected = {name: np.zeros((0, 0)) for name in names}
        # one by one, so that each stays a column of its own: a free one is told by its stiffness
        for column in np.hstack(seeds(full.rotor)).T:
            self.grow(column[:, None])
        self.rigid = self.V.shape[1]
        wanted = min(2 * count + 8, full.size - 1)
        _, modes = lanczos_modes(self._shifted, inv.M, self._factor.solve, wanted, 1e-6)
        self.grow(modes)

    def modes(self, speed: float, count: int, tolerance: float) -> FloquetModes:
        """Return the `count` lowest modes at a spin speed, vectors in all 3n coordinates.

        `tolerance` limits the residual r relative to the mode x: ``rᴴ(K + αM)⁻¹r`` against
        ``xᴴ(K + αM)x``, both square-rooted.

        Raises
        ------
        ValueError
            If the residual does not fall below the tolerance.
        """
        for _ in range(_MOST_ROUNDS):
            found = self.trial(speed, count)
            errors, corrections = self.errors(speed, found)
            if np.all(errors <= tolerance):
                return found
            if self.V.shape[1] > _MOST_COLUMNS:
                break
            bad = corrections[:, np.repeat(errors > tolerance, corrections.shape[1] // count)]
            self.grow(np.hstack([bad.real, bad.imag]))
        raise ValueError(
            f"full model at {speed:.6g} rad/s: the residual stays at {errors.max():.1e} with "
            f"{self.V.shape[1]} vectors; ask for fewer modes or give a larger tolerance"
        )

    @property
    def projected(self) -> LinearRotor:
        """The rotor in the basis V, with its supports."""
        if self._small is None:
            self._small = self._project()
        return self._small

    def _project(self) -> LinearRotor:
        full, rotor = self.full, self.full.rotor
        inv = full.invariants
        blocks = {name: X.copy() for name, X in self._projected.items()}
        # exactly, so that rounding does not hold what is free
        blocks["K"][: self.rigid] = blocks["K"][:, : self.rigid] = 0.0
        # as one contiguous matrix, which is many times faster than nine products
        P = (np.ascontiguousarray(inv.P).reshape(9, -1) @ self.V).reshape(3, 3, -1)
        invariants = replace(inv, S=inv.S @ self.V, P=P, **blocks)
        V, W = full.tilt
        interfaces = {
            s.interface: ReducedInterface(
                rotor.interfaces[s.interface].reference,
                rotor.interfaces[s.interface].center,
                rotor.interfaces[s.interface].radius,
                np.kron(np.eye(2), axes_of(full.axis)) @ (U @ self.V),
            )
            for s, U in zip(full.supports, full.motions, strict=True)
        }
        reduced = ReducedRotor(
            full.axis, rotor.center_of_mass, invariants, (), interfaces, blocks["M"]
        )
        unit = np.eye(1, self.V.shape[1])[0]
        spin = full.spin and replace(full.spin, motion=unit, momentum=unit)
        tilt = V @ self.V
        K2 = tilt.T @ W @ tilt + blocks.get("K2", 0.0)
        return LinearRotor(reduced, full.supports, invariants, K2, spin)

    def content(self) -> WhirlContent:
        """Return the circumferential content of the basis V."""
        points, motion, rows, known = self.full.whirl_sample(800)
        return WhirlContent.from_points(points, motion @ self.V[rows], known)

    def solve(self, forces: np.ndarray) -> np.ndarray:
        """Return ``(K + αM)⁻¹ f`` for forces (3n, k), real or complex."""
        if np.iscomplexobj(forces):
            return self._factor.solve(forces.real) + 1j * self._factor.solve(forces.imag)
        return self._factor.solve(forces)

    def left(self, speed: float, values: np.ndarray, stack: dict[int, np.ndarray]) -> dict:
        """Return what modes leave of the full equations; see :meth:`FullRotor.residual`."""
        return self.full.residual(speed, values, stack, torsion=self.torsion(speed))

    def torsion(self, speed: float) -> float:
        """Return the stiffness of a coupled spin by steady forces, see :class:`LinearRotor`."""
        spin = self.full.spin
        return self.projected.steady_torsion(speed) if spin is not None and spin.coupled else 0.0

    def trial(self, speed: float, count: int) -> FloquetModes:
        """Return the lowest modes in the present subspace."""
        modes = floquet_modes(self.projected.at(speed))
        lowest = modes.vectors[:, :, :count]
        vectors = np.einsum("cv,hvk->hck", self.V, lowest)
        return FloquetModes(modes.values[:count], vectors, modes.orders, modes.resolution)

    def errors(self, speed: float, modes: FloquetModes) -> tuple[np.ndarray, np.ndarray]:
        """Return the relative residual of each mode (k,), and corrections (3n, k h)."""
        stack = dict(zip(modes.orders.tolist(), modes.vectors, strict=True))
        left = self.left(speed, modes.values, stack)
        squared, size, corrections = 0.0, 0.0, []
        for n, residual in left.items():
            answer = self.solve(residual.astype(complex))
            squared = squared + np.einsum("ck,ck->k", residual.conj(), answer).real
            size = size + np.einsum("ck,ck->k", stack[n].conj(), self._shifted @ stack[n]).real
            corrections.append(answer)
        errors = np.sqrt(np.maximum(squared, 0.0) / size)
        return errors, np.stack(corrections, axis=2).reshape(self.full.size, -1)

    def grow(self, columns: np.ndarray) -> None:
        """Add directions to V, and their rows and columns to the projected matrices."""
        if columns.shape[1] == 0:
            return
        inv = self.full.invariants
        # scaled first, so that rounding can be told from small corrections
        columns = columns / np.sqrt(np.maximum(_norms(columns, inv.M), 1e-300))
        for _ in range(3):
            columns = columns - self.V @ (self.V.T @ (inv.M @ columns))
            gram = columns.T @ (inv.M @ columns)
            values, turn = np.linalg.eigh(0.5 * (gram + gram.T))
            kept = values > 1e-13
            columns = columns @ (turn[:, kept] / np.sqrt(values[kept]))
        for name in self._projected:
            image = getattr(inv, name) @ columns
            side, corner = self.V.T @ image, columns.T @ image
            sign = -1.0 if name == "G" else 1.0
            old = self._projected[name]
            self._projected[name] = np.block(
                [[old, side], [sign * side.T, 0.5 * (corner + sign * corner.T)]]
            )
        self.V = np.hstack([self.V, columns])
        self._small = None


def _shift(stiffness: sp.csr_array, mass: sp.csr_array, speed: float) -> float:
    """Return α [1/s²] of the order of the lowest flexible modes; it only steers convergence."""
    mesh = np.median(stiffness.diagonal()) / np.median(mass.diagonal())
    elements_across = max(mass.shape[0] / 3.0, 1.0) ** (1.0 / 3.0)
    return max(speed**2, mesh / (10.0 * elements_across) ** 2)


def _norms(columns: np.ndarray, mass: sp.csr_array) -> np.ndarray:
    return np.einsum("ck,ck->k", columns, mass @ columns)
