"""What reduced and full rotors on supports have in common as linear models."""

from __future__ import annotations

from dataclasses import replace
from typing import ClassVar, TypeVar

import numpy as np
import scipy.sparse as sp

from exudyn_rotor import checks
from exudyn_rotor.bearings.support import Support
from exudyn_rotor.linear.models.points import radius_of_gyration
from exudyn_rotor.linear.models.rotor.eccentricity import is_balanced
from exudyn_rotor.linear.models.rotor.spin import Spin
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.solid_rotor import SolidRotor
from exudyn_rotor.theory.invariants import Invariants
from exudyn_rotor.theory.rotating_axes import axes_of

Kind = TypeVar("Kind", bound="SupportedRotor")


class SupportedRotor:
    """Base of rotors with linear supports, whose dataclasses hold these attributes.

    Attributes
    ----------
    rotor : ReducedRotor or SolidRotor
    supports : tuple of Support
    invariants : Invariants
        In these coordinates, about the foot of the centre of mass on the axis; K4 only where the
        level of stiffening has it, K2_estimated only where that was not chosen.
    spin : Spin, optional
        The spin as a coordinate.
    """

    standing: ClassVar[np.ndarray] = checks.read_only(np.zeros(0, dtype=int), int)
    standing_interfaces: ClassVar[tuple[str, ...]] = ()

    rotor: ReducedRotor | SolidRotor
    supports: tuple[Support, ...]
    invariants: Invariants
    spin: Spin | None

    @property
    def size(self) -> int:
        """Number of coordinates k."""
        return self.invariants.size

    @property
    def interfaces(self) -> tuple[str, ...]:
        """Names of the rotor's interfaces."""
        return tuple(self.rotor.interfaces)

    @property
    def mass_matrix(self) -> np.ndarray | sp.csr_array:
        """M, shape (k, k)."""
        return self.invariants.M

    @property
    def unit_unbalance(self) -> np.ndarray:
        """Load of the rotor's own eccentricity per Ω², ``h`` (83), shape (k,), rotor frame."""
        return self.invariants.h

    @property
    def is_balanced(self) -> bool:
        """True where centre of mass and principal axis are on the spin axis but for rounding."""
        return is_balanced(self.invariants)

    @property
    def base_loads(self) -> np.ndarray:
        """Loads of unit accelerations of the ground (109), shape (3, k)."""
        return -axes_of(self.rotor.axis).T @ self.invariants.S

    @property
    def radius(self) -> float:
        """The rotor's radius of gyration [m]."""
        return radius_of_gyration(self.invariants)

    @property
    def stiffness_varies(self) -> bool:
        """True where supports or a static displacement have a stiffness that is not in Ω²."""
        varies = any(support.stiffness_varies for support in self.supports)
        return varies or self.invariants.K4 is not None

    @property
    def table_speeds(self) -> np.ndarray:
        """Speeds of supports' tables [rad/s]."""
        return np.concatenate([np.zeros(0), *(support.table_speeds for support in self.supports)])

    @property
    def has_structural_damping(self) -> bool:
        """True where steady motions have structural damping, which other analyses leave out."""
        return self.invariants.H is not None

    @property
    def free_spin(self) -> Spin | None:
        """The spin where nothing holds it, else None."""
        return self.spin if self.spin is not None and self.spin.free else None

    def undamped(self: Kind) -> Kind:
        """Return the model without damping, and without the skew part of supports' stiffness."""
        supports = tuple(support.undamped() for support in self.supports)
        return replace(self, supports=supports, invariants=self.invariants.undamped)
