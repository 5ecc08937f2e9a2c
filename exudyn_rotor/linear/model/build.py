"""The linear model of a rotor on supports, of several rotors, or of a scene."""

from __future__ import annotations

import warnings
from collections.abc import Sequence

import exudyn
import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.bearings.given import Given, check_interfaces, given_supports
from exudyn_rotor.calls import user_level
from exudyn_rotor.foundations.foundation import Foundation
from exudyn_rotor.linear.model.assembly import rotors_of
from exudyn_rotor.linear.model.body import EVEN
from exudyn_rotor.linear.model.linear_model import AXES, ON_FOUNDATION, LinearModel
from exudyn_rotor.linear.model.rotor_train import RotorTrain
from exudyn_rotor.linear.model.scene.linear_scene import LinearScene
from exudyn_rotor.linear.model.scene.scene_model import SceneModel
from exudyn_rotor.linear.model.scene.scene_train import scene_train
from exudyn_rotor.multibody.full.full_body import reduced_body
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.prestress.carrying import with_chosen_prestress
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.reduction.selection import without_spin
from exudyn_rotor.solid.places import leeway
from exudyn_rotor.solid.rotor import LOSS_LEFT_OUT
from exudyn_rotor.solid_rotor import SolidRotor
from exudyn_rotor.theory.stiffening import CHOICES, warn_of_left_out

Target = LinearModel | ReducedRotor | SolidRotor | RotorTrain | exudyn.MainSystem
# a SolidRotor up to this many degrees of freedom is taken with all of its modes, a larger one with
# as many flexible modes as the second number says
_ALL_MODES, _MODES = 90, 20
_MESH = 0.05  # unevenness up to which a coarse mesh may be its cause


def linear_model(
    target: Target,
    *,
    supports: Sequence[Given] | Given = (),
    foundation: Foundation | None = None,
    body: RotorBody | Sequence[RotorBody] | None = None,
    stiffening: str = "auto",
    axes: str = "auto",
) -> LinearModel:
    """Return the linear equations of a rotor on supports, or of a scene with a rotor in it.

    A scene is linearised about its equilibrium under the loads that it has at each speed, with
    bearings under their forces there.

    Every linear analysis takes the model instead of the rotor and its supports, and makes it by
    this function where it is given those.

    Parameters
    ----------
    target : ReducedRotor, SolidRotor, RotorTrain, exudyn.MainSystem or LinearModel
        A linear model is returned as it is. A SolidRotor is reduced first: to all of its modes up
        to 90 degrees of freedom, to 20 flexible modes else.
    supports : sequence of Support or bearings, optional
        Of a rotor; a scene has its own connectors.
    foundation : Foundation, optional
        What carries all supports of a rotor, by points of their names; the ground by default.
    body : RotorBody or sequence of RotorBody, optional
        The rotor in a scene, from :func:`exudyn_rotor.add_rotor`; several make a
        :class:`RotorTrain` of all rotors of the scene, with ratios of the speeds at which they
        start.
    stiffening : {'auto', 'none', 'tilt', 'full'}
        Centrifugal stiffening of a rotor; a scene has that of its body. 'full' needs a rotor with
        prestress (:meth:`SolidRotor.prestress`); 'auto' is 'full' with one, which it computes for
        a SolidRotor with elements, and 'tilt' without.
    axes : {'auto', 'inertial', 'rotor'}
        Axes of the equations: by default axes that stand still for a round rotor, and the axes of
        the rotor for an uneven one; :attr:`LinearModel.axes` says which were taken.

    Returns
    -------
    LinearModel

    Raises
    ------
    TypeError
        If the target, the body or a support is of another kind.
    ValueError
        For an unknown interface or level of stiffening, or supports given with a scene or a model.

    Examples
    --------
    >>> import numpy as np
    >>> from exudyn_rotor import Support, campbell, linear_model, rotor_example, stability
    >>> rotor = rotor_example()  # two masses of 2 kg on a rod
    >>> supports = [Support(name, 2e4 * np.eye(3), 10.0 * np.eye(3)) for name in ("left", "right")]
    >>> model = linear_model(rotor, supports=supports)
    >>> campbell(model, [0.0, 50.0]).frequencies_inertial[1, :5].round(2)
    array([99.97, 99.97, 99.97, 99.97, 99.97])
    >>> stability(model, [0.0, 50.0]).stable.tolist()
    [True, True]
    """
    given = given_supports(supports)
    checks.choice(stiffening, "stiffening", CHOICES)
    checks.choice(axes, "axes", AXES)
    if foundation is not None:
        checks.instance(foundation, "foundation", Foundation)
    is_alone = not isinstance(target, LinearModel | RotorTrain | exudyn.MainSystem)
    if (given or foundation is not None) and not is_alone:
        raise ValueError(
            "supports, foundation: are for a rotor; a scene, a RotorTrain and a linear model have "
            "their own; leave them out"
        )
    if isinstance(target, exudyn.MainSystem):
        return _of_scene(target, body, axes)
    if body is not None:
        raise TypeError(
            "body: is only for an exudyn.MainSystem, not for the rotor itself; got "
            f"{checks.shown(body)}"
        )
    if isinstance(target, LinearModel):
        return target
    if isinstance(target, RotorTrain):
        return _of_train(target, stiffening, axes)
    if not isinstance(target, ReducedRotor | SolidRotor):
        raise TypeError(
            "target: needs a ReducedRotor, a SolidRotor, a linear model, a RotorTrain, or an "
            f"exudyn.MainSystem with body=…, got {checks.shown(target)}"
        )
    check_interfaces(given, target.interfaces)
    rotor = _reduced(target, stiffening) if isinstance(target, SolidRotor) else target
    if foundation is not None:
        _check_foundation(foundation, rotor, [one.interface for one in given])
    return LinearModel({"": rotor}, {"": 1.0}, {"": given}, (), foundation, stiffening, axes)


