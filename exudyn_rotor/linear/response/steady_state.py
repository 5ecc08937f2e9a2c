"""The steady motion of a scene under its own loads, from which a run can start."""

from __future__ import annotations

import warnings
from dataclasses import dataclass

import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.linear.model.scene.linear_scene import LinearScene
from exudyn_rotor.linear.model.scene.steady_motion import steady_motion
from exudyn_rotor.multibody.full.full_body import reduced_body
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody, StartState
from exudyn_rotor.theory.rotating_axes import axial_rotation

_TOLD = 1e-5  # share of the motion in higher harmonics that a warning tells


@dataclass(frozen=True, eq=False)
class SteadyState:
    """Periodic motion of a scene at a constant spin speed, made by :func:`steady_state`.

    Attributes
    ----------
    scene : LinearScene
        The scene, its unknowns y: the rotor's in axes that turn with it, all others as they are.
    speed : float
        Spin speed Ω [rad/s].
    orders : ndarray of int, shape (h,)
    harmonics : ndarray of complex, shape (h, k)
        ``y = Re Σ y_n exp(inΩt)``.

    Examples
    --------
    >>> import exudyn
    >>> import numpy as np
    >>> from exudyn_rotor import SolidRotor, add_rotor, steady_state
    >>> nodes = [[0.1, 0.0, 0.0], [-0.1, 0.0, 0.0]]
    >>> rotor = SolidRotor.from_matrices(np.eye(6), 1e6 * np.eye(6), nodes, "z")
    >>> mbs = exudyn.SystemContainer().AddSystem()
    >>> body = add_rotor(mbs, rotor.reduce(6), spin=10.0, translation="none")
    >>> mbs.Assemble()
    >>> steady_state(body)
    SteadyState('rotor' at 10 rad/s)
    """

    scene: LinearScene
    speed: float
    orders: np.ndarray
    harmonics: np.ndarray

    def __post_init__(self) -> None:
        checks.instance(self.scene, "scene", LinearScene, "steady_state(body) makes one")
        speed = checks.number(self.speed, "speed", "rad/s")
        orders = checks.array(self.orders, "orders", shape=(None,), dtype=int)
        shape = (len(orders), self.scene.size)
        harmonics = checks.array(self.harmonics, "harmonics", shape=shape, dtype=complex)
        checks.keep(self, speed=speed, orders=orders, harmonics=harmonics)

    def __repr__(self) -> str:
        """Return one line."""
        return f"SteadyState({self.scene.body.name!r} at {self.speed:g} rad/s)"

    @property
    def left_out(self) -> float:
        """Share of the motion that its highest harmonics have: about what those beyond have."""
        sizes = np.abs(self.harmonics).max(axis=1)
        ends = sizes[np.abs(self.orders) >= self.orders.max() - 1].max()
        return float(ends / sizes.max()) if sizes.any() else 0.0

    def state(self, angle: float | None = None) -> StartState:
        """Return the state of the whole scene at an angle of the spin.

        Parameters
        ----------
        angle : float, optional
            Spin angle θ [rad]; the one with which the rotor starts by default.
        """
        scene, body = self.scene, self.scene.body
        angle = body.placement.angle if angle is None else checks.number(angle, "angle", "rad")
        turned = np.exp(1j * self.orders * angle)
        y = (turned @ self.harmonics).real
        y_t = (turned @ (1j * self.orders[:, None] * self.speed * self.harmonics)).real
        return scene.state(y, y_t, angle, self.speed)

    def interface_motion(self, interface: str, angle: float | None = None) -> np.ndarray:
        """Return displacement [m] and rotation [rad] of an interface, shape (6,).

        Along and about (n1, n2, e) of :attr:`SpinAxis.plane`, which stand still in space: the
        rotor's mesh axes at θ = 0.

        Parameters
        ----------
        interface : str
        angle : float, optional
            Spin angle [rad]; the mean over a revolution by default.

        Raises
        ------
        TypeError, ValueError
            For an interface without a marker, or an angle that is no number.
        """
        scene, body = self.scene, self.scene.body
        body.marker(interface)
        angles = 2.0 * np.pi * np.arange(4 * len(self.orders)) / (4 * len(self.orders))
        if angle is not None:
            angles = np.array([checks.number(angle, "angle", "rad")])
        rows = scene.interface_motion(interface)
        seen = (np.exp(1j * np.outer(angles, self.orders)) @ self.harmonics).real @ rows.T
        turns = np.array([axial_rotation(theta) for theta in angles])
        motion = np.einsum("tij,tkj->tki", turns, seen.reshape(-1, 2, 3))
        return motion.mean(axis=0).ravel()


