"""Supports and bearings as they are given to scenes and linear analyses."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence
from typing import get_args

from exudyn_rotor import checks
from exudyn_rotor.bearings.bearing import Bearing
from exudyn_rotor.bearings.controlled_support import ControlledSupport
from exudyn_rotor.bearings.magnetic import MagneticBearing
from exudyn_rotor.bearings.series import FloatingRingBearing, SeriesSupport
from exudyn_rotor.bearings.support import Support, acts
from exudyn_rotor.reduction.reduced_rotor import ReducedInterface
from exudyn_rotor.solid.rotor import Interface

Given = Support | Bearing | MagneticBearing | SeriesSupport | FloatingRingBearing
Controlled = ControlledSupport | SeriesSupport
_TILTING = ("tilt_stiffness", "tilt_damping")


def given_supports(supports: Sequence[Given] | Given, name: str = "supports") -> tuple[Given, ...]:
    """Return supports and bearings as a tuple; TypeError for anything else."""
    return checks.instances(supports, name, get_args(Given))


def linear_supports(
    supports: Sequence[Given] | Given,
) -> tuple[tuple[Support, ...], tuple[Controlled, ...]]:
    """Return supports for linear analyses, those without and with coordinates of their own."""
    linear: list[Support] = []
    controlled: list[Controlled] = []
    for given in given_supports(supports):
        one = given if isinstance(given, Support) else given.linearised()
        (linear if isinstance(one, Support) else controlled).append(one)
    return tuple(linear), tuple(controlled)


def check_interfaces(
    supports: Iterable[Given | Controlled],
    known: Mapping[str, Interface | ReducedInterface],
) -> None:
    """Refuse a support at an interface that the rotor does not have, or that cannot tilt."""
    for support in supports:
        for place in (support.interface, getattr(support, "sensor", None) or support.interface):
            if place not in known:
                asked = "" if place == support.interface else f" as that of its sensor, {place!r}"
                raise ValueError(
                    f"support at {support.interface!r}: no such interface{asked}; "
                    f"the rotor has: {', '.join(known) or 'none'}"
                )
        turns = known[support.interface].radius > 0.0
        if not turns and isinstance(support, Support) and support.tilts:
            names = (n for n in _TILTING if acts(getattr(support, n)))
            raise ValueError(
                f"support at {support.interface!r}: {next(names, 'a 6 × 6 matrix')} would act on "
                "nothing, since the interface is a single node, which has no rotation; make the "
                "interface of three nodes or more, or leave this out"
            )