def _check_foundation(
    foundation: Foundation, rotor: ReducedRotor, interfaces: Sequence[str]
) -> None:
    for name in interfaces:
        interface = rotor.interfaces[name]
        place = rotor.axis.project(interface.reference)
        foundation.motion(name, place, leeway(interface.radius, rotor.axis.direction))
    for name in foundation.points:
        if ON_FOUNDATION.format(name) in rotor.interfaces:
            raise ValueError(
                f"foundation: {ON_FOUNDATION.format(name)!r} is an interface of the rotor; "
                "rename it"
            )


def _reduced(rotor: SolidRotor, stiffening: str) -> ReducedRotor:
    """Return a solid rotor in all of its modes if these are few."""
    if stiffening == "auto":
        rotor = with_chosen_prestress(rotor, None)
    free = 3 * rotor.node_count
    return rotor.reduce(_MODES if free > _ALL_MODES else np.eye(free))


def _of_train(train: RotorTrain, stiffening: str, axes: str) -> LinearModel:
    rotors = {
        name: without_spin(rotor) if name in train.driven else rotor
        for name, rotor in train.rotors.items()
    }
    return LinearModel(
        rotors, train.ratios, train.supports, train.links, None, stiffening, axes,
        max(train.largest_unevenness, EVEN),
    )  # fmt: skip


def _of_scene(
    mbs: exudyn.MainSystem,
    body: RotorBody | Sequence[RotorBody] | None,
    axes: str,
) -> LinearModel:
    if isinstance(body, list | tuple):
        return _of_train(*scene_train(mbs, body), axes)
    how = "the rotor in the scene, which add_rotor returned; a list of several"
    return SceneModel.of(LinearScene.of(mbs, reduced_body(body, how=how)), axes)


def warn_of_omissions(model: LinearModel, speed: float = 0.0, what: str = "") -> None:
    """Warn of structural damping, which the analysis `what` leaves out, and of left-out stiffening.

    The level 'tilt', taken by default, may err much at a speed [rad/s].
    """
    if what and model.has_structural_damping:
        warnings.warn(LOSS_LEFT_OUT.format(what), UserWarning, stacklevel=user_level())
    _warn_of_mesh(model)
    if model.stiffening_asked == "auto":
        for rotor in model.rotors.values():
            warn_of_left_out(rotor.invariants, speed, user_level() + 1)


def _warn_of_mesh(model: LinearModel) -> None:
    """Warn of axes that turn with a rotor that a finer mesh may show to be round."""
    halves = any(body.alone.has_halves for body in rotors_of(model.bodies))  # `reduce` tells
    is_taken = model.wanted_axes == "auto" and model.turns and not halves
    if is_taken and model.largest_unevenness < model.unevenness <= _MESH:
        warnings.warn(
            f"the rotor counts as uneven: {model.unevenness:.1%} of it differs around its axis; "
            "where that is its mesh, make it finer, or average it by axes='inertial'; where it is "
            "meant, give axes='rotor'",
            UserWarning,
            stacklevel=user_level(),
        )
