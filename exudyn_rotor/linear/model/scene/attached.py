"""What is attached to a rotor in a scene, evaluated at any state by the connectors of its laws.

Linear equations have a prescribed spin, and leave out moments of a static force F₀ by small motions
u: that it turns with what carries the bearing, and that friction on this changes, by about F₀ u.
Films that conserve mass have the force and the tangent of slow motions.
"""

from __future__ import annotations

from math import hypot

import exudyn
import numpy as np

from exudyn_rotor.bearings.bearing import Bearing
from exudyn_rotor.bearings.journal_bearing import FilmLaw, JournalBearing, tangent_of
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
        self.connector, self._cage, self._films = connector, cage, []
        read = mbs.systemData.GetNodeLTGODE2
        self.places = np.concatenate([read(node) for node in connector.nodes]).astype(int)
        if isinstance(connector, BearingConnector):
            self._films = [
                FilmLaw(part.film, connector.brakes) if isinstance(part, JournalBearing) else None
                for part in connector.parts
            ]

    def read(self, q: np.ndarray, q_t: np.ndarray) -> None:
        """Take the state of the scene."""
        self.connector.read(q[self.places].tolist(), q_t[self.places].tolist())

    def force(self, t: float) -> Force:
        """Return the law's forces on its ports where it has been read, and its tangent."""
        made = self.connector
        if not self._films:
            return made.tangent(t)
        parts = zip(made.parts, self._films, made.motions(), strict=True)
        return made.assembled([self._point(*each) for each in parts])

    def _point(self, part: Bearing, film: FilmLaw | None, motion: tuple[float, ...]) -> FilmPoint:
        if part.uses_angle:  # cages of rolling bearings stand
            motion = *motion[:4], self._cage, motion[5]
        if film is None:
            law = part.law_with_torque if self.connector.brakes else part.law
            values, slopes = law(*motion), part.slopes(*motion)
        else:
            values, slopes = film(*motion), film.slopes(*motion)
            if part.remembers and hypot(*motion[:2]) <= film.to_the_edge(*motion[:2]):
                place, rate = np.array(motion[:2]), np.array(motion[2:4])
                slopes = tangent_of(film.state_at(place, rate, motion[5]))
        return values, *slopes, np.zeros(3) if len(values) > 2 else None
