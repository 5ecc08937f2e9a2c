"""Several rotors with the shapes, too, that their bases lack first.

Each rotor has its own coordinates, then those that it lacks (:mod:`.finer_rotor`). The latter are
mass-orthonormal to the former and turn by themselves, so that the former mean what they do in the
given equations.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np

from exudyn_rotor.cached import cached_property
from exudyn_rotor.linear.models.basis.finer_rotor import Basis, FinerRotor
from exudyn_rotor.linear.models.trains.linear_train import LinearTrain
from exudyn_rotor.linear.models.trains.train_elements import places_of
from exudyn_rotor.linear.models.trains.turned_rotor import TurnedRotor


@dataclass(frozen=True, eq=False)
class FinerTrain(LinearTrain):
    """Several rotors with finer bases; see :class:`LinearTrain`.

    Attributes
    ----------
    given : LinearTrain or None
        The rotors whose bases are looked at.
    """

    given: LinearTrain | None = None

    @classmethod
    def beside(cls, model: LinearTrain) -> FinerTrain | None:
        """Return the finer rotors of a model; None where what one of them lacks is not known."""
        parts = {}
        for name, part in model.parts.items():
            finer = FinerRotor.beside(part.alone)
            if finer is None:
                return None
            parts[name] = _finer(part, finer)
        rotors = {name: part.alone.rotor for name, part in parts.items()}
        return cls(replace(model.train, rotors=rotors), parts, model.elements, model.own, model)

    @property
    def lacking(self) -> np.ndarray:
        """Which coordinates the given rotors lack, shape (k,)."""
        parts = ((self.parts[name].size, part.size) for name, part in self.given.parts.items())
        rotors = [np.arange(size) >= kept for size, kept in parts]
        return np.hstack([*rotors, np.zeros(self.own.size, dtype=bool)])

    @property
    def bases(self) -> tuple[Basis, ...]:
        """Those of the given rotors."""
        return tuple(
            Basis(rotor, places_of(name, self.elements), name)
            for name, rotor in self.given.train.rotors.items()
        )

    @cached_property
    def _standing(self) -> FinerTrain | None:
        """The equations in inertial axes where these are constant and those here are not."""
        standing = self.given._standing
        return None if standing is None else FinerTrain.beside(standing)


def _finer(part: TurnedRotor, finer: FinerRotor) -> TurnedRotor:
    """Return a rotor with a finer basis in the same axes."""
    turning = None if part.turning is None else part.turning.widened(finer)
    return replace(part, alone=finer, turning=turning)
