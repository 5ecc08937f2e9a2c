"""What the modes of a run leave out: the static response to its loads beyond the modes.

The loads F where something acts on the rotor (:mod:`exudyn_rotor.multibody.load_places`) follow
from the equations of motion, ``Uᵀ F = f`` with the motion U of these places, in the sense of least
squares. They deform the rotor by more than the run shows, and its own centrifugal load stretches it
by more: at interfaces by what attachment modes have beyond the modes, at nodes by
``K⁺(F + ω²h) − Σ φφᵀ(F + ω²h)/ω_k²`` of the full model, by inertia relief. The inertia of modes
that are left out does not count: next to a resonance, and after a sudden start, that is more.
"""

from __future__ import annotations

from typing import TYPE_CHECKING

import numpy as np

from exudyn_rotor.advice.run_loads import external_load, instants, turned, weight
from exudyn_rotor.multibody.load_places import LoadPlace, load_places
from exudyn_rotor.multibody.rotor.record import Record
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.solid.tensor import von_mises
from exudyn_rotor.solid_rotor import SolidRotor
from exudyn_rotor.solvers.inertia_relief import inertia_relief
from exudyn_rotor.strength.field import StressField
from exudyn_rotor.theory.nodal import skew

if TYPE_CHECKING:
    from exudyn_rotor.advice.run_measures import Measures

_SEEN = 1e-3  # singular values below this share of the largest tell nothing about loads
_MOST = 60  # instants at which nodes are looked at
_SAME = 1e-6  # relative difference of masses and places of one rotor
_STILL = 1e-5  # of the rotor's size: motion that counts as none
_TOLERANCE = 1e-8  # what iteration may leave of a load


def check_model(body: RotorBody, reduced: ReducedRotor, solid: SolidRotor) -> None:
    """Refuse what :func:`left_out_at_nodes` cannot take."""
    if "marker_body" not in body.objects:
        raise ValueError(
            f"solid: rotor {body.name!r} was added with marker_body=False, and nothing tells where "
            "it is loaded; leave solid out"
        )
    if reduced.shapes is None:
        raise ValueError(
            "reduced: has no shapes, which the error at nodes needs (solid=…); reduce with "
            "keep_shapes=True"
        )
    if not body.selection.is_of(reduced):
        raise ValueError(
            "reduced: has other modes than the rotor in the scene, and the error at nodes needs "
            "those (solid=…); give the one that was added, as proposal.truncated(…) for a proposal"
        )
    nodes, mass = reduced.shapes.nodes, reduced.invariants.mass
    same = solid.nodes.shape == nodes.shape and abs(solid.total_mass - mass) <= _SAME * mass
    same = same and np.abs(solid.nodes - nodes).max() <= _SAME * np.ptp(nodes, axis=0).max()
    if not same or set(body.selection.source.interfaces) - set(solid.interfaces):
        raise ValueError(
            f"solid: {solid!r} is not the model of {reduced!r}, with {len(nodes)} nodes; give the "
            "SolidRotor that was reduced"
        )


def residual_deflection(body: RotorBody, record: Record, size: float) -> float | None:
    """Return the deflection at interfaces that the modes leave out, over their displacement.

    Against the rotor's mean motion. Stiff supports let the interfaces move less than the rotor
    bends; then over its bending there. Loads elsewhere, and on the spin of the frame, do not count.
    `size` [m] makes forces and moments comparable. None where it is not known what the modes leave
    out.
    """
    rotor = body.selection.source
    if rotor.with_attachments is None or not rotor.interfaces or "marker_body" not in body.objects:
        return None
    if len(record.time) < 2:
        return 0.0
    picked = instants(record)
    loads, zeta, frame = _states(body, record, picked)
    motion, flexible = _motion(rotor)
    columns = body.selection.T @ zeta
    bent = motion @ np.where(flexible[:, None], columns, 0.0)
    moved = motion @ columns
    moved += np.tile(np.vstack([frame, np.zeros_like(frame)]), (len(rotor.interfaces), 1))
    rest = _flexibility(rotor.with_attachments) - _flexibility(rotor)
    stretch = _stretch(rotor.with_attachments, body) - _stretch(rotor, body)
    left_out = np.outer(stretch, record.speed[picked] ** 2)
    left_out += rest @ _at_interfaces(rotor, _place_loads(body, loads, size), len(picked))
    shown = np.tile([True] * 3 + [False] * 3, len(rotor.interfaces))
    missing, *sizes = (
        np.linalg.norm(values[shown], axis=0).max() for values in (left_out, moved, bent)
    )
    return float(missing / max(*sizes, _STILL * size))


