"""What the modes of a run leave out at the nodes: the residual of the full model, taken statically.

In all nodal displacements the recorded motion ``c = Ψζ`` leaves in (105) and (109) the forces

    r = f − M c̈ − (D + 2ωG) ċ − (K − ω²Ĉ + ω⁴K4 + ω̇W) c + ω²h − ω̇g,

f being the loads where something acts on the rotor, as the equations of motion tell them
(:mod:`exudyn_rotor.advice.residual`), and the weight. What works on the mass-orthonormal columns Q
of the rotor, rounding and other loads, is taken out with the inertia forces: ``r − M Q Qᵀ r``. What
the modes leave out is ``v = K⁺ r``, by inertia relief: the first correction, exact for loads that
are slow beside the modes that are left out. Damping delays the part of it that grows with ω², the
static stretch s by the spin, so that ``−2ωω̇ D s`` is added to r: ``K v + D v̇ = r`` to first order,
which of what turns with ω changes the phase alone. The inertia of the modes that are left out, and
what v changes of the supports' forces and of the motion in the modes, do not count here: next to a
resonance, and after a sudden start or shock, that is more than v.
"""

from __future__ import annotations

from dataclasses import dataclass, replace

import numpy as np
import scipy.sparse as sp

from exudyn_rotor.advice.residual import place_loads, recorded_states
from exudyn_rotor.advice.run_loads import instants, turned, weight
from exudyn_rotor.multibody.full.full_plan import make_full_plan
from exudyn_rotor.multibody.rotor.record import Record
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.prestress.carrying import with_chosen_prestress
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.solid.tensor import von_mises
from exudyn_rotor.solid_rotor import SolidRotor
from exudyn_rotor.solvers.inertia_relief import inertia_relief
from exudyn_rotor.strength.field import StressField

_MOST = 60  # instants
_SAME = 1e-6  # relative difference of masses and places of one rotor
_TOLERANCE = 1e-8  # what iteration may leave of a load


@dataclass(frozen=True, eq=False)
class LeftOut:
    """What the modes leave out at nodes, at instants of a run.

    Attributes
    ----------
    displacement : ndarray, shape (s, n)
        Length of what is left out [m].
    moved : ndarray, shape (s, n)
        Length of the displacement with what was left out, and with the frame's translation [m].
    stress : ndarray, shape (s, n), or None
        Von Mises stress of what is left out [Pa]; no larger is the error of the von Mises stress.
        None without the stress of the modes.
    stressed : ndarray, shape (s, n), or None
        Von Mises stress with what was left out [Pa].
    """

    displacement: np.ndarray
    moved: np.ndarray
    stress: np.ndarray | None
    stressed: np.ndarray | None


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


