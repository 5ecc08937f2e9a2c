"""The linear model of a scene: its rotor and laws as in a list of supports, and what is foreign.

Laws of this package enter as they do from a list, bearings under the static force that they have
in the equilibrium of the scene. What else Exudyn has there is foreign: its coordinates are one
more body, and its forces have Exudyn's own derivatives by the coordinates of the model.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
import scipy.linalg as la

from exudyn_rotor.bearings.actuator import SaturatingActuator
from exudyn_rotor.bearings.annular_seal import AnnularSeal
from exudyn_rotor.bearings.bearing import Bearing
from exudyn_rotor.bearings.clearance_stop import ClearanceStop
from exudyn_rotor.bearings.given import Given
from exudyn_rotor.bearings.magnetic import MagneticBearing
from exudyn_rotor.bearings.squeeze_film import SqueezeFilmDamper
from exudyn_rotor.bearings.support import Support
from exudyn_rotor.bearings.tilting_pad import TiltingPadBearing
from exudyn_rotor.linear.equations import PeriodicSystem, Terms, UnconvergedError, joined
from exudyn_rotor.linear.model.assembly import NO_EQUATIONS, Assembly, End, Powers, put
from exudyn_rotor.linear.model.body import RotorAlone, RotorBody, StandingBody
from exudyn_rotor.linear.model.linear_model import LinearModel
from exudyn_rotor.linear.model.scene.journal_start import journal_start
from exudyn_rotor.linear.model.scene.linear_scene import LinearScene
from exudyn_rotor.linear.model.scene.probe import Probe, probing
from exudyn_rotor.linear.model.scene.steady_motion import newton
from exudyn_rotor.multibody.supports.connector import Connector
from exudyn_rotor.multibody.supports.ends import BaseEnd

_TOLERANCE = 1e-8  # of an equilibrium
_SAME_LOAD, _NO_LOAD = 1e-6, 1e-9  # of a load, and of the rotor's weight
_SAME = 0.05  # share of the stiffness of motions by which the unevenness of a mesh may change it
_SPEEDS = 0.0, 1.0, 1e3  # rad/s, of which the last ones are compared
_SAME_SLOPE = 1e-6  # share of the largest stiffness that is rounding of a difference
_ROUNDING = 1e-7  # share of a matrix of Exudyn's differences that is their rounding
# y(θ) by constant coordinates of a model: rows of the unknowns y, places of the coordinates, terms
Part = tuple[np.ndarray, slice, Terms]


@dataclass(frozen=True, eq=False)
class SceneModel(LinearModel):
    """The linear equations of a scene with a rotor in it; see :func:`linear_model`.

    Attributes
    ----------
    scene : LinearScene
    """

    scene: LinearScene = field(kw_only=True)

    @classmethod
    def of(cls, scene: LinearScene, axes: str) -> SceneModel:
        """Return the model of a scene."""
        given = [one.support for one in scene.body.supports]
        # any load, until that in the equilibrium is known
        share = np.array([0.0, -9.81 * scene.mass / max(len(given), 1)])
        given = [
            replace(one, load=share)
            if _follows_load(one) and one.load is None and getattr(one, "carries", True)
            else one
            for one in given
        ]
        return cls(
            {"": scene.body.selection.source}, {"": 1.0}, {"": given}, (), None,
            scene.body.stiffening, axes, scene=scene,
        )  # fmt: skip

    # ------------------------------------------------------------------ what it consists of

    @property
    def _has_foreign(self) -> bool:
        """Whether Exudyn has forces beside the rotor and laws."""
        return bool(self.scene.foreign_items or self.scene.body.drives)

    @property
    def _is_list(self) -> bool:
        return self._constant is not None

    @cached_property
    def _constant(self) -> tuple[Powers, Powers] | None:
        """What foreign forces add at rest and at any speed; None where it depends on the speed.

        Or where a law depends on its load. User functions and drives may depend on the speed in a
        way that few speeds do not show; all other forces are compared at two speeds far apart.
        """
        scene, name = self.scene, "UserFunction"
        functions = [X for one in scene.foreign_items for n, X in one.items() if n.endswith(name)]
        follow = any(_follows_load(one.support) for one in scene.body.supports)
        if follow or scene.body.drives or any(functions):
            return None
        if not self._has_foreign:
            return {}, {}
        found = []
        try:
            for speed in _SPEEDS:
                assembly = self.assembly(speed)
                with probing(scene, speed) as probe:
                    found.append(self._foreign(probe, self._equilibrium(probe), assembly))
        except NO_EQUATIONS:
            return None
        rest, first, last = found
        changes = [
            np.abs(last[key] - X).max() / max(np.abs(X).max(), 1e-300) for key, X in first.items()
        ]
        return (rest, first) if max(changes) < _SAME_SLOPE else None

    def _added(self, speed: float) -> Powers:
        return self._constant[bool(speed)]

    def _alone(self, name: str, whole: bool) -> RotorAlone:
        return self.scene.rotor(super()._alone(name, whole), whole)

    @property
    def _is_alike(self) -> bool:
        return not self._has_foreign and super()._is_alike

    @cached_property
    def stiffness_varies(self) -> bool:
        """Whether a stiffness depends on the speed; a foreign one may, with the equilibrium."""
        return super().stiffness_varies or (self._has_foreign and not self._is_list)

    @property
    def richer(self) -> LinearModel | None:
        """The model with more shapes; None beside foreign forces, which do not know these."""
        return None if self._has_foreign else super().richer

    def _base(self, number: int, name: str) -> End | None:
        end = self._base_ends(number).get(name)
        return ("scene", f"{number}: {name}") if end and end.size else None

    def _base_ends(self, number: int) -> dict[str, BaseEnd]:
        """Return what carries a support and its sensor in the scene, by their interfaces."""
        one = self.scene.body.supports[number]
        ends = {one.support.interface: one.connector.base}
        sensor = getattr(one.support, "sensor_interface", None)
        return ends if sensor is None else ends | {sensor: one.connector.seen.base}

    @cached_property
    def _standing_bodies(self) -> list[StandingBody]:
        """What is beside the rotor, whose forces are foreign."""
        scene = self.scene
        if not len(scene.others):
            return []
        with probing(scene, 0.0) as probe:
            M = probe.mass_beside[np.ix_(scene.others, scene.others)]
        labels = tuple(f"scene, {number}" for number in range(1, len(M) + 1))
        points = {
            f"{number}: {name}": scene.base_motion(base)
            for number in range(len(scene.body.supports))
            for name, base in self._base_ends(number).items()
            if base.size
        }
        none = (np.zeros_like(M),)
        return [StandingBody("scene", 0, M, none, none, labels, points=points)]

    @cached_property
    def _held_at_rest(self) -> tuple[Assembly, np.ndarray]:
        assembly, K = super()._held_at_rest
        if self._has_foreign:
            with probing(self.scene, 0.0) as probe:
                undeformed = _Standing(probe, self.in_scene(assembly), np.zeros(assembly.size))
                K = K + self._foreign(probe, undeformed, assembly)["K", 0, 0]
        return assembly, K

    # ------------------------------------------------------------------ equations

    def at(self, speed: float, frequency: float | None = None) -> PeriodicSystem:
        """Return the equations about the equilibrium at a speed, see :meth:`LinearModel.at`."""
        if self._is_list:
            return super().at(speed, frequency)
        assembly = self.assembly(speed)
        with probing(self.scene, speed) as probe:
            state = self._equilibrium(probe)
            foreign = self._foreign(probe, state, assembly) if self._has_foreign else {}
            elements, _ = self._elements_for(self.turns, "", self._loaded(probe, state))
        return replace(assembly, elements=tuple(elements)).system(float(speed), frequency, foreign)

    def _foreign(self, probe: Probe, state: _Standing, assembly: Assembly) -> Powers:
        """Return what foreign forces add to the equations of an assembly, about a state.

        In axes that stand still it is the mean over a turn, as of the rotor's matrices.
        """
        moved, found = _Standing(probe, self.in_scene(assembly), np.zeros(assembly.size)), []
        # what stands still has two harmonics in axes that turn
        count = (5 if self.turns else 3) if probe.speed else 1
        angles = 2.0 * np.pi * np.arange(count) / count
        # where nothing moves, damping adds no stiffness
        seen = probe.at_rest() if self.is_undamped else probe
        seen.check_free_spin(angles, dampers=not self.is_undamped)
        for theta in angles:
            x, v = state(theta)
            _, K, D = seen.forces(theta, x, 0.0 * v if self.is_undamped else v, laws=False)
            if self.is_undamped:
                K, D = 0.5 * (K + K.T), 0.5 * (D - D.T)
            by_z, by_rate = moved.by_coordinates(theta)
            K, D = by_z.T @ _without_rounding(K) @ by_z + by_z.T @ D @ by_rate, by_z.T @ D @ by_z
            found.append([D, _without_rounding(K)])
        orders = np.fft.fftfreq(count, 1.0 / count).round().astype(int)
        spectrum = np.fft.fft(np.array(found), axis=0) / count
        if not self.turns or not probe.speed:
            size = np.sqrt(np.abs(np.diag(assembly.K + spectrum[0, 1].real)))
            least = _SAME * np.outer(size, size) + _ROUNDING * size.max() ** 2
            if np.any(np.abs(spectrum[1:, 1]) > least):
                raise UnconvergedError(
                    f"linear scene at {probe.speed:g} rad/s: an object acts otherwise as the rotor "
                    "turns; let it act at interfaces, body.marker(name), or add a Support of "
                    "frame='rotor' in its place; give a part that turns with the rotor to it, "
                    "add_disc(…) or add_point_mass(…) of SolidRotor"
                )
            orders, spectrum = orders[:1], spectrum[:1]
        powers: Powers = {}
        for n, (D, K) in zip(orders.tolist(), spectrum, strict=True):
            put(powers, "D", 0, {n: D})
            put(powers, "K", 0, {n: K})
        return powers

    @property
    def pattern(self) -> tuple:
        """The model: another scene may have any forces."""
        return (id(self),)

    def coefficients(self, speed: float, frequency: float | None = None) -> PeriodicSystem:
        """Return what :meth:`at_points` needs: the equations."""
        return self.at(speed, frequency)

    def at_points(self, speeds: np.ndarray, coefficients: Sequence) -> PeriodicSystem:
        """Return equations at speeds as one stack."""
        return joined(coefficients)

    # ------------------------------------------------------------------ equilibrium

    def in_scene(self, assembly: Assembly) -> list[Part]:
        """Return how the rotor and what is beside it move by the coordinates of an assembly."""
        scene, parts = self.scene, []
        for body, place in zip(assembly.bodies, assembly.slices, strict=True):
            if isinstance(body, RotorBody):
                rows = np.flatnonzero(scene.touching)
                parts.append((rows, place, _by_rotor(scene, body)))
            elif isinstance(body, StandingBody):
                parts.append((scene.others, place, {0: np.eye(body.size)}))
        return parts

    def _equilibrium(self, probe: Probe) -> _Standing:
        """Return the equilibrium under loads that stand still.

        The unevenness of the rotor is averaged, and its own unbalance is left out.
        """
        speed, scene = probe.speed, self.scene
        _, controllers = self._elements_for(0, "full")
        assembly = Assembly((*self._bodies(0, speed == 0.0), *controllers), (), 0)
        metres = probe.metres_of(assembly.M, slice(assembly.slices[0].stop, None))
        parts = self.in_scene(assembly)
        with_own = [one for one in scene.body.supports if one.connector.own]
        first = len(assembly.bodies) - len(controllers)
        for body, place, one in zip(controllers, assembly.slices[first:], with_own, strict=True):
            is_pads = isinstance(one.support, TiltingPadBearing)
            unit = -1.0 / one.support.film.radius if is_pads else 1.0
            parts.append((scene.own_unknowns(one), place, {0: unit * np.eye(body.size)}))
        state = _Standing(probe, parts, np.zeros(assembly.size))
        start = journal_start(scene, speed)[1].sum(axis=0).real
        z = np.linalg.lstsq(state.of_unknowns(0.0)[0], start, rcond=1e-9)[0]
        own = la.block_diag(*(body.K[0] + speed * sum(body.K[1:2]) for body in assembly.bodies))
        still, by_z, by_rate = probe.at_rest(), *state.by_coordinates(0.0)
        angles = 2.0 * np.pi * np.arange(3) / 3.0 if speed else [0.0]
        weights = [state.by_coordinates(a)[0].T @ still.rotor_terms(a)[3] for a in angles]
        weight = np.mean(weights, axis=0)

        def balance(z: np.ndarray, slopes: bool) -> tuple[np.ndarray, np.ndarray]:
            force, K, D = probe.forces(0.0, by_z @ z, by_rate @ z, slopes=slopes)
            return own + by_z.T @ (K @ by_z + D @ by_rate), own @ z - weight - by_z.T @ force

        z = newton(
            scene,
            balance,
            z,
            metres,
            _TOLERANCE,
            f"linear scene at {speed:g} rad/s: no equilibrium found; is there a load that nothing "
            "holds, or a bearing or a magnetic force stronger than what holds the rotor? A damped "
            "run from rest shows what it does",
            yields=True,
        )
        return replace(state, z=z)

    def _loaded(self, probe: Probe, state: _Standing) -> Sequence[Given]:
        """Return the supports, bearings under the loads that they have in an equilibrium."""
        probe.read(0.0, *state(0.0))
        return [
            self._under_load(given, law, probe) if _follows_load(given) else given
            for given, law in zip(self.supports[""], probe.laws, strict=True)
        ]

    def _under_load(self, given: Given, law: Connector, probe: Probe) -> Given:
        """Return a bearing under the static load that it has where its law has been read."""
        place = np.array(law.relative[:2])
        if isinstance(given, SqueezeFilmDamper) and not given.carries:  # another spring does
            return Support(given.interface, *given.coefficients_at(place, probe.speed))
        if isinstance(given, ClearanceStop):
            return Support(given.interface, *given.slopes(*place, 0.0, 0.0, 0.0, probe.speed))
        load = -np.array(law.wrench(0.0)[:2])
        load[np.abs(load) <= _NO_LOAD * 9.81 * self.scene.mass] = 0.0
        if np.abs(load - given.load).max() <= _SAME_LOAD * np.abs(load).max():
            return given  # it remembers its coefficients
        return replace(given, load=load)

    # ------------------------------------------------------------------ what a scene tells

    def base_loads(self, speed: float = 1.0) -> None:
        """Return None: what the ground moves in a scene is not known."""
        return None

    def __repr__(self) -> str:
        lines = super().__repr__().splitlines()
        lines[1] = f"scene around {lines[1].replace('rotor', repr(self.scene.body.name), 1)}"
        if self._has_foreign:
            lines[2] = f"{lines[2]}, and forces of Exudyn".replace("none, and ", "")
        return "\n".join(lines)


@dataclass(frozen=True, eq=False)
class _Standing:
    """A motion of constant coordinates z of an assembly, as a state of a scene."""

    probe: Probe
    parts: list[Part]
    z: np.ndarray

    def of_unknowns(self, theta: float) -> tuple[np.ndarray, np.ndarray]:
        """Return the unknowns y and their rates by z, each (k, l)."""
        W = np.zeros((2, self.probe.scene.size, len(self.z)), dtype=complex)
        for rows, place, terms in self.parts:
            for n, X in terms.items():
                for power in range(2):
                    rate = (1j * n * self.probe.speed) ** power * np.exp(1j * n * theta)
                    W[power, rows, place] += rate * X
        return tuple(W.real)

    def by_coordinates(self, theta: float) -> tuple[np.ndarray, np.ndarray]:
        """Return free coordinates of the scene and their rates by z, each (f, l)."""
        W, W_t = self.of_unknowns(theta)
        T, T1, _ = self.probe.turn(theta)
        return T @ W, T1 @ W + T @ W_t

    def __call__(self, theta: float) -> tuple[np.ndarray, np.ndarray]:
        """Return free coordinates and their rates at an angle."""
        return tuple(X @ self.z for X in self.by_coordinates(theta))


def _by_rotor(scene: LinearScene, body: RotorBody) -> Terms:
    """Return the unknowns that move the rotor by its coordinates, (r, l)."""
    source = scene.body.selection.source
    rows = scene.of_coordinates(np.eye(source.size))[0].T
    if len(body.Q) != source.size:  # in a richer basis
        rows = rows @ source.in_attached.T
    return {-n: part for n, part in body.by_wave(rows).items()}


def _follows_load(one: Given) -> bool:
    """Return whether the coefficients of a support depend on its static load."""
    if isinstance(one, MagneticBearing):
        return isinstance(one.actuator, SaturatingActuator)
    return isinstance(one, Bearing) and not isinstance(one, AnnularSeal)


def _without_rounding(X: np.ndarray) -> np.ndarray:
    """Return a matrix of differences without a skew part that is their rounding."""
    symmetric = 0.5 * (X + X.T)
    noise = np.abs(X - symmetric).max(initial=0.0) <= _ROUNDING * np.abs(X).max(initial=0.0)
    return symmetric if noise else X
