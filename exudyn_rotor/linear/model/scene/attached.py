"""What is attached to a rotor in a scene, evaluated at any state by the connectors of its laws.

Linear equations have a prescribed spin, and leave out moments of a static force F₀ by small motions
u: that it turns with what carries the bearing, and that friction on this changes, by about F₀ u.
"""

from __future__ import annotations

import exudyn
import numpy as np

from exudyn_rotor.bearings.bearing import Bearing
from exudyn_rotor.multibody.supports.connector import BearingConnector, Connector, FilmPoint, Force


class Attached:
    """A law that is attached to the rotor, at any state of a scene.

    Attributes
    ----------
    connector : Connector
    places : ndarray of int
        Its coordinates among those of the scene.
    """

    def __init__(self, mbs: exudyn.MainSystem, connector: Connector, cage: float) -> None:
        self.connector, self._cage = connector, cage
        read = mbs.systemData.GetNodeLTGODE2
        self.places = np.concatenate([read(node) for node in connector.nodes]).astype(int)

    def read(self, q: np.ndarray, q_t: np.ndarray) -> None:
        """Take the state of the scene."""
        self.connector.read(q[self.places].tolist(), q_t[self.places].tolist())

    def force(self, t: float) -> Force:
        """Return the law's forces on its ports where it has been read, and its tangent."""
        made = self.connector
        if not isinstance(made, BearingConnector):
            return made.tangent(t)
        parts = zip(made.parts, made.motions(), strict=True)
        return made.assembled([self._point(*each) for each in parts])

    def _point(self, part: Bearing, motion: tuple[float, ...]) -> FilmPoint:
        if part.uses_angle:  # cages of rolling bearings stand
            motion = *motion[:4], self._cage, motion[5]
        brakes = self.connector.brakes
        law = part.law_with_torque if brakes else part.law
        return law(*motion), *part.slopes(*motion), np.zeros(3) if brakes else None
