"""What the search for the steady motion of a scene needs of it."""

from __future__ import annotations

from typing import Protocol

import numpy as np

Motion = tuple[np.ndarray, np.ndarray]  # orders (h,) and harmonics (h, k)


class Scene(Protocol):
    """What the search needs of a scene beside the members of :class:`SceneCoordinates`."""

    about: str

    @property
    def interfaces(self) -> tuple[str, ...]: ...
    @property
    def unit_unbalance(self) -> np.ndarray: ...
    def interface_motion(self, name: str) -> np.ndarray: ...
