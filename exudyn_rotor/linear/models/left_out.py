"""What the basis of a reduced rotor leaves out: estimates of its error without a larger model.

Beside its own columns Q (coordinates b) a reduced rotor knows static responses to loads at its
interfaces and to the inertia forces of Q in a turning frame (:mod:`exudyn_rotor.reduction`). What
of them is not in Q, made mass-orthonormal, are further coordinates c. In both, the equations of a
motion ``e^{λt}`` are

    [Z_bb  Z_bc] [x]
    [Z_cb  Z_cc] [y]  =  0,        Z(λ) = λ²M + λ(D + 2ΩG) + K + Ω²(K2 − C) + supports,

while the reduced rotor solves ``Z_bb x = 0``: ``Z_cb x`` is the residual of its motion, seen from
the shapes that lack first. An inverse iteration from there, on both sides,

    z = Z(λ)⁻¹ Z'(λ) (x, 0),    w = Z(λ)⁻ᴴ M (x, 0),

and the quotient ``wᴴ[Z(λ) + δ Z'(λ) + δ²M]z = 0`` give λ + δ, the eigenvalue in both. (With
``y = −Z_cc⁻¹Z_cb x`` alone, at the x of the reduced rotor, δ comes out ten times too small on stiff
supports: the motion at the supports changes by as much as the flexibility that is added there.) A δ
that is not small against the distance of the modes is an order of magnitude only. Shapes that are
neither in Q nor among the static responses are not seen: of the error they are a hundredth part in
``python -m validation basis``. Periodic equations are taken in harmonics
(:mod:`exudyn_rotor.linear.periodic.hill`), y in the central ones.
"""

from __future__ import annotations

import warnings
from dataclasses import dataclass, replace
from functools import cached_property
from weakref import WeakKeyDictionary

import numpy as np

from exudyn_rotor.linear.models.finer_scene import FinerScene
from exudyn_rotor.linear.models.linear_scene import LinearScene
from exudyn_rotor.linear.models.protocol import Mesh
from exudyn_rotor.linear.models.rotor_on_supports import LinearRotor
from exudyn_rotor.linear.periodic.floquet_modes import FloquetModes
from exudyn_rotor.linear.periodic.harmonics import hill_matrices
from exudyn_rotor.linear.periodic.inverse_iteration import OFF_ROOT, root_near
from exudyn_rotor.linear.periodic.periodic_system import PeriodicSystem
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.threads import one_thread

# share of a flexibility that counts as missing; static modes of held interfaces lack 3 % of that
# with inertia relief
_MISSING = 0.1
_FREE = 1e-6  # of the inertia at the speed: a stiffness that leaves a motion free
_STEP = 1e-3  # of differences by the speed, relative
_SMALL = 1e-5  # harmonics of a mode of unit length


@dataclass(frozen=True, eq=False)
class FinerRotor(LinearRotor):
    """A reduced rotor beside the shapes that its basis lacks first, which move no mesh nodes.

    Attributes
    ----------
    given : LinearRotor or None
        The rotor whose basis is looked at.
    """

    given: LinearRotor | None = None

    @property
    def loaded(self) -> tuple[str, ...]:
        """Names of the interfaces with supports."""
        return tuple(support.interface for support in self.supports)

    @property
    def mesh(self) -> Mesh | None:
        """Nodes of the mesh with the motion that the reduced rotor knows of them."""
        mesh = self.given.mesh
        if mesh is None:
            return None
        more = self.size - self.given.size
        return _WiderMesh(mesh.nodes, mesh.columns, mesh.axis, mesh.triangles, more)


@dataclass(frozen=True, eq=False)
class _WiderMesh(Mesh):
    """Mesh nodes, and how many further coordinates do not move them."""

    more: int

    def motion(self, number: int) -> np.ndarray:
        return np.pad(super().motion(number), ((0, 0), (0, self.more)))


