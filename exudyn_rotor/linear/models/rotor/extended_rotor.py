"""What rotors with coordinates beside their own, of foundations or controllers, have in common."""

from __future__ import annotations

from abc import ABC, abstractmethod
from dataclasses import replace
from typing import ClassVar

import numpy as np
import scipy.linalg as la

from exudyn_rotor.cached import cached_property
from exudyn_rotor.linear.models.protocol import Mesh
from exudyn_rotor.linear.models.rotor.rotor_on_supports import LinearRotor
from exudyn_rotor.linear.models.whole_space import InAllCoordinates, WholeSpace
from exudyn_rotor.theory.invariants import Invariants


class ExtendedRotor(InAllCoordinates, ABC):
    """Base of linear models, whose dataclasses hold `plain`; see :class:`LinearModel`.

    Attributes
    ----------
    plain : LinearRotor or ExtendedRotor
        The rotor without the further coordinates, which come last.
    """

    gives_all: ClassVar[bool] = True

    plain: LinearRotor | ExtendedRotor

    @property
    @abstractmethod
    def _more(self) -> int:
        """Number of further coordinates."""

    @property
    def held(self) -> LinearRotor | ExtendedRotor:
        """The rotor without the further coordinates, on what holds it in their place."""
        return self.plain

    @property
    def is_full(self) -> bool:
        """True where no basis of the rotor leaves anything out."""
        return self.plain.is_full

    @property
    @abstractmethod
    def beside(self) -> tuple[str, ...]:
        """Names of the coordinates after those of the rotor's basis."""

    @property
    def size(self) -> int:
        """Number of coordinates k."""
        return self.plain.size + self._more

    @property
    def free_motions(self) -> tuple[str, ...]:
        """Rigid motions of the rotor that nothing holds."""
        return self.plain.free_motions

    @property
    def is_balanced(self) -> bool:
        """True where centre of mass and principal axis are on the spin axis but for rounding."""
        return self.plain.is_balanced

    @property
    def has_structural_damping(self) -> bool:
        """True where steady motions have structural damping, which other analyses leave out."""
        return self.plain.has_structural_damping

    @property
    def radius(self) -> float:
        """The rotor's radius of gyration [m]."""
        return self.plain.radius

    @property
    def stiffening(self) -> str:
        """Level of centrifugal stiffening."""
        return self.plain.stiffening

    @property
    def stiffness_varies(self) -> bool:
        """True where supports or a static displacement have a stiffness that is not in Ω²."""
        return self.plain.stiffness_varies

    @property
    def invariants(self) -> Invariants:
        """Those of the rotor."""
        return self.plain.invariants

    @property
    def unit_unbalance(self) -> np.ndarray:
        """Load of the rotor's own eccentricity per Ω², shape (k,), rotor frame."""
        return self._wide(self.plain.unit_unbalance)

    @cached_property
    def mesh(self) -> Mesh | None:
        """Nodes of the rotor's mesh; None where it was stored without mode shapes."""
        mesh = self.plain.mesh
        return None if mesh is None else replace(mesh, columns=self._wide(mesh.columns))

    def whole_space(self, held: bool) -> WholeSpace:
        """Return all coordinates, `held` without a spin that nothing holds."""
        space = self.plain.whole_space(held)
        others = space.others
        if others is not None:
            others = self._joined(others, np.eye(self._more))
        return replace(space, equations=replace(self, plain=space.equations), others=others)

    def _wide(self, rows: np.ndarray) -> np.ndarray:
        """Return rows (…, k) of the rotor with zeros for the further coordinates."""
        return np.pad(rows, [(0, 0)] * (rows.ndim - 1) + [(0, self._more)])

    def _joined(self, rotor: np.ndarray, beside: np.ndarray | None = None) -> np.ndarray:
        """Return a matrix of the rotor with one of the further coordinates, or zeros, beside it."""
        return np.pad(rotor, (0, self._more)) if beside is None else la.block_diag(rotor, beside)
