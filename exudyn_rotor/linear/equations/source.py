"""What a linear analysis is asked for, as linear equations at any spin speed."""

from __future__ import annotations

from collections.abc import Sequence
from typing import TYPE_CHECKING

import exudyn

from exudyn_rotor import checks
from exudyn_rotor.linear.equations.dense import as_reduced
from exudyn_rotor.linear.equations.full import FullRotor
from exudyn_rotor.linear.equations.spin import spin_of
from exudyn_rotor.linear.equations.supports import Support
from exudyn_rotor.linear.equations.system import LinearRotor
from exudyn_rotor.multibody.rotor_body import RotorBody
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.solid_rotor import SolidRotor
from exudyn_rotor.theory.stiffening import LEVELS

if TYPE_CHECKING:
    from exudyn_rotor.linear.equations.scene import LinearScene

# full models up to this size are solved with dense matrices
DENSE_SIZE = 600


def linear_source(
    target: ReducedRotor | SolidRotor | LinearRotor | exudyn.MainSystem,
    *,
    body: RotorBody | None = None,
    supports: Sequence[Support] = (),
    stiffening: str = "tilt",
    dense: bool = True,
) -> LinearRotor | FullRotor | LinearScene:
    """Return the linear equations of a rotor on supports, or of a scene with a rotor in it.

    Parameters
    ----------
    target : ReducedRotor, SolidRotor, LinearRotor or exudyn.MainSystem
        A LinearRotor is taken as it is.
    body : RotorBody, optional
        The rotor of a scene; only with a MainSystem.
    supports : sequence of Support, optional
        Only with a rotor; a scene has its own connectors.
    stiffening : {'tilt', 'none', 'full'}
        Centrifugal stiffening; a scene has that of its body. 'full' needs a rotor with prestress.
    dense : bool, optional
        Whether a small SolidRotor (up to 600 degrees of freedom) gives dense equations.

    Raises
    ------
    TypeError
        If the target, the body or a support is of another kind.
    ValueError
        For an unknown interface or level of stiffening, or supports given with a scene.
    """
    supports = checked_supports(supports)
    checks.choice(stiffening, "stiffening", LEVELS)
    if isinstance(target, LinearRotor):
        if supports or body is not None:
            raise ValueError("a LinearRotor has its supports already; leave supports and body out")
        return target
    if isinstance(target, exudyn.MainSystem):
        return _scene(target, body, supports)
    if body is not None:
        raise TypeError(
            "body: is only for an exudyn.MainSystem, the rotor itself was given; got "
            f"{checks.shown(body)}"
        )
    if isinstance(target, ReducedRotor):
        return LinearRotor.of(target, supports, stiffening)
    if isinstance(target, SolidRotor):
        if dense and 3 * target.node_count <= DENSE_SIZE:
            return LinearRotor.of(as_reduced(target), supports, stiffening, spin_of(target))
        return FullRotor.of(target, supports, stiffening).with_spin()
    raise TypeError(
        "target: needs a ReducedRotor, a SolidRotor, or an exudyn.MainSystem with body=…, got "
        f"{checks.shown(target)}"
    )


def checked_supports(supports: Sequence[Support] | Support) -> tuple[Support, ...]:
    """Return supports as a tuple; TypeError for anything else."""
    return checks.instances(supports, "supports", Support)


def _scene(
    mbs: exudyn.MainSystem, body: RotorBody | None, supports: tuple[Support, ...]
) -> LinearScene:
    from exudyn_rotor.linear.equations.scene import LinearScene

    if not isinstance(body, RotorBody):
        raise TypeError(
            f"body: a scene needs its RotorBody, which add_rotor returned, got {checks.shown(body)}"
        )
    if supports:
        raise ValueError("supports=: are for a rotor; a scene has its own connectors")
    return LinearScene.of(mbs, body)