def steady_state(
    body: RotorBody,
    speed: float | None = None,
    *,
    tolerance: float = 1e-8,
    start: SteadyState | StartState | None = None,
) -> SteadyState:
    """Find the periodic motion of a scene at a constant spin speed, under the loads that it has.

    Gravity, constant forces, the rotor's own unbalance, and the static deformation of supports and
    foundations. The equations are solved for the harmonics of a revolution by Newton's method, so
    that supports may be anisotropic and nonlinear. A run that starts from it stays on it.

    Parameters
    ----------
    body : RotorBody
        The rotor, in an assembled system.
    speed : float, optional
        Spin speed [rad/s]; the one with which the rotor starts by default.
    tolerance : float, optional
        Largest change in the last iteration, relative to the motion, and largest share of its
        highest harmonics; a contact that opens in every revolution is found to 1e-3, with a
        warning that tells a share above 1e-5.
    start : SteadyState or StartState, optional
        Motion of this scene near which the search begins, at this speed or another one: where
        there are several steady motions, it finds the one beside it. A StartState counts as a
        motion that turns with the rotor, as its whirl by unbalance does. By default the search
        begins with journals in the equilibria under their static loads.

    Returns
    -------
    SteadyState
        Its ``state()`` goes into :meth:`RotorBody.start_from`.

    Raises
    ------
    TypeError, ValueError
        For a system that is not assembled, a second rotor in it, constraints that turn with the
        rotor, or a rotor whose prescribed motion is not at constant speed.
    UnconvergedError
        Where there is no steady motion: a load that nothing holds, a resonance without damping,
        a load that does not repeat with every revolution, a stop or a bearing with clearance
        that the rotor leaves and hits, a spring of Exudyn on a free spin that turns.

    Notes
    -----
    Elements of a rolling bearing do not come back with the rotor, so that there is no periodic
    motion of a revolution. Their cage is held where it stands at the start: at rest the motion is
    the equilibrium, at a speed a run from it sways as the cage turns (varying compliance).

    The spin is prescribed, θ = Ωt. A run with a free spin departs by what unbalance and supports
    exert as torque: nothing for a balanced rotor, and of second order in the eccentricity.

    At rest it is an equilibrium at the angle of the start, in contact with stops and elements of
    bearings where these carry; friction that follows the sliding is none then.

    Examples
    --------
    Two masses of 2 kg on one axis, each on a spring of 2e4 N/m, sag by mg/k = 0.98 mm, whatever
    the speed:

    >>> import exudyn
    >>> from exudyn_rotor import add_rotor, rotor_example, steady_state
    >>> rotor = rotor_example()  # two masses of 2 kg on a rod
    >>> mbs = exudyn.SystemContainer().AddSystem()
    >>> body = add_rotor(
    ...     mbs, rotor.reduce(1), spin=50.0, translation="none", gravity=[0.0, -9.81, 0.0],
    ...     markers="position",
    ... )
    >>> for name, z in (("left", -0.1), ("right", 0.1)):
    ...     spring = mbs.CreateCartesianSpringDamper(
    ...         itemNumbers=[mbs.CreateGround(), body.marker(name)], localPosition0=[0, 0, z],
    ...         stiffness=[2e4] * 3, damping=[10.0] * 3,
    ...     )
    >>> mbs.Assemble()
    >>> steady = steady_state(body)
    >>> round(float(steady.interface_motion("left")[1]), 6)
    -0.000981
    >>> body.start_from(steady.state())
    """
    reduced_body(body)
    tolerance = checks.tolerance(tolerance)
    body.check_assembled()
    scene = LinearScene.of(body.mbs, body)
    speed = body.placement.speed if speed is None else checks.number(speed, "speed", "rad/s")
    begin = None if start is None else _begin(scene, start)
    found = SteadyState(scene, speed, *steady_motion(scene, speed, tolerance, begin))
    if speed and found.left_out > max(tolerance, _TOLD):
        warnings.warn(
            f"rotor {body.name!r}: {found.left_out:.0e} of the motion is left to higher harmonics, "
            "as by a contact or an edge of an oil film that moves in every revolution; a run from "
            "this state begins with as much of a transient",
            UserWarning,
            stacklevel=2,
        )
    return found


def _begin(scene: LinearScene, start: SteadyState | StartState) -> tuple[np.ndarray, np.ndarray]:
    """Return orders and harmonics of the motion with which a search begins."""
    how = "steady_state(body) makes one, and its state()"
    checks.instance(start, "start", (SteadyState, StartState), how)
    of_steady = isinstance(start, SteadyState)
    given, own = (start.scene.rest, start.scene.count) if of_steady else (start.q, scene.count)
    if (len(given), own) != (len(scene.rest), scene.count):
        raise ValueError(
            f"start: has {len(given)} coordinates, this scene {len(scene.rest)}; it is of another "
            "scene"
        )
    if of_steady:
        return start.orders, start.harmonics
    T = scene.turn(start.angle)[0]
    y = np.linalg.lstsq(T, (start.q - scene.rest)[scene.free])[0] - scene.undeformed
    return np.array([0]), y[None].astype(complex)
