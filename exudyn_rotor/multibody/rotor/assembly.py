"""What ``mbs.Assemble()`` does for rotors with a script's own markers, and what it warns of.

Exudyn evaluates a marker on many mesh nodes at each of them, so it is moved to one or three nodes
with the same mean motion, which is linear in the modal coordinates. A marker's own offset turns
with the frame alone in Exudyn; that holds the tilts of Exudyn's body, which are modes here, so the
three nodes take the offset. Rigid markers get the axes of the mesh where those of the flexible body
are others. What a script attaches to markers at the node of the frame is pointed at markers that
move as the node of Exudyn's body, and seats that a call has put where the node stands go to the
mesh origin, where the node of Exudyn's body is.
"""

from __future__ import annotations

import warnings
from dataclasses import replace

import exudyn
import numpy as np
from exudyn.itemInterface import SensorUserFunction

from exudyn_rotor.multibody.rotor.connections import (
    NODE_MARKERS,
    ConnectionWarning,
    attached,
    lost_connections,
)
from exudyn_rotor.multibody.rotor.rotor_items import (
    Carrier,
    RotorItems,
    append_nodes,
    known_rotors,
    marker_carrier,
    marker_interface,
    shows_rotation,
)
from exudyn_rotor.theory.axis import skew

_NEEDED = {"SuperElementPosition": 1, "SuperElementRigid": 3}  # nodes of a condensed marker
_DENSE = (exudyn.LinearSolverType.EXUdense, exudyn.LinearSolverType.EigenDense)
_DENSE_MOST = 400  # coordinates whose dense factor costs less than a tenth of a second
_UNIT_SUM = 1e-12  # error of a sum of weights that is one
_THERE = 1e-6  # share of the distance of node and mesh origin: a marker that a call has put there


def prepare(mbs: exudyn.MainSystem) -> None:
    """Condense a script's markers on rotors, and let those at their nodes carry tilts."""
    for body in known_rotors(mbs):
        _watch_solvers(body)
        if body.motion.invariants.is_sparse:  # a full body has no mesh here, and no modes
            continue
        _refuse_foreign_stress(body)
        for number in range(mbs.systemData.NumberOfMarkers()):
            marker = mbs.GetMarker(number)
            at_body = int(marker.get("bodyNumber", -1)) == int(body.objects["marker_body"])
            if at_body and marker["markerType"] in _NEEDED:
                _give_mesh_axes(body, number, marker)
                _condense(body, number, mbs.GetMarker(number))
        _carry(body)


def _watch_solvers(body: RotorItems) -> None:
    """Let a run begin with what its solver lacks: explicit solvers take no constraints of motions.

    By a sensor, the last of them: solvers evaluate sensors before anything else.
    """
    name, size, told = body.name, body.layout.size, body.script.told
    held = bool(body.constraints and body.locks.prescribed)
    is_large = body.motion.invariants.is_sparse and size > _DENSE_MOST
    if body.script.is_watched or not (held or is_large):
        return
    body.script.is_watched = True
    slow = (
        f"rotor {name!r}: the linear solver of this run is a dense one, slow for the {size} "
        "coordinates of a full body; use recommended_settings(…, body=body), which takes "
        "LinearSolverType.EigenSparse"
    )

    def watch(mbs, t, sensors, factors, configuration):
        solver, settings = (mbs.sys.get(key) for key in ("dynamicSolver", "simulationSettings"))
        if held and isinstance(solver, exudyn.MainSolverExplicit):
            del mbs.sys["dynamicSolver"]  # or the next static solution would be refused
            raise ValueError(
                f"locking: rotor {name!r} is held by constraints, which explicit solvers do not "
                "take; use add_rotor(…, locking='mass') or an implicit solver"
            )
        dense = settings is not None and settings.linearSolver.solverType in _DENSE
        if is_large and dense and slow not in told:
            told.add(slow)
            warnings.warn(slow, UserWarning, stacklevel=4)
        return [0.0]

    item = SensorUserFunction(sensorUserFunction=watch, storeInternal=False, writeToFile=False)
    body.mbs.AddSensor(item)


def warn_of_lost_connections(mbs: exudyn.MainSystem, stacklevel: int) -> None:
    """Warn once of what rotors cannot carry, all of it in one sentence for each."""
    for body in known_rotors(mbs):
        new = [each for each in lost_connections(body) if each not in body.script.told]
        body.script.told.update(new)
        if new:
            message = f"rotor {body.name!r}: {'; '.join(new)}"
            warnings.warn(message, ConnectionWarning, stacklevel=stacklevel)


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


def _give_mesh_axes(body: RotorItems, number: int, marker: dict) -> None:
    """Turn a rigid marker of a script, and its offset, to the axes of the mesh; once."""
    own = max(marker["meshNodeNumbers"], default=-1) >= body.mesh_node_count
    if own or "localHT" not in marker or number in body.script.turned:
        return
    body.script.turned.add(number)
    local = np.array(marker["localHT"], dtype=float)
    local[:3, :3] = body.frame.B @ local[:3, :3]
    body.mbs.SetMarkerParameter(number, "localHT", local)
    body.mbs.SetMarkerParameter(number, "offset", body.frame.B @ marker["offset"])


