"""What ``mbs.Assemble()`` does for rotors with a script's own markers, and what it warns of.

Before a scene is assembled:

- A script's markers on many mesh nodes are moved to one or three nodes with the same mean motion.
  Exudyn evaluates a super-element marker at every one of its nodes, and connectors at such markers
  are differentiated numerically. What a marker needs of its nodes is linear in the modal
  coordinates,

      position  Σ w (x + Ψζ),    rotation  W⁻¹ Σ w p̃ (Ψζ − Σ w Ψζ),    W = −Σ w p̃p̃,  p = x − Σ w x,

  so that nodes that move rigidly with this displacement and rotation give the same marker to
  round-off. A marker's own offset turns with the frame alone in Exudyn; that holds the tilts of
  Exudyn's body, which are modes here, so the three nodes take the offset.
- Where the axes of the flexible body are not those of the mesh, rigid markers get the latter.
- What a script attaches to rigid and position markers at the node of the frame is pointed at
  markers that move as the node of Exudyn's body ; see
  :func:`mean_motion`.

Afterwards one warning names what a rotor cannot carry.
"""

from __future__ import annotations

import warnings

import exudyn
import numpy as np

from exudyn_rotor.multibody.rotor.connections import (
    NODE_MARKERS,
    ConnectionWarning,
    lost_connections,
)
from exudyn_rotor.multibody.rotor.rotor_items import (
    Carrier,
    RotorItems,
    append_nodes,
    known_rotors,
    virtual_nodes,
)
from exudyn_rotor.solid.rotor import rotation_moments
from exudyn_rotor.theory.axis import skew

_NEEDED = {"SuperElementPosition": 1, "SuperElementRigid": 3}  # nodes of a condensed marker
_UNIT_SUM = 1e-12  # error of a sum of weights that is one
_SINGULAR = 1e-10  # ratio of eigenvalues of W: nodes on a line, which Exudyn refuses itself


def prepare(mbs: exudyn.MainSystem) -> None:
    """Condense a script's markers on rotors, and let those at their nodes carry tilts."""
    for body in known_rotors(mbs):
        if body.motion.invariants.is_sparse:  # a full body has no mesh here, and no modes
            continue
        _refuse_foreign_stress(body)
        _give_mesh_axes(body)
        _condense(body)
        _carry(body)


def warn_of_lost_connections(mbs: exudyn.MainSystem, stacklevel: int) -> None:
    """Warn once of what rotors cannot carry, all of it in one sentence for each."""
    for body in known_rotors(mbs):
        new = [each for each in lost_connections(body) if each not in body.script.told]
        body.script.told.update(new)
        if new:
            message = f"rotor {body.name!r}: {'; '.join(new)}"
            warnings.warn(message, ConnectionWarning, stacklevel=stacklevel)


def _markers(body: RotorItems) -> dict[int, dict]:
    """Return the super-element markers on a rotor."""
    every = {n: body.mbs.GetMarker(n) for n in range(body.mbs.systemData.NumberOfMarkers())}
    return {
        number: marker
        for number, marker in every.items()
        if marker["markerType"] in _NEEDED
        and int(marker["bodyNumber"]) == int(body.objects["marker_body"])
    }


