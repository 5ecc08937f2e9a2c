"""The spin axis of a body whose script does not name one."""

from __future__ import annotations

import numpy as np
from exudyn.FEM import FEMinterface

from exudyn_rotor.solid.fem_interface import import_model
from exudyn_rotor.theory.axis import SpinAxis


def axis_through_seats(fem: FEMinterface) -> SpinAxis:
    """Return the line through the centres of the node sets, for a rotor that starts at rest.

    The seats of bearings and couplings lie on the spin axis. A line that is a mesh axis but for the
    unevenness of the mesh is taken as that axis.

    Raises
    ------
    ValueError
        If there are fewer than two seats, or their centres are not on one line.
    """
    model = import_model(fem)
    positions = np.asarray(model.nodes)
    centers = np.array(
        [
            np.average(positions[nodes], axis=0, weights=weights)
            for nodes, weights in model.node_sets.values()
        ]
    ).reshape(-1, 3)
    mean = centers.mean(axis=0) if len(centers) else np.zeros(3)
    _, spread, lines = np.linalg.svd(centers - mean)
    if len(centers) < 2 or spread[0] == 0.0 or np.any(spread[1:] > _UNEVEN * spread[0]):
        raise ValueError(
            "the spin axis is not known: the rotor starts at rest, and the centres of its "
            f"{len(centers)} node sets are not on one line; give axis='x', 'y', 'z' or a "
            "direction in mesh coordinates"
        )
    direction = lines[0] * np.sign(lines[0][np.argmax(np.abs(lines[0]))])
    nearest = np.eye(3)[np.argmax(direction)]
    offset = mean - nearest * (nearest @ mean)
    if np.linalg.norm(direction - nearest) < _UNEVEN:
        direction = nearest
        if np.linalg.norm(offset) < _UNEVEN * spread[0]:
            mean = np.zeros(3)
    return SpinAxis(direction, mean)


# share of the length by which an uneven mesh may put the centres of round faces off the axis
_UNEVEN = 1e-2
