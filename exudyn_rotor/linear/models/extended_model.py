"""What rotors and scenes with coordinates beside their own have in common."""

from __future__ import annotations

from abc import ABC, abstractmethod
from typing import ClassVar

import numpy as np

from exudyn_rotor.linear.models.protocol import LinearModel
from exudyn_rotor.linear.models.whole_space import InAllCoordinates


class ExtendedModel(InAllCoordinates, ABC):
    """Base of linear models, whose dataclasses hold `plain`; see :class:`LinearModel`.

    Attributes
    ----------
    plain : LinearModel
        The model without the further coordinates, which come last.
    """

    gives_all: ClassVar[bool] = True

    plain: LinearModel

    @property
    @abstractmethod
    def _more(self) -> int:
        """Number of further coordinates."""

    @property
    def size(self) -> int:
        """Number of coordinates k."""
        return self.plain.size + self._more

    @property
    def is_balanced(self) -> bool:
        """True where centre of mass and principal axis are on the spin axis but for rounding."""
        return self.plain.is_balanced

    @property
    def unit_unbalance(self) -> np.ndarray:
        """Load of the rotor's own eccentricity per Ω², shape (k,), rotor frame."""
        return self._wide(self.plain.unit_unbalance)

    @property
    def table_speeds(self) -> np.ndarray:
        """Speeds of supports' tables [rad/s]."""
        return self.plain.table_speeds

    def _wide(self, rows: np.ndarray) -> np.ndarray:
        """Return rows (…, k) of the model with zeros for the further coordinates."""
        return np.pad(rows, [(0, 0)] * (rows.ndim - 1) + [(0, self._more)])
