"""When Exudyn forms a Jacobian, in which it differentiates connectors with Python functions.

It takes forward differences by every coordinate of such a connector and by every velocity, and
tells no one. But objects have their turn by number, in a Jacobian and in an evaluation of forces
alike: an object without mass and force, added before the connectors, has a function for each.
"""

from __future__ import annotations

import exudyn
import numpy as np
from exudyn.itemInterface import ObjectGenericODE2, VObjectGenericODE2

from exudyn_rotor.cached import kept
from exudyn_rotor.multibody.rotor.rotor_items import RotorItems

_SIZE = 6  # of the frame's node


class Differences:
    """The differences that Exudyn forms of a rotor's connectors.

    Attributes
    ----------
    formed : int
        Number of the Jacobian for which they are formed, from 1; 0 where forces are evaluated.
    """

    def __init__(self) -> None:
        self.formed = self._jacobians = 0

    def item(self, node: exudyn.NodeIndex) -> ObjectGenericODE2:
        """Return the object that notes what it is evaluated for, at the node of a frame."""
        none, nothing = [0.0] * _SIZE, np.zeros((_SIZE, _SIZE))

        def force(mbs, t, item, q, q_t):
            self.formed = 0
            return none

        def jacobian(mbs, t, item, q, q_t, factor_q, factor_v):
            self._jacobians += 1
            self.formed = self._jacobians
            return nothing

        return ObjectGenericODE2(
            nodeNumbers=[node],
            massMatrix=nothing,
            forceUserFunction=force,
            jacobianUserFunction=jacobian,
            visualization=VObjectGenericODE2(show=False),
        )


@kept
def differences_of(body: RotorItems) -> Differences:
    """Return those of a rotor's connectors that are added from the first call on."""
    noted = Differences()
    body.mbs.AddObject(noted.item(body.nodes["rigid"]))
    return noted
