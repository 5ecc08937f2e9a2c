"""Supports and bearings as they are given to scenes and linear analyses."""

from __future__ import annotations

from collections.abc import Iterable, Mapping, Sequence

from exudyn_rotor import checks
from exudyn_rotor.bearings.bearing import Bearing
from exudyn_rotor.bearings.support import Support, acts
from exudyn_rotor.reduction.fields import ReducedInterface
from exudyn_rotor.solid.interface import Interface

Given = Support | Bearing
_TILTING = ("tilt_stiffness", "tilt_damping")


def given_supports(supports: Sequence[Given] | Given) -> tuple[Given, ...]:
    """Return supports and bearings as a tuple; TypeError for anything else."""
    return checks.instances(supports, "supports", (Support, Bearing))


def checked_supports(supports: Sequence[Given] | Given) -> tuple[Support, ...]:
    """Return supports for linear analyses as a tuple, bearings linearised under their loads.

    Raises
    ------
    TypeError, ValueError
        For anything else, and a bearing without a load.
    """
    return tuple(
        given.linearised() if isinstance(given, Bearing) else given
        for given in given_supports(supports)
    )


def check_interfaces(
    supports: Iterable[Given], known: Mapping[str, Interface | ReducedInterface]
) -> None:
    """Refuse a support at an interface that the rotor does not have, or that cannot tilt.

    Raises
    ------
    ValueError
    """
    for support in supports:
        if support.interface not in known:
            raise ValueError(
                f"support at {support.interface!r}: no such interface; the rotor has: "
                f"{', '.join(known) or 'none'}"
            )
        for name in _TILTING if known[support.interface].radius == 0.0 else ():
            if acts(getattr(support, name, 0.0)):
                raise ValueError(
                    f"support at {support.interface!r}: {name} would act on nothing, since the "
                    "interface is a single node, which has no rotation; make the interface of "
                    "three nodes or more, or leave this out"
                )
