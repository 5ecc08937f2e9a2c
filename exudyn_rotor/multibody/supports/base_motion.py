"""Motions of the ground in scenes, as loads in axes that move with it.

Everything that has mass feels ``−m a``; the scene's coordinates are then motions against the
ground, and its supports and constraints stand still.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import exudyn
import numpy as np
import scipy.sparse as sp
from exudyn.itemInterface import (
    LoadMassProportional,
    MarkerBodyMass,
    ObjectGenericODE2,
    VObjectGenericODE2,
)
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.foundations.record import BaseRecord
from exudyn_rotor.multibody.full.full_body import FullRotorBody
from exudyn_rotor.multibody.full.ties import container, no_jacobian
from exudyn_rotor.multibody.rotor.plan import main_system
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.multibody.rotor.rotor_items import RotorItems
from exudyn_rotor.multibody.supports.foundation_body import SceneFoundation

Moved = RotorBody | FullRotorBody | SceneFoundation | exudyn.ObjectIndex


def add_base_motion(
    mbs: exudyn.MainSystem,
    record: BaseRecord,
    bodies: Sequence[Moved] | Moved,
    *,
    rotation: ArrayLike | None = None,
) -> tuple[exudyn.LoadIndex | exudyn.ObjectIndex, ...]:
    """Shake the ground under a scene: motions become those relative to it.

    Every body with mass must be named: rotors, foundations and Exudyn's own. The ground starts at
    rest with the record, and moves on at constant velocity after it. A step calls one Python
    function for each body.

    Parameters
    ----------
    mbs : exudyn.MainSystem
    record : BaseRecord
    bodies : sequence of RotorBody, FullRotorBody, SceneFoundation or ObjectIndex
        Everything that has mass.
    rotation : array_like, shape (3, 3), optional
        That of the rotor in :func:`add_rotor`, whose mesh axes are those of the record.

    Returns
    -------
    tuple of LoadIndex or ObjectIndex
        The load on each body; for a rotor whose equations hold its weight an object of forces
        beside them: a full body, one without a marker body, or with a free spin and no translation.

    Raises
    ------
    TypeError, ValueError
        For bad input, a body given twice, a foundation without participation, and Exudyn's
        ``ObjectFFRF``, which has no loads by its mass. Nothing has been added then.

    Examples
    --------
    >>> import exudyn
    >>> import numpy as np
    >>> from exudyn_rotor import BaseRecord, Foundation, Mount, add_base_motion, add_foundation
    >>> block = Foundation.rigid(50.0, [4.0, 5.0, 1.0], [0.0, -0.2, 0.0],
    ...     [Mount([x, -0.3, z], 1e6) for x in (-0.2, 0.2) for z in (-0.4, 0.4)],
    ...     {"left": [0.0, 0.0, -0.3], "right": [0.0, 0.0, 0.3]})
    >>> mbs = exudyn.SystemContainer().AddSystem()
    >>> base = add_foundation(mbs, block)
    >>> step = BaseRecord([0.0, 1.0], [[2.0, 0.0, 0.0], [2.0, 0.0, 0.0]])
    >>> loads = add_base_motion(mbs, step, base)
    """
    main_system(mbs)
    checks.instance(record, "record", BaseRecord)
    turned = record if rotation is None else record.turned(rotation)
    kinds = (RotorBody, FullRotorBody, SceneFoundation, exudyn.ObjectIndex)
    given = checks.instances(bodies, "bodies", kinds)
    numbers = [_number(mbs, body) for body in given]
    if len(set(map(int, numbers))) < len(numbers):
        raise ValueError("bodies: one is given twice, and would feel the ground twice")
    load, added = _load(turned), []
    for body, number in zip(given, numbers, strict=True):
        if _has_own_weight(body):
            added.append(_add_forces(body, load))
            continue
        marker = mbs.AddMarker(MarkerBodyMass(bodyNumber=number))
        item = LoadMassProportional(markerNumber=marker, loadVectorUserFunction=load)
        added.append(mbs.AddLoad(item))
    return tuple(added)


def _number(mbs: exudyn.MainSystem, body: Moved) -> exudyn.ObjectIndex:
    """Return the object whose mass is loaded."""
    if isinstance(body, exudyn.ObjectIndex):
        if not 0 <= int(body) < mbs.systemData.NumberOfObjects():
            raise ValueError(f"bodies: this system has no {body}")
        if mbs.GetObject(body)["objectType"] == "FFRF":
            raise ValueError(
                f"bodies: {body} is an ObjectFFRF, whose loads by its mass read memory that "
                "Exudyn does not set; use an ObjectFFRFreducedOrder, or add_rotor"
            )
        return body
    if body.mbs is not mbs:
        raise ValueError("bodies: one is in another mbs")
    if isinstance(body, SceneFoundation) and body.foundation.participation is None:
        raise ValueError("bodies: the foundation needs its participation=…")
    return body.objects["physics" if _has_own_weight(body) else "marker_body"]


def _has_own_weight(body: Moved) -> bool:
    """Return whether a rotor's weight is part of its equations, or hangs on the ties of a mesh."""
    if not isinstance(body, RotorItems):
        return False
    form = body.formulation
    free_about_a_point = form.has_spin and form.translation_count == 0
    return isinstance(body, FullRotorBody) or free_about_a_point


def _add_forces(body: RotorItems, load: Callable) -> exudyn.ObjectIndex:
    """Add an object of forces, without inertia or stiffness, on the nodes of a rotor."""
    motion, layout = body.motion, body.layout
    empty = container(sp.csr_array((layout.size, layout.size)))
    held = [place for place in body.locks.fixed if place < 3]

    def forces(mbs, t, item, q, q_t):
        total, acceleration = np.zeros(layout.size), load(mbs, t, None)
        unknown = np.asarray(q)[layout.unknowns]
        total[layout.unknowns] = motion.body_forces(t, unknown, acceleration)
        total[held] = motion.invariants.mass * np.asarray(acceleration)[held]
        return total.tolist()

    return body.mbs.AddObject(
        ObjectGenericODE2(
            nodeNumbers=body.mbs.GetObject(body.objects["physics"])["nodeNumbers"],
            massMatrix=empty,
            dampingMatrix=empty,
            stiffnessMatrix=empty,
            forceUserFunction=forces,
            jacobianUserFunction=no_jacobian(layout.size),
            visualization=VObjectGenericODE2(show=False),
        )
    )


def _load(record: BaseRecord) -> Callable:
    start, step, rows = record.times[0], record.step, (-record.accelerations).tolist()
    last = len(rows) - 1

    def load(mbs, t, vector):  # called for every body at every step: numbers are faster than arrays
        place = (t - start) / step
        if not 0.0 <= place <= last:
            return [0.0, 0.0, 0.0]
        index = min(int(place), last - 1)
        share, before, after = place - index, rows[index], rows[index + 1]
        return [a + share * (b - a) for a, b in zip(before, after, strict=True)]

    return load