def left_out_at_nodes(
    body: RotorBody,
    record: Record,
    size: float,
    reduced: ReducedRotor,
    solid: SolidRotor,
    nodes: np.ndarray,
) -> LeftOut:
    """Return what the modes of a run leave out at nodes.

    Parameters
    ----------
    body : RotorBody
    record : Record
        Of two instants at least; the first has no accelerations.
    size : float
        Makes forces and moments comparable [m].
    reduced : ReducedRotor
        With shapes; with its stress modes for the stress.
    solid : SolidRotor
        The full model of it.
    nodes : ndarray of int, shape (n,)
    """
    if body.stiffening == "full":
        solid = with_chosen_prestress(solid, None)
    picked = instants(record, _MOST)
    count, speed = len(picked), record.speed[picked]
    loads, zeta, frame = recorded_states(body, record, picked)
    basis = reduced.shapes.matrix @ body.selection.T
    forces, damping = _unbalanced(body, record, picked, solid, basis)
    for place, values in place_loads(body, loads, size):
        columns = place.load_columns(solid)
        if columns is not None:
            forces[:, :count] += columns @ values
    columns, rigid = reduced.shapes.matrix, len(reduced.rigid_kinds)
    forces[:, :count] -= solid.mass @ (columns @ (columns.T @ forces[:, :count]))
    # the static stretch less that of the modes, in their own equilibrium
    share = (columns.T @ forces[:, count:])[rigid:] / reduced.frequencies[rigid:, None] ** 2
    forces[:, count:] -= solid.stiffness @ (columns[:, rigid:] @ share)
    solve = inertia_relief(solid).solve
    stretch = solve(forces[:, count:], _TOLERANCE)
    growth = 2.0 * speed * _spin_accelerations(body, record, picked)
    forces[:, :count] -= np.outer(damping @ stretch[:, 0], growth)
    left = solve(forces[:, :count], _TOLERANCE)
    places = (3 * nodes[:, None] + np.arange(3)).ravel()
    missing = left[places].reshape(-1, 3, count)
    moved = (basis[places] @ zeta).reshape(-1, 3, count) + frame + missing
    stress = stressed = None
    if reduced.shapes.stress is not None and solid.stress_recovery is not None:
        field = StressField.of(reduced, body)
        # it adds the static stress by the spin to that of the modes
        unknown = left - speed**2 * stretch if field.has_static else left
        unseen = np.moveaxis(solid.stress_recovery(unknown)[nodes], 2, 0)
        stress = von_mises(unseen)
        stressed = von_mises(field.history(zeta.T, speed, nodes) + unseen)
    return LeftOut(
        np.linalg.norm(missing, axis=1).T, np.linalg.norm(moved, axis=1).T, stress, stressed
    )


def _unbalanced(
    body: RotorBody, record: Record, picked: np.ndarray, solid: SolidRotor, basis: np.ndarray
) -> tuple[np.ndarray, sp.csr_array]:
    """Return r without M c̈ and loads at interfaces, then ``h`` as a last column, (3n, s + 1).

    And the damping that acts on what the modes leave out.
    """
    # damping in proportion to the mass leaves no force beyond the modes
    setup = replace(
        body.plan.setup, modal_coordinates=None, modal_velocities=None, mass_damping=0.0
    )
    full = make_full_plan(solid, setup).motion
    inv, terms = full.invariants, full.spin_terms
    omega, omega_t = record.speed[picked], _spin_accelerations(body, record, picked)
    q, q_t = (rows[picked][:, body.layout.unknowns].T for rows in (record.q, record.q_t))
    c, rate = (basis @ rows[body.motion.modes] for rows in (q, q_t))
    forces = -(inv.K @ c) - inv.D @ rate - 2.0 * (inv.G @ (omega * rate))
    forces += terms.C_hat @ (omega**2 * c) - terms.W @ (omega_t * c)
    if terms.K4 is not None:
        forces -= terms.K4 @ (omega**4 * c)
    forces += np.outer(terms.h, omega**2) - np.outer(terms.g, omega_t)
    forces += inv.S.T @ _body_force(body, record, picked)
    return np.column_stack([forces, terms.h]), inv.D


def _spin_accelerations(body: RotorBody, record: Record, picked: np.ndarray) -> np.ndarray:
    form = body.formulation
    if form.has_spin:
        return record.q_tt[picked][:, body.layout.unknowns][:, form.translation_count]
    return np.array([float(form.spin.acceleration(t)) for t in record.time[picked]])


def _body_force(body: RotorBody, record: Record, picked: np.ndarray) -> np.ndarray:
    """Return gravity less a prescribed acceleration of the frame, rotor axes [m/s²], (3, s)."""
    motion, form, columns = body.motion, body.formulation, []
    gravity = motion.gravity + weight(body) / motion.invariants.mass
    for index in picked:
        acceleration = gravity
        if form.moves_origin:
            acceleration = gravity - form.translation.acceleration(float(record.time[index]))
        columns.append(turned(body, record.q[index]).T @ acceleration)
    return np.array(columns).T
