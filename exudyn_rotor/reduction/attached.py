"""A finer rotor beside a reduced one, computed when it is first asked for."""

from __future__ import annotations

from collections.abc import Callable
from threading import Lock
from typing import Generic, TypeVar

import numpy as np

from exudyn_rotor import checks

Rotor = TypeVar("Rotor")  # ReducedRotor, which holds one of these
_ORTHONORMAL = 1e-6  # largest entry of ΨᵀMΨ − I of columns that count as orthonormal


class Attached(Generic[Rotor]):
    """Static responses beside the modes of a reduced rotor.

    Many scenes never ask for them, and they cost one factorisation and some solutions of the full
    model, which is kept until then. Made by :meth:`exudyn_rotor.SolidRotor.reduce`.

    Parameters
    ----------
    compute : callable
        Returns the finer rotor and the columns of the reduced one in it, (l, k), orthonormal; both
        None where the model has no static responses.
    """

    def __init__(self, compute: Callable[[], tuple[Rotor | None, np.ndarray | None]]) -> None:
        self._compute, self._lock = compute, Lock()

    @classmethod
    def known(cls, rotor: Rotor, columns: np.ndarray | None) -> Attached:
        """Take what is known already; columns None, as in files of version 0.1.

        Raises
        ------
        TypeError, ValueError
            If the shape of the columns does not fit, or they are not orthonormal.
        """
        if columns is not None:
            columns = checks.array(columns, "in_attached", shape=(rotor.size, None))
            away = np.abs(columns.T @ columns - np.eye(columns.shape[1])).max(initial=0.0)
            if away > _ORTHONORMAL:
                raise ValueError(
                    f"in_attached: columns are not orthonormal, they miss it by {away:.3g}"
                )
        return cls(lambda: (rotor, columns))

    def __reduce__(self) -> tuple:
        """Send to other processes what is known, not the full model."""
        return _sent, self._both

    @property
    def _both(self) -> tuple[Rotor | None, np.ndarray | None]:
        with self._lock:  # threads may share a rotor
            if self._compute is not None:
                self._computed = self._compute()
                self._compute = None  # and the full model with it
        return self._computed

    @property
    def rotor(self) -> Rotor | None:
        """The finer rotor, without shapes."""
        return self._both[0]

    @property
    def columns(self) -> np.ndarray | None:
        """Columns of the reduced rotor in the finer one, shape (l, k)."""
        return self._both[1]

    def of_columns(self, chosen: np.ndarray) -> Attached:
        """Return the same for some columns of the reduced rotor."""

        def compute() -> tuple[Rotor | None, np.ndarray | None]:
            return self.rotor, None if self.columns is None else self.columns[:, chosen]

        return Attached(compute)

    def with_damping(self, **factors: float) -> Attached:
        """Return the same with damping, see :meth:`ReducedRotor.with_damping`."""

        def compute() -> tuple[Rotor | None, np.ndarray | None]:
            return None if self.rotor is None else self.rotor.with_damping(**factors), self.columns

        return Attached(compute)


def _sent(rotor: Rotor | None, columns: np.ndarray | None) -> Attached:
    return Attached(lambda: (rotor, columns))
