"""A reduced rotor beside the shapes that its basis lacks first, as a rotor with more modes.

These are static responses to loads at its interfaces and to the inertia forces of its modes in a
turning frame (:mod:`exudyn_rotor.reduction`), as far as its own columns do not hold them.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from exudyn_rotor.cached import kept
from exudyn_rotor.linear.models.protocol import Mesh
from exudyn_rotor.linear.models.rotor.rotor_on_supports import LinearRotor, without_supports
from exudyn_rotor.reduction.other_basis import in_basis
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.threads import one_thread

# share of a flexibility that counts as missing; static modes of held interfaces lack 3 % of that
# with inertia relief
_MISSING = 0.1


@dataclass(frozen=True, eq=False)
class FinerRotor(LinearRotor):
    """A reduced rotor on supports with the shapes that its basis lacks first.

    Its coordinates are those of the model, then those that it lacks; these move no mesh nodes.

    Attributes
    ----------
    given : LinearRotor or None
        The rotor whose basis is looked at.
    """

    given: LinearRotor | None = None

    @classmethod
    def beside(cls, model: LinearRotor) -> FinerRotor | None:
        """Return the finer rotor of a model; None where what it lacks is not known."""
        finer = finer_rotor(model.rotor)
        if finer is None:
            return None
        with one_thread():
            invariants, terms, level = without_supports(finer, model.stiffening)
        spin = None if model.spin is None else model.spin.wider(finer.size - model.size)
        parts = model.supports, invariants, terms, spin, model.free_motions, level
        finer = cls(finer, *parts, given=model)
        if np.any(model.invariants.D):
            return finer
        # of its own or left out, as for critical speeds
        undamped, H = finer.invariants.undamped, finer.invariants.H
        undamped = undamped if H is None else replace(undamped, H=H)
        return replace(finer, invariants=undamped)

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
class Basis:
    """The basis of one rotor of a model.

    Attributes
    ----------
    rotor : ReducedRotor
    loaded : tuple of str
        Interfaces that something acts on.
    name : str, optional
        That of the rotor where there are several.
    """

    rotor: ReducedRotor
    loaded: tuple[str, ...]
    name: str = ""

    def __str__(self) -> str:
        """Return what the basis has, for messages."""
        elastic = self.rotor.size - len(self.rotor.rigid_kinds)
        highest = self.rotor.frequencies[-1] / (2.0 * np.pi) if elastic else 0.0
        name = f"rotor {self.name!r}" if self.name else "the reduced rotor"
        return f"the flexible modes of {name} ({elastic}, up to {highest:.4g} Hz)"

    @property
    def lacks_flexibility(self) -> bool:
        """Whether the basis misses much of the flexibility at the interfaces that are loaded."""
        if not self.loaded:
            return False
        finer = finer_rotor(self.rotor)
        motion = np.vstack([finer.interfaces[name].motion for name in self.loaded])
        stiffness = finer.invariants.K
        parts = []
        for count in (self.rotor.size, finer.size):
            first = len(finer.rigid_kinds)
            flexible = slice(first, count)
            given = motion[:, flexible]
            parts.append(np.trace(given @ np.linalg.solve(stiffness[flexible, flexible], given.T)))
        return bool(parts[1] - parts[0] > _MISSING * parts[1])


@kept
def finer_rotor(rotor: ReducedRotor) -> ReducedRotor | None:
    """Return a rotor with the columns of `rotor`, then those that it lacks, mass-orthonormal.

    None where these are not known. The latter diagonalise the stiffness, ascending. Made once.
    """
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
    return in_basis(attached, T, rotor.rigid_kinds)
