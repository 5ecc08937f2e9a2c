"""The nodes of a rotor: its frame's, which the flexible body shares, and those of coordinates."""

from __future__ import annotations

from collections.abc import Sequence

import numpy as np
from exudyn.itemInterface import NodeGenericODE2, NodeRigidBodyRxyz, VNodeRigidBodyRxyz

from exudyn_rotor.multibody.rotor import inputs
from exudyn_rotor.multibody.rotor.plan import Plan


def rigid_node(plan: Plan) -> NodeRigidBodyRxyz:
    """Return the node of the frame, at its place and with its velocity at the start."""
    values, rates = np.zeros(6), np.zeros(6)
    start = plan.setup.placement
    values[:3], rates[:3] = start.translation, start.velocity
    spin, sign = plan.locks.spin, plan.locks.sign
    values[spin], rates[spin] = sign * start.angle, sign * start.speed
    return NodeRigidBodyRxyz(
        name=inputs.item_name("NodeRigidBody:", plan.setup.name),
        referenceCoordinates=[*plan.frame.position, *plan.frame.angles],
        initialCoordinates=values,
        initialVelocities=rates,
        visualization=VNodeRigidBodyRxyz(show=False),
    )


def generic_node(
    values: Sequence[float], rates: Sequence[float], name: str = ""
) -> NodeGenericODE2:
    """Return a node of coordinates with start values and rates."""
    return NodeGenericODE2(
        name=name,
        numberOfODE2Coordinates=len(values),
        referenceCoordinates=np.zeros(len(values)),
        initialCoordinates=values,
        initialCoordinates_t=rates,
    )