def _refuse_foreign_stress(body: RotorItems) -> None:
    """Refuse stress modes of a FEMinterface, which are in other coordinates than the rotor's."""
    item = body.mbs.GetObject(body.objects["marker_body"])
    shape, stress = np.shape(item["modeBasis"]), np.asarray(item["outputVariableModeBasis"])
    if stress.size and stress.shape != (shape[0] // 3, 6 * shape[1]):
        raise ValueError(
            f"outputVariableModeBasis: of the flexible body of rotor {body.name!r} "
            f"needs the shape {(shape[0] // 3, 6 * shape[1])}, got {stress.shape}; the rotor takes "
            "the stress modes that a FEMinterface has when it is added"
        )


def _give_mesh_axes(body: RotorItems) -> None:
    """Turn rigid markers of a script, and their offsets, to the axes of the mesh."""
    B, mbs = body.frame.B, body.mbs
    if body.frame.has_mesh_axes:
        return
    for number, marker in _markers(body).items():
        if marker["markerType"] != "SuperElementRigid" or number in body.script.turned:
            continue
        if max(marker["meshNodeNumbers"], default=-1) >= body.mesh_node_count:
            continue  # the package's own
        body.script.turned.add(number)
        local = np.array(marker["localHT"], dtype=float)
        local[:3, :3] = B @ local[:3, :3]
        mbs.SetMarkerParameter(number, "localHT", local)
        mbs.SetMarkerParameter(number, "offset", B @ marker["offset"])


def _condense(body: RotorItems) -> None:
    """Move markers on many mesh nodes to nodes that are added to the flexible body.

    Markers stay as they are where their weights do not add up to one, where a rigid marker takes
    the rotation by the other formula (``useAlternativeApproach=False``) or has its nodes on a line.
    """
    chosen = {n: m for n, m in _markers(body).items() if _can_be_condensed(m)}
    if not chosen:
        return
    mbs, marker_body = body.mbs, body.objects["marker_body"]
    # the rigid rotation that the modal coordinates hold, axes of the body
    tilts = body.frame.B @ body.motion.invariants.mean_rotation
    item = mbs.GetObject(marker_body)
    points = np.asarray(item["referencePositions"]).reshape(-1, 3)
    shapes = np.asarray(item["modeBasis"]).reshape(len(points), 3, -1)
    places, columns, numbers = [], [], {}
    count = len(points)
    for number, marker in chosen.items():
        nodes, weights = (np.asarray(marker[k]) for k in ("meshNodeNumbers", "weightingFactors"))
        moved = _condensed(marker["markerType"], points[nodes], shapes[nodes], weights)
        if moved is None:
            continue
        offset = _offset(marker)
        places.append(moved[0] + offset)
        columns.append(moved[1] - np.tile(skew(offset) @ tilts, (len(moved[0]), 1)))
        numbers[number] = list(range(count, count + len(moved[0])))
        count += len(moved[0])
    if numbers:
        append_nodes(mbs, marker_body, np.vstack(places), np.vstack(columns))
    for number, nodes in numbers.items():
        mbs.SetMarkerParameter(number, "meshNodeNumbers", nodes)
        mbs.SetMarkerParameter(number, "weightingFactors", [1.0 / len(nodes)] * len(nodes))
        if len(nodes) == 3:
            mbs.SetMarkerParameter(number, "offset", np.zeros(3))


def _can_be_condensed(marker: dict) -> bool:
    few = len(marker["meshNodeNumbers"]) <= _NEEDED[marker["markerType"]]
    if few and not np.any(_offset(marker)):
        return False
    if len(marker["meshNodeNumbers"]) != len(marker["weightingFactors"]):
        return False  # Exudyn says so in Assemble()
    unit = abs(np.sum(marker["weightingFactors"]) - 1.0) <= _UNIT_SUM
    return bool(unit and marker.get("useAlternativeApproach", True))


def _offset(marker: dict) -> np.ndarray:
    """Return the offset of a marker, axes of the body."""
    return np.asarray(marker.get("offset", np.zeros(3)), dtype=float)


def _condensed(
    kind: str, points: np.ndarray, shapes: np.ndarray, weights: np.ndarray
) -> tuple[np.ndarray, np.ndarray] | None:
    """Return nodes (1 or 3, 3) and columns (3 or 9, m) with the same mean motion, if there are."""
    center, mean = weights @ points, np.einsum("n,nak->ak", weights, shapes)
    if kind == "SuperElementPosition":
        return center[None, :], mean
    W, levers = rotation_moments(points - center, weights)
    sizes = np.linalg.eigvalsh(0.5 * (W + W.T))
    if sizes[0] <= _SINGULAR * sizes[-1]:
        return None
    turn = np.linalg.solve(W, np.einsum("nab,nbk->ak", levers, shapes - mean))
    motion = np.vstack([mean, turn])
    return virtual_nodes(center, float(np.sqrt(sizes[-1])), motion)


def _carry(body: RotorItems) -> None:
    """Point what uses markers at the node of a rotor's frame at markers that carry its tilts."""
    mbs, carriers = body.mbs, body.script.carriers
    own = {
        number: marker
        for number in range(mbs.systemData.NumberOfMarkers())
        if (marker := mbs.GetMarker(number))["markerType"] in NODE_MARKERS
        and int(marker["nodeNumber"]) == int(body.nodes["rigid"])
    }
    if not own:
        return

    def carrier(number: object) -> int:
        number = int(number)
        if number in own and number not in carriers:
            carriers[number] = int(_add_node_marker(body, own[number]))
        return carriers.get(number, number)

    for number in range(mbs.systemData.NumberOfObjects()):
        given = list(map(int, mbs.GetObject(number).get("markerNumbers", [])))
        if any(each in own for each in given):
            mbs.SetObjectParameter(number, "markerNumbers", [carrier(each) for each in given])
    for number in range(mbs.systemData.NumberOfLoads()):
        given = int(mbs.GetLoad(number)["markerNumber"])
        if given in own:
            mbs.SetLoadParameter(number, "markerNumber", carrier(given))
    for number in range(mbs.systemData.NumberOfSensors()):
        sensor = mbs.GetSensor(number)
        if sensor["sensorType"] == "Marker" and int(sensor["markerNumber"]) in own:
            mbs.SetSensorParameter(number, "markerNumber", carrier(sensor["markerNumber"]))


def _add_node_marker(body: RotorItems, given: dict) -> exudyn.MarkerIndex:
    """Add a marker that stands for a script's `given` rigid or position marker at the node."""
    frame, inv = body.frame, body.motion.invariants
    point = Carrier(
        body.objects["marker_body"],
        frame.points(np.zeros(3)),
        mean_motion(body),
        float(np.sqrt(np.trace(inv.J) / inv.mass)),
    )
    if given["markerType"] == "NodePosition":
        return point.add_marker(body.mbs, "position")
    # Exudyn takes no other place than the node's
    axes = frame.B @ np.asarray(given["localHT"], dtype=float)[:3, :3]
    return point.add_marker(body.mbs, "rigid", axes)


def mean_motion(body: RotorItems) -> np.ndarray:
    """Return the mean displacement and rotation at the node (6, m), axes of the flexible body.

    The frame of Exudyn's flexible body tilts, and moves, with the rotor. The frame of a fixed axis
    turns only; tilts are modes, and so are translations that the formulation does not have. What
    moves as the node of Exudyn's body is the mean rigid motion of the rotor at the mesh origin x,

        u = A (Sζ/m + φ × (x − χ)),    φ = I⁻¹ Σ M y × ψ ζ,

    in which rigid modes have a share alone, and Craig–Bampton modes, which hold Exudyn's frame at a
    boundary (:mod:`exudyn_rotor.reduction.mean_axis`).

    Tilts about the node's place in the basis, ``S ≠ 0``, would move the node itself, but not tilt
    it; they couple translations and tilts by ``A S``, so that no matrix is constant, and a step
    takes five times as long with a free spin and twelve times at constant speed.
    """
    selection, B = body.selection, body.frame.B
    reduced = selection.source
    inv, rigid = reduced.invariants, len(reduced.rigid_kinds)
    columns = selection.T[:rigid]
    if body.script.frame_shares is not None:
        columns = columns + body.script.frame_shares @ selection.T[rigid:]
    turn = inv.mean_rotation[:, :rigid]
    shift = inv.S[:, :rigid] / inv.mass + skew(reduced.center_of_mass) @ turn
    return np.vstack([B @ shift, B @ turn]) @ columns