def left_out_at_nodes(
    measures: Measures, solid: SolidRotor, nodes: np.ndarray
) -> dict[str, tuple[np.ndarray, np.ndarray]]:
    """Return what the modes of a run leave out at nodes, over at most 60 instants.

    Parameters
    ----------
    measures : Measures
        With the reduced rotor, which has shapes; with its stress modes for the stress.
    solid : SolidRotor
        The full model of it.
    nodes : ndarray of int, shape (n,)

    Returns
    -------
    dict
        ``'displacement'`` and, where it is known, ``'stress'``: lengths [m] or von Mises stresses
        [Pa] of what is left out, and of the whole with it, (s, n) each.
    """
    body, record, reduced = measures.body, measures.record, measures.reduced
    picked = instants(record, _MOST)
    speed, count = record.speed[picked], len(picked)
    loads, zeta, frame = _states(body, record, picked)
    forces = np.zeros((3 * solid.node_count, count + 1))
    about = solid.nodes - body.selection.origin
    e = body.motion.invariants.direction
    forces[:, count] = solid.mass @ (about - np.outer(about @ e, e)).ravel()
    for place, values in _place_loads(body, loads, measures.size):
        columns = place.load_columns(solid)
        if columns is not None:
            forces[:, :count] += columns @ values
    modes = reduced.shapes.matrix[:, len(reduced.rigid_kinds) :]
    shown = modes @ (
        (modes.T @ forces) / reduced.frequencies[len(reduced.rigid_kinds) :, None] ** 2
    )
    left = inertia_relief(solid).solve(forces, _TOLERANCE) - shown
    by_loads, stretch = left[:, :count], np.outer(left[:, count], speed**2)
    missing = by_loads + stretch
    moved = reduced.shapes.matrix @ (body.selection.T @ zeta) + missing

    def lengths(field: np.ndarray, shift: np.ndarray) -> np.ndarray:
        return np.linalg.norm(field.reshape(-1, 3, count)[nodes] + shift, axis=1).T

    found = {"displacement": (lengths(missing, 0.0 * frame), lengths(moved, frame))}
    if reduced.shapes.stress is not None and solid.stress_recovery is not None:
        field = StressField.of(reduced, body)
        # it adds the static stress by the spin to that of the modes
        unknown = by_loads if field.has_static else missing
        unseen = np.moveaxis(solid.stress_recovery(unknown)[nodes], 2, 0)
        whole = field.history(zeta.T, speed, nodes) + unseen
        found["stress"] = von_mises(unseen), von_mises(whole)
    return found


def _place_loads(
    body: RotorBody, loads: np.ndarray, size: float
) -> list[tuple[LoadPlace, np.ndarray]]:
    """Return the places of the rotor's loads, with forces and moments there (3 or 6, s).

    In mesh axes, which turn with the rotor. `loads` are those of :func:`_states`.
    """
    places = load_places(body)
    if not places:
        return []
    counts = [len(place.motion) for place in places]
    scale = np.concatenate([([1.0] * 3 + [size] * 3)[:count] for count in counts])
    on_modes = np.vstack([place.motion for place in places]).T
    forces = np.hstack([np.eye(3, len(place.motion)) for place in places])
    e = body.motion.invariants.direction
    free = {0: np.zeros((3, 3)), 2: np.eye(3) - np.outer(e, e), 3: np.eye(3)}
    frame = free[body.formulation.translation_count] @ forces
    equations = np.vstack([on_modes, frame / np.sqrt(body.motion.invariants.mass)])
    solve = np.linalg.pinv(equations * scale, rcond=_SEEN)
    found = np.split(scale[:, None] * (solve @ loads), np.cumsum(counts)[:-1])
    return list(zip(places, found, strict=True))


def _at_interfaces(
    rotor: ReducedRotor, found: list[tuple[LoadPlace, np.ndarray]], count: int
) -> np.ndarray:
    """Return forces and moments (6n, count) about the reference points of all interfaces."""
    names = list(rotor.interfaces)
    total = np.zeros((len(names), 6, count))
    for place, values in found:
        if place.interface is not None:
            row = total[names.index(place.interface)]
            row[: len(values)] += values
            arm = place.point - rotor.interfaces[place.interface].reference
            row[3:] += skew(arm) @ values[:3]
    return total.reshape(6 * len(names), count)


def _motion(rotor: ReducedRotor) -> tuple[np.ndarray, np.ndarray]:
    """Return the motion of all interfaces (6n, k), and which columns are flexible."""
    flexible = np.arange(rotor.size) >= len(rotor.rigid_kinds)
    return np.vstack([one.motion for one in rotor.interfaces.values()]), flexible


def _flexibility(rotor: ReducedRotor) -> np.ndarray:
    """Return ``Σ φ φᵀ/ω²`` of the flexible modes at the interfaces, (6n, 6n)."""
    motion, flexible = _motion(rotor)
    scaled = motion[:, flexible] / rotor.frequencies[flexible]
    return scaled @ scaled.T


def _stretch(rotor: ReducedRotor, body: RotorBody) -> np.ndarray:
    """Return the static motion of the interfaces by the centrifugal load per ω², (6n,)."""
    motion, flexible = _motion(rotor)
    h = rotor.invariants.moved(body.selection.origin - rotor.center_of_mass).h
    return motion[:, flexible] @ (h[flexible] / rotor.frequencies[flexible] ** 2)


def _states(
    body: RotorBody, record: Record, picked: np.ndarray
) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """Return the states at instants, in columns.

    Loads on modes and frame, over √m, without the weight; modal coordinates; how far the frame's
    axis has moved, in its own axes (3, s).
    """
    motion = body.motion
    mass, rows = motion.invariants.mass, []
    # the frame may stand in a centre of mass off the axis, and that circles about it
    arm = body.selection.origin - body.axis.project(body.selection.origin)
    for index in picked:
        external = external_load(body, record, index)[1]
        q = record.q[index]
        turn, unknowns = turned(body, q), q[body.layout.unknowns]
        along = turn.T @ motion.free_directions
        on_modes = external[motion.modes] - motion.invariants.S.T @ turn.T @ weight(body) / mass
        on_frame = along @ (external[motion.translations] - motion.free_directions.T @ weight(body))
        frame = along @ unknowns[motion.translations] + turn.T @ motion.orientation @ arm - arm
        loads = np.concatenate([on_modes, on_frame / np.sqrt(mass)])
        rows.append((loads, unknowns[motion.modes], frame))
    return tuple(np.array(part).T for part in zip(*rows, strict=True))
