"""Tilting pads in a scene: their tilts as coordinates, and the films between them and the journal.

The tilts [rad] are the coordinates of one ``NodeGenericODE2``, with the pads' inertia. They move
the virtual nodes of a massless ``ObjectFFRFreducedOrder`` that goes with the base: of each pad by
−R δ t where it tilts by δ (:mod:`exudyn_rotor.bearings.tilting_pad`). Each film is a connector
between such nodes and the journal, so that Exudyn knows all derivatives. Where the spin is free,
the massless body turns with the base, too, on which friction then bears; what the base's rotation
adds to that of a pad is left out.
"""

from __future__ import annotations

from dataclasses import replace

import exudyn
import numpy as np
from exudyn.itemInterface import (
    GenericJoint,
    MarkerNodeRigid,
    NodeRigidBodyRxyz,
    ObjectGenericODE2,
    VGenericJoint,
    VNodeRigidBodyRxyz,
    VObjectGenericODE2,
)

from exudyn_rotor.bearings.tilting_pad import TiltingPadBearing
from exudyn_rotor.multibody.rotor.plan import generic_node
from exudyn_rotor.multibody.rotor.rotor_items import RotorItems
from exudyn_rotor.multibody.supports.foundation_body import hold, massless_body, virtual_marker
from exudyn_rotor.multibody.supports.seats import Seat
from exudyn_rotor.multibody.supports.support_connectors import NATIVE, PYTHON, bearing_connector


def add_pads(
    body: RotorItems, bearing: TiltingPadBearing, seat: Seat
) -> tuple[tuple[exudyn.ObjectIndex, ...], tuple[str, ...]]:
    """Add films and pads of a bearing; return their objects, the pads last, and who evaluates."""
    mbs, radius = body.mbs, bearing.film.radius
    count = len(bearing.tangents)
    tilts = mbs.AddNode(generic_node(*np.zeros((2, count))))
    frame = mbs.AddNode(
        NodeRigidBodyRxyz(
            referenceCoordinates=[*seat.place, 0.0, 0.0, 0.0],
            visualization=VNodeRigidBodyRxyz(show=False),
        )
    )
    pads = mbs.AddObject(
        ObjectGenericODE2(
            nodeNumbers=[tilts],
            massMatrix=bearing.pad_inertia * np.eye(count),
            visualization=VObjectGenericODE2(show=False),
        )
    )
    carrier = mbs.AddObject(massless_body([frame, tilts], count))
    turns = body.formulation.has_spin
    if seat.base is None:
        hold(mbs, frame)
    else:
        base = replace(seat, axes=np.eye(3)).marker(mbs)
        joint = GenericJoint(
            markerNumbers=[base, mbs.AddMarker(MarkerNodeRigid(nodeNumber=frame))],
            constrainedAxes=[1, 1, 1, *[int(turns)] * 3],
            visualization=VGenericJoint(show=False),
        )
        mbs.AddObject(joint)
        if not turns:
            hold(mbs, frame, range(3, 6))
    films = []
    for number, one in enumerate(bearing.pad_bearings):
        motion = np.zeros((6, count))
        motion[:3, number] = -radius * seat.axes[:, :2] @ bearing.tangents[number]
        pad = virtual_marker(mbs, carrier, np.zeros(3), motion, seat.axes)
        films.append(bearing_connector(body, one, seat, pad))
    return (*films, pads), (*[PYTHON] * count, NATIVE)
