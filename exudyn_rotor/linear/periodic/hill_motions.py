"""Motions that Hill's method finds: those chosen from a truncation, with what it leaves out."""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np


@dataclass(frozen=True, eq=False)
class Chosen:
    """Motions chosen from a :class:`HillSolution`.

    Attributes
    ----------
    columns : ndarray of int, shape (j,)
        Where they stand there.
    values, shapes : ndarray, shapes (j,), (h, c, j)
        λ and harmonics, which may be better than those of the solution where copies coincide.
    sizes : ndarray, shape (j,)
        What the error of each λ is relative to [1/s]; infinite where none counts.
    paired : ndarray of bool, shape (j,)
        Which stand for their conjugates, too, of other families.
    """

    columns: np.ndarray
    values: np.ndarray
    shapes: np.ndarray
    sizes: np.ndarray
    paired: np.ndarray


@dataclass(frozen=True, eq=False)
class HillMotions:
    """Motions with as many harmonics as they need.

    Attributes
    ----------
    values, shapes : ndarray, shapes (j,), (h, c, j)
        λ and harmonics.
    orders : ndarray of int, shape (h,)
    sizes : ndarray, shape (j,)
        What the error of each λ is relative to [1/s].
    resolution : float
        Eigenvalues closer than this cannot be told apart [1/s].
    rounding : ndarray, shape (j,)
        By how much rounding can change the real parts [1/s].
    shifts : ndarray, shape (j,)
        By how much the first harmonics left out would change λ.
    outer : mapping of int to ndarray, shape (c, j)
        What these harmonics would be.
    paired : ndarray of bool, shape (j,)
        Which stand for their conjugates, too, of other families.
    """

    values: np.ndarray
    shapes: np.ndarray
    orders: np.ndarray
    sizes: np.ndarray
    resolution: float
    rounding: np.ndarray
    shifts: np.ndarray
    outer: dict[int, np.ndarray]
    paired: np.ndarray

    @property
    def bounds(self) -> np.ndarray:
        """By how much rounding and the harmonics left out can change the real parts [1/s]."""
        return self.rounding + np.abs(self.shifts)

    @property
    def errors(self) -> np.ndarray:
        """Error of each λ by harmonics left out, relative to its size."""
        return np.abs(self.shifts) / self.sizes

    @property
    def error(self) -> float:
        """The largest of them."""
        return float(np.max(self.errors, initial=0.0))

    def columns(self, chosen: np.ndarray) -> HillMotions:
        """Return some of the motions."""
        names = ("values", "shapes", "sizes", "rounding", "shifts", "paired")
        each = {name: getattr(self, name)[..., chosen] for name in names}
        return replace(self, outer={n: X[:, chosen] for n, X in self.outer.items()}, **each)

    def with_conjugates(self) -> HillMotions:
        """Return the motions, and then the conjugates for which they stand."""

        def both(X: np.ndarray, Y: np.ndarray) -> np.ndarray:
            return np.concatenate([X, Y[..., self.paired].conj()], axis=-1)

        each = {name: getattr(self, name) for name in ("values", "sizes", "rounding", "shifts")}
        return replace(
            self,
            shapes=both(self.shapes, self.shapes[::-1]),
            outer={n: both(X, self.outer[-n]) for n, X in self.outer.items()},
            paired=np.zeros(len(self.paired) + self.paired.sum(), dtype=bool),
            **{name: both(X, X) for name, X in each.items()},
        )
