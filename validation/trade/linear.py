"""What modes and mesh cost in accuracy, from the steady unbalance response without time steps."""

from __future__ import annotations

from collections.abc import Iterable

import numpy as np
from tqdm import tqdm

from exudyn_rotor import ReducedRotor, SolidRotor, Support, Unbalance, unbalance_response
from exudyn_rotor.demo.scene import BEARINGS, START_SPEED
from exudyn_rotor.linear.response.response import UnbalanceResponse
from exudyn_rotor.theory.rotating_axes import axes_of
from validation.trade.error import Row
from validation.trade.scene import CRAIG_BAMPTON, FREE, RIM, UNBALANCE, Rotor

STIFFNESS, DAMPING = (2e6, 1.2e6, 1.6e6), 200.0  # N/m, N s/m, as in the time integration
PLACES = (*BEARINGS, "disc")
RADIUS = RIM[2]
BASES = {FREE: (4, 8, 12, 20, 40), CRAIG_BAMPTON: (8, 10, 12, 20, 40, 60)}
QUICK_BASES = {FREE: (4, 12), CRAIG_BAMPTON: (8, 10, 12, 20)}

_FINE = 40  # modes of the reference


def supports(solid: SolidRotor) -> list[Support]:
    """Return the bearings of the scene in the axes of the linear analyses."""
    turn = axes_of(solid.axis)
    stiffness = turn.T @ np.diag(STIFFNESS) @ turn
    return [Support(name, stiffness, DAMPING * np.eye(3)) for name in BEARINGS]


def with_disc(rotor: Rotor) -> SolidRotor:
    """Return the solid rotor with its disc as one more interface, to be looked at."""
    return rotor.solid.with_interface("disc", *rotor.disc)


def response(
    target: SolidRotor | ReducedRotor, solid: SolidRotor, level: str = "tilt", **options
) -> UnbalanceResponse:
    """Return the steady motion of bearings and disc at the speed of the scene."""
    return unbalance_response(
        target, [START_SPEED], supports=supports(solid), at=PLACES, stiffening=level, **options
    )


def difference(motion: UnbalanceResponse, reference: UnbalanceResponse) -> float:
    """Return the largest distance of two steady motions, relative to the reference.

    As :func:`trade_error.errors` does: journals over their own size; the disc's middle, and its
    rim along the axis, over the disc's.
    """
    size = _lengths(_harmonics(reference))
    other, own = _harmonics(reference), _harmonics(motion)
    zero = np.zeros((len(PLACES), 6))
    apart = {n: own.get(n, zero) - other.get(n, zero) for n in own.keys() | other.keys()}
    across, tilt = _lengths(apart)
    journal, disc = across[:2].max() / size[0][:2].max(), across[2] / size[0][2]
    return float(max(journal, disc, RADIUS * tilt[2] / size[0][2]))


def _harmonics(found: UnbalanceResponse) -> dict[int, np.ndarray]:
    """Return amplitudes (p, 6) by order."""
    return {int(n): found.motion[0, :, i] for i, n in enumerate(found.orders)}


def _lengths(harmonics: dict[int, np.ndarray]) -> tuple[np.ndarray, np.ndarray]:
    """Return bounds of the displacement and the rotation across the axis, each (p,)."""
    amplitudes = list(harmonics.values())
    return tuple(sum(np.linalg.norm(a[:, i : i + 2], axis=1) for a in amplitudes) for i in (0, 3))


def reduction_errors(rotor: Rotor, quick: bool = False) -> list[Row]:
    """Return one row per kind and number of modes, and per level of stiffening.

    The reference has many Craig–Bampton modes on the same mesh and the stiffening 'tilt', as the 3D
    body has it. The last rows say how far other levels are from that, with these modes too.
    """
    solid = with_disc(rotor)
    fine = rotor.columns(CRAIG_BAMPTON, _FINE)
    reference = response(solid.reduce(fine), solid, accuracy=None)
    rows = []
    bases = QUICK_BASES if quick else BASES
    cases = [(basis, count) for basis, counts in bases.items() for count in counts]
    for basis, count in tqdm(cases, desc="modes", unit="basis"):
        reduced = solid.reduce(rotor.columns(basis, count))
        error = difference(response(reduced, solid), reference)
        rows.append({"basis": basis, "modes": count, "stiffening": "tilt", "error": error})
    others = {"none": solid.reduce(fine)}
    if not quick:
        others["full"] = solid.reduce(fine, prestress=True)
    for level, target in others.items():
        error = difference(response(target, solid, level, accuracy=None), reference)
        rows.append({"basis": "Craig–Bampton", "modes": _FINE, "stiffening": level, "error": error})
    return rows


def mesh_errors(meshes: Iterable[tuple[int, float]], finest: float) -> list[Row]:
    """Return one row per mesh: frequency and response errors against the finest mesh.

    Parameters
    ----------
    meshes : iterable of (int, float)
        Order of the elements and largest element size [m].
    finest : float
        Element size of the reference, second order [m].
    """
    cases = [(2, finest), *meshes]
    found = [_on_mesh(*case) for case in tqdm(cases, desc="meshes", unit="mesh")]
    _, _, frequency, reference = found[0]
    return [
        {
            "order": order,
            "element_size": size,
            "nodes": nodes,
            "eccentricity": eccentricity,
            "frequency": abs(own / frequency - 1.0),
            "response": difference(motion, reference),
        }
        for (order, size), (nodes, eccentricity, own, motion) in zip(
            cases[1:], found[1:], strict=True
        )
    ]


def _on_mesh(order: int, size: float) -> tuple[int, float, float, UnbalanceResponse]:
    """Return nodes, the mesh's own eccentricity [m], first frequency [rad/s] and response."""
    rotor = Rotor.of(size, order, unbalance=0.0)
    solid = with_disc(rotor)
    reduced = solid.reduce(rotor.columns(CRAIG_BAMPTON, 20))
    load = Unbalance("disc", UNBALANCE * RADIUS)
    motion = response(reduced, solid, unbalances=[load], own=False)
    first = float(reduced.frequencies[len(reduced.rigid)])
    return solid.node_count, float(np.linalg.norm(solid.center_of_mass[1:])), first, motion
