"""A script's own markers on many mesh nodes, moved to few nodes with the same mean motion.

Exudyn evaluates a super-element marker at every one of its nodes, and connectors at such markers
are differentiated numerically: with full Newton they take nine tenths of a step. What a marker
needs of its nodes is linear in the modal coordinates,

    position  Σ w (x + Ψζ),    rotation  W⁻¹ Σ w p̃ (Ψζ − Σ w Ψζ),    W = −Σ w p̃p̃,  p = x − Σ w x,

so that one node serves a position marker, and three a rigid one: nodes that move rigidly with this
displacement and rotation give the same marker to round-off.

Exudyn lets a marker's own offset turn with the frame alone. That holds the tilts of Exudyn's body,
which are modes here: the three nodes take the offset, and it turns with the rigid tilts.

Markers are known when the system is assembled: ``mbs.Assemble()`` does this first, for the rotors
of this package that stand in the ``mbs`` (:mod:`exudyn_rotor.multibody.calls.assembly`).
"""

from __future__ import annotations

import exudyn
import numpy as np

from exudyn_rotor.multibody.rotor.marker_body import append_nodes, virtual_nodes
from exudyn_rotor.solid.interface import rotation_moments
from exudyn_rotor.theory.axis import SpinAxis
from exudyn_rotor.theory.nodal import skew

_BODIES = "exudyn_rotor: bodies whose markers are condensed"  # key in mbs.sys
_NEEDED = {"SuperElementPosition": 1, "SuperElementRigid": 3}  # nodes of a condensed marker
_UNIT_SUM = 1e-12  # error of a sum of weights that is one
_Z = SpinAxis([0.0, 0.0, 1.0])  # of the plane of the three nodes; any serves
_SINGULAR = 1e-10  # ratio of eigenvalues of W: nodes on a line, which Exudyn refuses itself


def at_assembly(
    mbs: exudyn.MainSystem, marker_body: exudyn.ObjectIndex, wanted: bool, tilts: np.ndarray
) -> None:
    """Say whether ``mbs.Assemble()`` condenses the markers on a marker body.

    `tilts` (3, m) is the rigid rotation that the modal coordinates hold, axes of the body.
    """
    mbs.sys.setdefault(_BODIES, {})[int(marker_body)] = tilts if wanted else None


def condense_markers(
    mbs: exudyn.MainSystem, marker_body: exudyn.ObjectIndex | int, tilts: np.ndarray
) -> int:
    """Move markers on many mesh nodes of a marker body to nodes that are added to it.

    Markers stay as they are where their weights do not add up to one, where a rigid marker takes
    the rotation by the other formula (``useAlternativeApproach=False``) or has its nodes on a line.

    Returns
    -------
    int
        Number of markers that were moved.
    """
    chosen = [
        (number, marker)
        for number, marker in enumerate(_markers_on(mbs, int(marker_body)))
        if marker is not None and _can_be_condensed(marker)
    ]
    if not chosen:
        return 0
    body = mbs.GetObject(marker_body)
    points = np.asarray(body["referencePositions"]).reshape(-1, 3)
    shapes = np.asarray(body["modeBasis"]).reshape(len(points), 3, -1)
    new_points, new_columns, places = [], [], []
    count = len(points)
    for number, marker in chosen:
        nodes = np.asarray(marker["meshNodeNumbers"])
        weights = np.asarray(marker["weightingFactors"])
        offset = _offset(marker)
        moved = _condensed(marker["markerType"], points[nodes], shapes[nodes], weights)
        if moved is None:
            continue
        new_points.append(moved[0] + offset)
        new_columns.append(moved[1] - np.tile(skew(offset) @ tilts, (len(moved[0]), 1)))
        places.append((number, list(range(count, count + len(moved[0])))))
        count += len(moved[0])
    if places:
        append_nodes(mbs, marker_body, np.vstack(new_points), np.vstack(new_columns))
    for number, nodes in places:
        mbs.SetMarkerParameter(number, "meshNodeNumbers", nodes)
        mbs.SetMarkerParameter(number, "weightingFactors", [1.0 / len(nodes)] * len(nodes))
        if len(nodes) == 3:
            mbs.SetMarkerParameter(number, "offset", np.zeros(3))
    return len(places)


def _markers_on(mbs: exudyn.MainSystem, body: int) -> list[dict | None]:
    """Return the super-element markers on a body, None for all other markers."""
    markers = (mbs.GetMarker(number) for number in range(mbs.systemData.NumberOfMarkers()))
    return [
        marker if marker["markerType"] in _NEEDED and int(marker["bodyNumber"]) == body else None
        for marker in markers
    ]


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
    return virtual_nodes(center, float(np.sqrt(sizes[-1])), motion, _Z)


def _is_marker_body(mbs: exudyn.MainSystem, number: int) -> bool:
    """Return whether the object is still that of a rotor: an ``mbs`` can be reset."""
    if number >= mbs.systemData.NumberOfObjects():
        return False
    item = mbs.GetObject(number)
    if item["objectType"] != "FFRFreducedOrder":
        return False
    return not (item["computeFFRFterms"] or item["massMatrixUserFunction"])


def condense_all(mbs: exudyn.MainSystem) -> None:
    """Condense the markers of all rotors of which :func:`at_assembly` says so."""
    for number, tilts in mbs.sys.get(_BODIES, {}).items():
        if tilts is not None and _is_marker_body(mbs, number):
            condense_markers(mbs, number, tilts)
