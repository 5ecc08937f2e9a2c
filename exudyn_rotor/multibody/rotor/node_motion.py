"""What moves as the node of Exudyn's own flexible body: a rotor's mean rigid motion at a point.

The frame of Exudyn's flexible body tilts, and moves, with the rotor. That of a fixed axis turns
only; tilts are modes, and so are translations that the formulation does not have. A force on its
node would act in the centre of mass, whatever the node's place, and a torque across the axis on
nothing. What moves as the node of Exudyn's body is the mean rigid motion of the rotor at a point x,

    u = A (Sζ/m + φ × (x − χ)),    φ = I⁻¹ Σ M y × ψ ζ,

in which rigid modes have a share alone, and Craig–Bampton modes, which hold Exudyn's frame at a
boundary (:mod:`exudyn_rotor.reduction.mean_axis`).

Tilts about the node's place in the basis, ``S ≠ 0``, would move the node itself, but not tilt it;
they couple translations and tilts by ``A S``, so that no matrix is constant, and a step takes five
times as long with a free spin and twelve times at constant speed.
"""

from __future__ import annotations

import exudyn
import numpy as np
from exudyn.itemInterface import MarkerSuperElementPosition, MarkerSuperElementRigid

from exudyn_rotor.multibody.rotor.marker_body import append_nodes, virtual_nodes
from exudyn_rotor.multibody.rotor.rotor_items import KnownRotor
from exudyn_rotor.theory.axis import SpinAxis
from exudyn_rotor.theory.nodal import skew

NODE_MARKERS = ("NodeRigid", "NodePosition")
_Z = SpinAxis([0.0, 0.0, 1.0])  # of the plane of the three nodes; any serves


def mean_motion(rotor: KnownRotor) -> np.ndarray:
    """Return the mean displacement and rotation at the node (6, m), axes of the flexible body."""
    selection, frame = rotor.plan.selection, rotor.plan.frame
    reduced = selection.source
    inv, rigid = reduced.invariants, len(reduced.rigid_kinds)
    columns = selection.T[:rigid]
    if rotor.frame_shares is not None:
        columns = columns + rotor.frame_shares @ selection.T[rigid:]
    turn = inv.mean_rotation[:, :rigid]
    arm = frame.node - reduced.center_of_mass
    shift = inv.S[:, :rigid] / inv.mass - skew(arm) @ turn
    return np.vstack([frame.B @ shift, frame.B @ turn]) @ columns


def add_node_marker(mbs: exudyn.MainSystem, rotor: KnownRotor, given: dict) -> exudyn.MarkerIndex:
    """Add a marker with the mean rigid motion that stands for a marker at the node.

    `given` are the entries of a rigid or position marker, of which the type and ``localHT`` count.
    """
    frame, inv = rotor.plan.frame, rotor.plan.motion.invariants
    motion, place = mean_motion(rotor), frame.points(frame.node)
    rigid = given["markerType"] == "NodeRigid"
    places, columns = place[None, :], motion[:3]
    if rigid:
        arm = float(np.sqrt(np.trace(inv.J) / inv.mass))
        places, columns = virtual_nodes(place, arm, motion, _Z)
    nodes = append_nodes(mbs, rotor.marker_body, places, columns)
    common = {
        "bodyNumber": rotor.marker_body,
        "meshNodeNumbers": nodes,
        "weightingFactors": [1.0 / len(nodes)] * len(nodes),
        "visualization": {"show": False, "showMarkerNodes": False},
    }
    if not rigid:
        return mbs.AddMarker(MarkerSuperElementPosition(**common))
    turn = np.eye(4)  # Exudyn takes no other place than the node's
    turn[:3, :3] = frame.B @ np.asarray(given["localHT"], dtype=float)[:3, :3]
    return mbs.AddMarker(MarkerSuperElementRigid(localHT=turn, **common))
