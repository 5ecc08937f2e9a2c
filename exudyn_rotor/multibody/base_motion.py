"""Motions of the ground in scenes, as loads in axes that move with it.

Everything that has mass feels ``−m a``; the scene's coordinates are then motions against the
ground, and its supports and constraints stand still.
"""

from __future__ import annotations

from collections.abc import Callable, Sequence

import exudyn
from exudyn.itemInterface import LoadMassProportional, MarkerBodyMass
from numpy.typing import ArrayLike

from exudyn_rotor import checks
from exudyn_rotor.foundations.record import BaseRecord
from exudyn_rotor.multibody.foundation_body import SceneFoundation
from exudyn_rotor.multibody.full_body import FullRotorBody, reduced_body
from exudyn_rotor.multibody.inputs import main_system
from exudyn_rotor.multibody.rotor_body import RotorBody

Moved = RotorBody | SceneFoundation | exudyn.ObjectIndex


def add_base_motion(
    mbs: exudyn.MainSystem,
    record: BaseRecord,
    bodies: Sequence[Moved] | Moved,
    *,
    rotation: ArrayLike | None = None,
) -> tuple[exudyn.LoadIndex, ...]:
    """Shake the ground under a scene: motions become those relative to it.

    Every body with mass must be named: rotors, foundations and Exudyn's own. The ground starts at
    rest with the record, and moves on at constant velocity after it. A step calls one Python
    function for each body.

    Parameters
    ----------
    mbs : exudyn.MainSystem
    record : BaseRecord
    bodies : sequence of RotorBody, SceneFoundation or ObjectIndex
        Everything that has mass.
    rotation : array_like, shape (3, 3), optional
        That of the rotor in :func:`add_rotor`, whose mesh axes are those of the record.

    Returns
    -------
    tuple of LoadIndex

    Raises
    ------
    TypeError, ValueError
        For bad input, a body given twice, a foundation without participation, and rotors whose
        weight is part of their equations: without a marker body, or with a free spin and no
        translation. Nothing has been added then.

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
    load = _load(turned)
    added = []
    for number in numbers:
        marker = mbs.AddMarker(MarkerBodyMass(bodyNumber=number))
        item = LoadMassProportional(markerNumber=marker, loadVectorUserFunction=load)
        added.append(mbs.AddLoad(item))
    return tuple(added)


def _number(mbs: exudyn.MainSystem, body: Moved | FullRotorBody) -> exudyn.ObjectIndex:
    """Return the object whose mass is loaded."""
    if isinstance(body, exudyn.ObjectIndex):
        if not 0 <= int(body) < mbs.systemData.NumberOfObjects():
            raise ValueError(f"bodies: this system has no {body}")
        return body
    if body.mbs is not mbs:
        raise ValueError("bodies: one is in another mbs")
    if isinstance(body, SceneFoundation):
        if body.foundation.participation is None:
            raise ValueError("bodies: the foundation needs its participation")
        return body.objects["marker_body"]
    form = reduced_body(body, how="reduce the rotor").formulation
    if "marker_body" not in body.objects or (form.has_spin and form.translation_count == 0):
        raise ValueError(
            f"bodies: the weight of rotor {body.name!r} is part of its equations; give it a marker "
            "body, and translation='free' or a prescribed spin"
        )
    return body.objects["marker_body"]


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