def _condense(body: RotorItems, number: int, marker: dict) -> None:
    """Move a marker on many mesh nodes to nodes that are added to the flexible body.

    It stays as it is where its weights are negative or do not add up to one, where a rigid marker
    takes the rotation by the other formula (``useAlternativeApproach=False``) or has its nodes on a
    line.
    """
    nodes, weights = (np.asarray(marker[key]) for key in ("meshNodeNumbers", "weightingFactors"))
    rigid = marker["markerType"] == "SuperElementRigid"
    offset = np.asarray(marker["offset"] if rigid else np.zeros(3), dtype=float)
    if len(nodes) <= _NEEDED[marker["markerType"]] and not np.any(offset):
        return
    # Exudyn refuses other numbers of weights in Assemble()
    plain = len(nodes) == len(weights) == len(set(nodes.tolist())) and np.all(weights >= 0.0)
    if not plain or abs(np.sum(weights) - 1.0) > _UNIT_SUM:
        return
    if rigid and not (
        marker["useAlternativeApproach"] and shows_rotation(marker_interface(body.mbs, marker))
    ):
        return
    point, mbs = marker_carrier(body.mbs, marker), body.mbs
    # an offset turns with the rigid rotation that the modal coordinates hold
    motion = point.motion.copy()
    motion[:3] -= skew(offset) @ body.frame.B @ body.motion.invariants.mean_rotation
    point = replace(point, point=point.point + offset, motion=motion)
    virtual = append_nodes(mbs, point.body, *point.virtual_nodes("rigid" if rigid else "position"))
    mbs.SetMarkerParameter(number, "meshNodeNumbers", virtual)
    mbs.SetMarkerParameter(number, "weightingFactors", [1.0 / len(virtual)] * len(virtual))
    if rigid:
        mbs.SetMarkerParameter(number, "offset", np.zeros(3))


def _carry(body: RotorItems) -> None:
    """Point what uses markers at the node of a rotor's frame at markers that carry its tilts."""
    mbs, carriers = body.mbs, body.script.carriers
    own = {
        number: marker
        for number in range(mbs.systemData.NumberOfMarkers())
        if (marker := mbs.GetMarker(number))["markerType"] in NODE_MARKERS
        and int(marker["nodeNumber"]) == int(body.nodes["rigid"])
    }

    def carrier(number: int) -> int:
        if number in own and number not in carriers:
            carriers[number] = int(_add_node_marker(body, own[number]))
        return carriers.get(number, number)

    for number, item, markers in list(attached(mbs)) if own else ():
        if not own.keys().isdisjoint(markers):
            _place_at_origin(body, markers)
            carried = list(map(carrier, markers))
            if "loadType" in item:
                mbs.SetLoadParameter(number, "markerNumber", carried[0])
            else:
                mbs.SetObjectParameter(number, "markerNumbers", carried)
    for number in range(mbs.systemData.NumberOfSensors()):
        sensor = mbs.GetSensor(number)
        if sensor["sensorType"] == "Marker" and int(sensor["markerNumber"]) in own:
            mbs.SetSensorParameter(number, "markerNumber", carrier(int(sensor["markerNumber"])))


def _place_at_origin(body: RotorItems, markers: list[int]) -> None:
    """Move rigid markers of other bodies from the place of the frame's node to the mesh origin.

    Calls that get no position take the node's, which is beside the centre of mass, and the node of
    Exudyn's body is in the mesh origin.
    """
    mbs, kinds = body.mbs, exudyn.OutputVariableType
    beside = body.placement.position - body.frame.position
    for number in markers:
        marker = mbs.GetMarker(number)
        if marker["markerType"] != "BodyRigid":
            continue
        place, turn = (
            mbs.GetMarkerOutput(number, kind, exudyn.ConfigurationType.Reference)
            for kind in (kinds.Position, kinds.RotationMatrix)
        )
        if np.linalg.norm(place - body.frame.position) <= _THERE * np.linalg.norm(beside):
            local = np.array(marker["localHT"], dtype=float)
            local[:3, 3] += local[:3, :3] @ turn.reshape(3, 3).T @ beside
            mbs.SetMarkerParameter(number, "localHT", local)


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

    The node of Exudyn's body moves with the mean rigid motion of the rotor at the mesh origin x,
    ``u = A (Sζ/m + φ × (x − χ))`` and ``φ = I⁻¹ Σ M y × ψ ζ``, in which rigid modes have a share
    alone, and Craig–Bampton modes, which hold Exudyn's frame at a boundary
    (:mod:`exudyn_rotor.reduction.mean_axis`).
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
