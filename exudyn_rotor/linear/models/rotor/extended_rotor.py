"""What rotors with coordinates beside their own, of foundations or controllers, have in common."""

from __future__ import annotations

from abc import abstractmethod
from dataclasses import replace

import numpy as np
import scipy.linalg as la

from exudyn_rotor.cached import cached_property
from exudyn_rotor.linear.models.extended_model import ExtendedModel
from exudyn_rotor.linear.models.protocol import Mesh
from exudyn_rotor.linear.models.rotor.rotor_on_supports import LinearRotor
from exudyn_rotor.linear.models.whole_space import WholeSpace
from exudyn_rotor.theory.invariants import Invariants


class ExtendedRotor(ExtendedModel):
    """Base of linear models, whose dataclasses hold `plain`; see :class:`LinearModel`.

    Attributes
    ----------
    plain : LinearRotor or ExtendedRotor
        The rotor without the further coordinates, which come last.
    """

    plain: LinearRotor | ExtendedRotor

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
    def free_motions(self) -> tuple[str, ...]:
        """Rigid motions of the rotor that nothing holds."""
        return self.plain.free_motions

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

    @cached_property
    def mesh(self) -> Mesh | None:
        """Nodes of the rotor's mesh; None where it was stored without mode shapes."""
        mesh = self.plain.mesh
        return None if mesh is None else replace(mesh, columns=self._wide(mesh.columns))

    def whole_space(self, held: bool) -> WholeSpace:
        """Return all coordinates, `held` without a spin that nothing holds."""
        space = self.plain.whole_space(held)
        names = "others", "motions_beside_spin"
        columns = {name: getattr(space, name) for name in names}
        wide = {
            name: None if X is None else self._joined(X, np.eye(self._more))
            for name, X in columns.items()
        }
        return replace(space, equations=replace(self, plain=space.equations), **wide)

    def _joined(self, rotor: np.ndarray, beside: np.ndarray | None = None) -> np.ndarray:
        """Return a matrix of the rotor with one of the further coordinates, or zeros, beside it."""
        return np.pad(rotor, (0, self._more)) if beside is None else la.block_diag(rotor, beside)