@dataclass(frozen=True, eq=False)
class LeftOut:
    """A reduced rotor, on supports or in a scene, beside the shapes that its basis lacks first.

    Attributes
    ----------
    finer : FinerRotor or FinerScene
        In the coordinates of the model, then those that it lacks.
    kept : int
        Number of the former.
    rotor : ReducedRotor
        The rotor whose basis is looked at.
    held : bool
        Whether the spin is no coordinate, as nothing holds it and it follows θ = Ωt.
    """

    finer: FinerRotor | FinerScene
    kept: int
    rotor: ReducedRotor
    held: bool = False

    @classmethod
    def of(cls, model: LinearRotor | LinearScene, held: bool = False) -> LeftOut | None:
        """Return what the basis of a model leaves out; None where that is not known."""
        if isinstance(model, LinearScene):
            rotor = model.body.selection.source
            finer = finer_rotor(rotor)
            finer = None if finer is None else FinerScene.of(model, finer)
            return None if finer is None else cls(finer, model.size, rotor)
        finer = finer_rotor(model.rotor)
        if finer is None:
            return None
        with warnings.catch_warnings():  # said where the model was made
            warnings.filterwarnings("ignore", message="the centre of mass is")
            finer = FinerRotor.of(finer, model.supports, model.stiffening)
        finer = replace(finer, given=model)
        if not np.any(model.invariants.D):  # of its own or left out, as for critical speeds
            undamped, H = finer.invariants.undamped, finer.invariants.H
            undamped = undamped if H is None else replace(undamped, H=H)
            finer = replace(finer, invariants=undamped)
        return cls(finer, model.size, model.rotor, held and model.free_spin is not None)

    def at(self, speed: float) -> tuple[PeriodicSystem, np.ndarray]:
        """Return the finer equations at a speed [rad/s], and which coordinates are left out."""
        system, lacking = self.finer.at(speed), np.arange(self.finer.size) >= self.kept
        if speed == 0.0:  # at rest nothing turns: coefficients are what they are at θ = 0
            M, D, K = ({0: X} for X in system.matrices(0.0))
            system = PeriodicSystem(0.0, M, D, K, system.H)
        if not self.held:
            return system, lacking
        others = self.finer.spin.rest()
        return system.projected(others), others.T @ lacking > 0.5

    def lacks_flexibility(self) -> bool:
        """Return True if the basis misses much of the flexibility at interfaces."""
        if not self.finer.loaded:
            return False
        finer = self.finer.rotor
        motion = np.vstack([finer.interfaces[name].motion for name in self.finer.loaded])
        stiffness = finer.invariants.K
        parts = []
        for count in (self.rotor.size, finer.size):
            first = len(finer.rigid_kinds)
            flexible = slice(first, count)
            given = motion[:, flexible]
            parts.append(np.trace(given @ np.linalg.solve(stiffness[flexible, flexible], given.T)))
        return bool(parts[1] - parts[0] > _MISSING * parts[1])

    def shifts(self, speed: float, modes: FloquetModes) -> np.ndarray:
        """Return the estimated ``λ − λ_reduced`` of modes at a speed, shape (k,), complex [1/s].

        Free rigid motions, λ = 0, are in every basis; theirs is zero.
        """
        shifts = np.zeros(len(modes.values), dtype=complex)
        if self.finer.size == self.kept:
            return shifts
        system, lacking = self.at(speed)
        vectors = modes.vectors
        if self.held:
            vectors = self.finer.given.spin.rest().T @ vectors
        start = np.zeros((len(modes.orders), len(lacking), len(shifts)), dtype=complex)
        start[:, ~lacking] = vectors
        start = start.reshape(-1, len(shifts))
        pencil, used = hill_matrices(system, modes.orders), self._used(system, modes, lacking)
        for column in np.flatnonzero(modes.values):
            rows = np.flatnonzero(used[:, column])
            parts = pencil
            if len(rows) < len(start):
                parts = tuple(X[np.ix_(rows, rows)] for X in pencil)
            shifts[column] = _shift(*parts, modes.values[column], start[rows, column])
        return shifts

    @staticmethod
    def _used(system: PeriodicSystem, modes: FloquetModes, lacking: np.ndarray) -> np.ndarray:
        """Return which unknowns count for each mode: those that move, and of others the central."""
        central = np.abs(modes.orders) <= system.step
        moving = np.linalg.norm(modes.vectors, axis=1) > _SMALL
        used = np.where(lacking[:, None], central[:, None, None], moving[:, None])
        return used.reshape(-1, len(modes.values))

    def _undamped_at(self, speed: float) -> PeriodicSystem:
        """Return undamped equations; D is linear and K quadratic in Ω where supports are not."""
        spin = self.finer.spin
        if self.finer.stiffness_varies or (spin is not None and spin.coupled):
            return self.finer.at(speed)
        rest, fast = self._at_two_speeds
        share = speed / fast.speed
        D = {n: X + share * (fast.D[n] - X) for n, X in rest.D.items()}
        K = {n: X + share**2 * (fast.K[n] - X) for n, X in rest.K.items()}
        return PeriodicSystem(speed, rest.M, D, K)

    @cached_property
    def _at_two_speeds(self) -> tuple[PeriodicSystem, PeriodicSystem]:
        """The equations at rest, and at so high a speed that rounding does not count."""
        fastest = np.sqrt(np.diag(self.finer.invariants.K).max())
        return self.finer.at(0.0), self.finer.at(float(fastest))

    def critical_shift(self, speed: float, multiples: np.ndarray, vectors: np.ndarray) -> float:
        """Return the estimated ``Ω − Ω_reduced`` of a critical speed [rad/s].

        As :meth:`shifts`, of the undamped ``H(Ω) = Z(ifΩ, Ω)``, which is close to quadratic in Ω.

        Parameters
        ----------
        speed : float
            Ω_reduced [rad/s].
        multiples : ndarray, shape (h,)
            Frequencies f of the harmonics over Ω.
        vectors : ndarray, shape (h, k)
            Harmonics of the motion.
        """
        if self.finer.size == self.kept:
            return 0.0
        middle = multiples[len(multiples) // 2]
        orders = np.round(multiples - middle).astype(int)

        def dynamic(omega: float) -> tuple[np.ndarray, np.ndarray]:
            M, D, K = hill_matrices(self._undamped_at(omega), orders)
            rate = 1j * middle * omega
            dynamic = rate**2 * M + rate * D + K
            return 0.5 * (dynamic + dynamic.conj().T), M

        lacking = np.arange(self.finer.size) >= self.kept
        x = np.zeros((len(orders), len(lacking)), dtype=complex)
        x[:, ~lacking] = vectors
        step = _STEP * speed
        low, high = dynamic(speed - step)[0], dynamic(speed + step)[0]
        shifted = speed * (1.0 + OFF_ROOT)
        H, M = dynamic(shifted)
        slope, square = (high - low) / (2.0 * step), (high - 2.0 * H + low) / (2.0 * step**2)
        # free rigid motions have neither stiffness nor, where they stand still, inertia
        held = np.flatnonzero(np.abs(H).max(axis=1) > _FREE * speed**2 * M.diagonal().real)
        H, slope, square, M = (X[np.ix_(held, held)] for X in (H, slope, square, M))
        x = x.ravel()[held]
        return float((root_near(H, slope, square, slope @ x, M @ x)[0] + shifted - speed).real)


_known: WeakKeyDictionary[ReducedRotor, ReducedRotor | None] = WeakKeyDictionary()


def finer_rotor(rotor: ReducedRotor) -> ReducedRotor | None:
    """Return a rotor with the columns of `rotor`, then those that it lacks, mass-orthonormal.

    None where these are not known. The latter diagonalise the stiffness, ascending. Made once.
    """
    if rotor not in _known:
        _known[rotor] = _finer_rotor(rotor)
    return _known[rotor]


def _finer_rotor(rotor: ReducedRotor) -> ReducedRotor | None:
    attached, in_attached = rotor.with_attachments, rotor.in_attached
    return None if in_attached is None else _beside(rotor, attached, in_attached)


@one_thread()
def _beside(rotor: ReducedRotor, attached: ReducedRotor, in_attached: np.ndarray) -> ReducedRotor:
    """Return the rotor with all shapes, its own columns `in_attached` first."""
    outside = np.eye(attached.size) - in_attached @ in_attached.T
    lengths, columns = np.linalg.eigh(outside)
    columns = columns[:, lengths > 0.5]
    _, turn = np.linalg.eigh(columns.T @ attached.invariants.K @ columns)
    T = np.hstack([in_attached, columns @ turn])
    return replace(
        attached,
        invariants=attached.invariants.in_basis(T),
        rigid_kinds=rotor.rigid_kinds,
        interfaces={
            name: replace(interface, motion=interface.motion @ T)
            for name, interface in attached.interfaces.items()
        },
        mode_mass=T.T @ attached.mode_mass @ T,
    )


def _shift(M: np.ndarray, D: np.ndarray, K: np.ndarray, value: complex, x: np.ndarray) -> complex:
    """Return δ of the eigenvalue of ``λ²M + λD + K`` near `value`, beginning with a vector x."""
    shifted = value * (1.0 + OFF_ROOT)
    dynamic, linear = shifted**2 * M + shifted * D + K, 2.0 * shifted * M + D
    return shifted - value + root_near(dynamic, linear, M, linear @ x, M @ x)[0]
