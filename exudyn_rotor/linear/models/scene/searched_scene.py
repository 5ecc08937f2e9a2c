"""What the search for the steady motion of a scene needs of it."""

from __future__ import annotations

from typing import Protocol

import numpy as np


class Scene(Protocol):
    """What the search needs of a scene beside the members of :class:`SceneCoordinates`."""

    about: str

    @property
    def interfaces(self) -> tuple[str, ...]: ...
    @property
    def unit_unbalance(self) -> np.ndarray: ...
    @property
    def structural_damping(self) -> np.ndarray | None: ...
    def interface_motion(self, name: str) -> np.ndarray: ...
