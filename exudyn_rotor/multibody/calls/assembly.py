"""What ``mbs.Assemble()`` does for rotors: markers condensed before, connections checked after.

Loads, connectors and markers are all known when a system is assembled, and a script that adds some
later assembles it again. Importing this module lets ``mbs.Assemble()`` condense the markers of the
rotors of this package in the ``mbs``, and warn of what a rotor cannot carry
(:mod:`exudyn_rotor.multibody.rotor.connections`), of each item once.
"""

from __future__ import annotations

import warnings
from collections.abc import Callable
from dataclasses import dataclass, field

import exudyn

from exudyn_rotor.multibody.mark import mark_of
from exudyn_rotor.multibody.rotor.condensed_markers import condense_all
from exudyn_rotor.multibody.rotor.connections import ConnectionWarning, lost_connections
from exudyn_rotor.multibody.rotor.plan import Plan
from exudyn_rotor.multibody.rotor.rotor_items import RotorItems
from exudyn_rotor.multibody.wrapping import wraps_method

_ROTORS = "exudyn_rotor: rotors whose connections are checked"  # key in mbs.sys


@dataclass(frozen=True, eq=False)
class _Known:
    """What makes the items of a rotor again: the ``mbs`` must not hold a body that holds it."""

    plan: Plan
    nodes: dict[str, exudyn.NodeIndex]
    objects: dict[str, exudyn.ObjectIndex]
    constraints: dict[str, exudyn.ObjectIndex]
    told: set[str] = field(default_factory=set)


def check_at_assembly(body: RotorItems) -> None:
    """Let ``mbs.Assemble()`` warn of what a rotor cannot carry."""
    parts = (dict(part) for part in (body.nodes, body.objects, body.constraints))
    body.mbs.sys.setdefault(_ROTORS, {})[body.mark] = _Known(body.plan, *parts)


def _warn(mbs: exudyn.MainSystem) -> None:
    for mark, known in mbs.sys.get(_ROTORS, {}).items():
        if mark is None or mark_of(mbs, known.objects["physics"]) != mark:
            continue
        items = {"objects": known.objects, "constraints": known.constraints}
        for sentence in lost_connections(RotorItems(mbs, known.plan, known.nodes, **items)):
            if sentence not in known.told:
                known.told.add(sentence)
                warnings.warn(
                    f"rotor {known.plan.setup.name!r}: {sentence}", ConnectionWarning, stacklevel=4
                )


@wraps_method("Assemble")
def _assemble(assemble: Callable, mbs: exudyn.MainSystem) -> None:
    """Condense the markers of rotors first, and check their connections afterwards."""
    condense_all(mbs)
    assemble(mbs)
    _warn(mbs)
