"""The linear model of a rotor on supports, or of a scene with a rotor in it."""

from __future__ import annotations

import warnings
from collections.abc import Sequence

import exudyn

from exudyn_rotor import checks
from exudyn_rotor.bearings.controlled_support import Controlled
from exudyn_rotor.bearings.given import linear_supports
from exudyn_rotor.bearings.support import Support
from exudyn_rotor.callers import user_level
from exudyn_rotor.foundations.foundation import Foundation
from exudyn_rotor.linear.models.full.full_rotor import FullRotor
from exudyn_rotor.linear.models.protocol import LinearModel
from exudyn_rotor.linear.models.rotor.controlled_rotor import ControlledRotor
from exudyn_rotor.linear.models.rotor.extended_rotor import ExtendedRotor
from exudyn_rotor.linear.models.rotor.rotor_on_foundation import RotorOnFoundation
from exudyn_rotor.linear.models.rotor.rotor_on_supports import LinearRotor
from exudyn_rotor.linear.models.scene.linear_scene import ABOUT, LinearScene
from exudyn_rotor.linear.models.scene.remembering_scene import RememberingScene
from exudyn_rotor.linear.models.trains.linear_train import LinearTrain
from exudyn_rotor.linear.models.trains.rotor_train import RotorTrain
from exudyn_rotor.linear.models.trains.scene_train import scene_train
from exudyn_rotor.multibody.full.full_body import reduced_body
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.prestress.carrying import with_chosen_prestress
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.solid.damping import LOSS_LEFT_OUT
from exudyn_rotor.solid_rotor import SolidRotor
from exudyn_rotor.theory.stiffening import CHOICES, warn_of_left_out

# full models up to this size are solved with dense matrices
DENSE_SIZE = 600

Target = LinearModel | ReducedRotor | SolidRotor | RotorTrain | exudyn.MainSystem
MODELS = (
    LinearRotor,
    FullRotor,
    LinearScene,
    RememberingScene,
    LinearTrain,
    RotorOnFoundation,
    ControlledRotor,
)


def linear_model(
    target: Target,
    *,
    supports: Sequence[Support] | Support = (),
    foundation: Foundation | None = None,
    body: RotorBody | Sequence[RotorBody] | None = None,
    stiffening: str = "auto",
    about: str = "steady",
    dense: bool | None = None,
) -> LinearModel:
    """Return the linear equations of a rotor on supports, or of a scene with a rotor in it.

    Every linear analysis takes the model instead of the rotor and its supports, and makes it by
    this function where it is given those.

    Parameters
    ----------
    target : ReducedRotor, SolidRotor, RotorTrain, exudyn.MainSystem or linear model
        A linear model is returned as it is.
    supports : sequence of Support, optional
        Of a rotor; a scene has its own connectors.
    foundation : Foundation, optional
        What carries all supports of a rotor, by points of their names; the ground by default. The
        rotor is a reduced one, or a SolidRotor of up to 600 degrees of freedom.
    body : RotorBody or sequence of these, optional
        The rotor in a scene, from :func:`exudyn_rotor.add_rotor`. Several make a
        :class:`RotorTrain`: all rotors of a scene that has nothing beside them but what
        :func:`exudyn_rotor.add_supports` put on the ground or between them, gears and flexible
        couplings. Ratios are those of the speeds at which they start, and Ω is the speed of the
        first.
    stiffening : {'auto', 'none', 'tilt', 'full'}
        Centrifugal stiffening of a rotor; a scene has that of its body. 'full' needs a rotor with
        prestress (:meth:`SolidRotor.prestress`); 'auto' is 'full' with one, which it computes for
        a SolidRotor with elements, and 'tilt' without.
    about : {'steady', 'equilibrium', 'given'}
        Motion about which a scene is linearised: the periodic motion under its loads and the
        rotor's own unbalance at each speed; that without this unbalance, films at rest under their
        mean force, as in a list of supports; or its current state with the rotor undeformed and
        journals where the weight by the lever rule, or their bearings' own load, holds them.
    dense : bool, optional
        Whether a SolidRotor is solved in all its coordinates by dense matrices, or for its lowest
        modes; by default dense up to 600 degrees of freedom.

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
    >>> from exudyn_rotor import SolidRotor, Support, campbell, linear_model, stability
    >>> rod = 1e8 * np.kron([[1, -1], [-1, 1]], np.diag([0.0, 0.0, 1.0]))
    >>> nodes = [[0.0, 0.0, -0.1], [0.0, 0.0, 0.1]]  # two masses of 2 kg on a rod
    >>> rotor = SolidRotor.from_matrices(2.0 * np.eye(6), rod, nodes, "z")
    >>> rotor = rotor.with_interface("left", [0]).with_interface("right", [1])
    >>> supports = [Support(name, 2e4 * np.eye(3), 10.0 * np.eye(3)) for name in ("left", "right")]
    >>> model = linear_model(rotor, supports=supports)
    >>> campbell(model, [0.0, 50.0]).frequencies_inertial[1, :5].round(2)
    array([99.97, 99.97, 99.97, 99.97, 99.97])
    >>> stability(model, [0.0, 50.0]).stable.tolist()
    [True, True]
    """
    linear, controlled = linear_supports(supports)
    checks.choice(stiffening, "stiffening", CHOICES)
    checks.choice(about, "about", ABOUT)
    if dense is not None:
        checks.flag(dense, "dense")
    _check_foundation(target, foundation)
    if linear or controlled:
        _check_takes_supports(target)
    if isinstance(target, exudyn.MainSystem):
        return _of_scene(target, body, about)
    if body is not None:
        raise TypeError(
            "body: is only for an exudyn.MainSystem, not for the rotor itself; got "
            f"{checks.shown(body)}"
        )
    if isinstance(target, RotorTrain):
        return LinearTrain.of(target, stiffening)
    if isinstance(target, MODELS):
        return target
    if not isinstance(target, ReducedRotor | SolidRotor):
        raise TypeError(
            "target: needs a ReducedRotor, a SolidRotor, a linear model, a RotorTrain, or an "
            f"exudyn.MainSystem with body=…, got {checks.shown(target)}"
        )
    if isinstance(target, SolidRotor):
        if stiffening == "auto":
            target = with_chosen_prestress(target, None)
        small = 3 * target.node_count <= DENSE_SIZE
        if not (small if dense is None else dense):
            _check_for_full_rotor(target, foundation, controlled)
            return FullRotor.of(target, linear, stiffening).with_spin()
    if controlled:
        return ControlledRotor.of(target, linear, controlled, stiffening, foundation)
    made = LinearRotor.of if isinstance(target, ReducedRotor) else LinearRotor.of_solid
    model = made(target, linear, stiffening)
    return model if foundation is None else RotorOnFoundation.of(model, foundation)


def _check_foundation(target: Target, foundation: Foundation | None) -> None:
    if foundation is None:
        return
    checks.instance(foundation, "foundation", Foundation)
    if not isinstance(target, ReducedRotor | SolidRotor):
        raise ValueError(
            "foundation: is for a rotor; a linear model has its own, and to a scene "
            "add_foundation adds one"
        )


def _check_takes_supports(target: Target) -> None:
    """Refuse supports beside a target that has its own."""
    if isinstance(target, exudyn.MainSystem):
        raise ValueError("supports: are for a rotor; a scene has its own connectors")
    if isinstance(target, RotorTrain):
        raise ValueError("supports: a RotorTrain has its own; leave them out")
    if isinstance(target, MODELS):
        raise ValueError("supports: a linear model has its own; leave them out")


def _check_for_full_rotor(
    rotor: SolidRotor, foundation: Foundation | None, controlled: Sequence[Controlled]
) -> None:
    """Refuse what a rotor solved for its lowest modes cannot stand on."""
    if foundation is not None or controlled:
        raise ValueError(
            f"target: a SolidRotor of {3 * rotor.node_count} degrees of freedom on a foundation "
            "or magnetic bearings: give the reduced rotor, rotor.reduce(…), whose error the "
            "analyses estimate, or linear_model(rotor, …, dense=True), which takes all nodes"
        )


def _of_scene(
    mbs: exudyn.MainSystem, body: RotorBody | Sequence[RotorBody] | None, about: str
) -> LinearModel:
    if isinstance(body, list | tuple):
        return LinearTrain.of(*scene_train(mbs, body))
    how = "the rotor in the scene, which add_rotor returned; a list of several"
    return RememberingScene.of(LinearScene.of(mbs, reduced_body(body, how=how), about=about))


def warn_of_structural_damping(model: LinearModel, what: str) -> None:
    """Warn that an analysis, named by `what`, leaves structural damping out."""
    if model.has_structural_damping:
        warnings.warn(LOSS_LEFT_OUT.format(what), UserWarning, stacklevel=user_level())


def warn_of_left_out_stiffening(model: LinearModel, speed: float) -> None:
    """Warn where the level 'tilt', taken by default, errs much at a speed [rad/s]."""
    if isinstance(model, LinearRotor | ExtendedRotor):
        warn_of_left_out(model.invariants, speed, user_level() + 1)
