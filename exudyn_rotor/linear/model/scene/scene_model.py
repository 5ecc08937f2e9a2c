"""The linear model of a scene: its rotor and laws as in a list of supports, and what is foreign.

Laws of this package enter as they do from a list, bearings under the static force that they have
in the equilibrium of the scene. What else Exudyn has there is foreign: its coordinates are one
more body, and its forces have Exudyn's own derivatives by the coordinates of the model.
"""

from __future__ import annotations

from collections.abc import Iterator, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
import scipy.linalg as la

from exudyn_rotor.bearings.clearance_stop import ClearanceStop
from exudyn_rotor.bearings.given import Given, linear_supports
from exudyn_rotor.bearings.squeeze_film import SqueezeFilmDamper
from exudyn_rotor.bearings.support import Support
from exudyn_rotor.linear.equations import PeriodicSystem, Terms, UnconvergedError, joined
from exudyn_rotor.linear.model.assembly import (
    NO_EQUATIONS,
    Assembly,
    End,
    OwnBody,
    PadBody,
    Powers,
    put,
)
from exudyn_rotor.linear.model.body import RotorAlone, RotorBody, StandingBody
from exudyn_rotor.linear.model.linear_model import LinearModel
from exudyn_rotor.linear.model.scene.equilibrium import equilibrium
from exudyn_rotor.linear.model.scene.journal_start import journal_start
from exudyn_rotor.linear.model.scene.linear_scene import LinearScene, follows_load
from exudyn_rotor.linear.model.scene.probe import Attached, Probe, probing
from exudyn_rotor.multibody.supports.add_supports import SceneSupport
from exudyn_rotor.multibody.supports.ends import BaseEnd
from exudyn_rotor.theory.rotating_axes import axial_skew

_WAVE_FREE = 0.99  # share of a held motion that must be no lateral wave
_TOLERANCE = 1e-8  # of an equilibrium
_SAME_LOAD, _NO_LOAD = 1e-6, 1e-9  # of a load, and of the rotor's weight
_SAME = 0.05  # share of the stiffness of motions by which the unevenness of a mesh may change it
_ROUNDING = 1e-7  # share of a matrix of Exudyn's differences that is their rounding


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
            replace(one, load=share) if follows_load(one) and one.load is None else one
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
        """Whether all is known without a look at Exudyn."""
        follow = any(follows_load(one.support) for one in self.scene.body.supports)
        return not follow and not self._has_foreign

    def _alone(self, name: str, whole: bool) -> RotorAlone:
        return self.scene.rotor(super()._alone(name, whole), whole)

    @cached_property
    def _own_unevenness(self) -> dict[str, float]:
        alone = super()._alone("", False)
        held = self.scene.held(alone)  # a motion held across the axis turns with the rotor
        still = np.linalg.norm(alone.turning.still @ held, axis=0)
        if np.any(still <= _WAVE_FREE):
            return {"": np.inf}
        return {"": self._alone("", False).unevenness(self.places(""))}

    @property
    def _is_alike(self) -> bool:
        return not self._has_foreign and super()._is_alike

    @property
    def stiffness_varies(self) -> bool:
        """Whether a stiffness depends on the speed; a foreign one may, with the equilibrium."""
        return self._has_foreign or super().stiffness_varies

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
        M = scene.mass_beside
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
    def _with_own(self) -> list[SceneSupport]:
        """Supports with coordinates of their own in linear models."""
        pairs = zip(self.scene.body.supports, self.supports[""], strict=True)
        return [one for one, given in pairs if linear_supports([given])[1]]

    @cached_property
    def _held_at_rest(self) -> tuple[Assembly, np.ndarray]:
        assembly, K = super()._held_at_rest
        if self._has_foreign:
            with probing(self.scene, 0.0) as probe:
                state = _Standing.of(self, probe, assembly)
                K = K + self._foreign(probe, state, assembly)["K", 0, 0]
        return assembly, K

    # ------------------------------------------------------------------ equations

    def at(self, speed: float, frequency: float | None = None) -> PeriodicSystem:
        """Return the equations at a spin speed, and a frequency of motions [rad/s].

        About the equilibrium at this speed.

        Raises
        ------
        NoCoefficientsError, UnconvergedError
            For a speed beyond a table, at which a film carries nothing, or without an equilibrium.
        """
        if self._is_list:
            return super().at(speed, frequency)
        assembly = self.assembly(speed)
        with probing(self.scene, speed) as probe:
            state = self._equilibrium(probe)
            foreign = self._foreign(probe, state, assembly) if self._has_foreign else {}
            elements, _ = self._elements_for(self.turns, "", self._loaded(probe, state))
        return replace(assembly, elements=tuple(elements)).system(speed, frequency, foreign)

    def _foreign(self, probe: Probe, state: _Standing, assembly: Assembly) -> Powers:
        """Return what foreign forces add to the equations of an assembly, about a state.

        In axes that stand still it is the mean over a turn, as of the rotor's matrices.

        Raises
        ------
        UnconvergedError
            Where it changes as the rotor turns, but for the unevenness of the mesh.
        """
        # what a support brings with it is known by its law
        pairs = zip(self.in_scene(assembly), assembly.bodies, strict=True)
        parts = [part for part, body in pairs if not isinstance(body, OwnBody)]
        moved, found = _Standing(probe, parts, np.zeros(assembly.size)), []
        # what stands still has two harmonics in axes that turn
        count = (5 if self.turns else 3) if probe.speed else 1
        angles = 2.0 * np.pi * np.arange(count) / count
        # where nothing moves, damping adds no stiffness
        seen = probe.at_rest() if self.is_undamped else probe
        for theta in angles:
            x, v = state(theta)
            _, K, D = seen.foreign(theta, x, 0.0 * v if self.is_undamped else v)
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
                    "frame='rotor' in its place"
                )
            orders, spectrum = orders[:1], spectrum[:1]
        powers: Powers = {}
        for n, (D, K) in zip(orders.tolist(), spectrum, strict=True):
            put(powers, "D", 0, {n: D})
            put(powers, "K", 0, {n: K})
        return powers

    def systems(
        self, speeds: np.ndarray, frequencies: np.ndarray | None
    ) -> tuple[PeriodicSystem | None, dict[int, Exception]]:
        if self._is_list:
            return super().systems(speeds, frequencies)
        found, refused = [], {}
        rates = [None] * len(speeds) if frequencies is None else frequencies.tolist()
        for place, (speed, rate) in enumerate(zip(speeds.tolist(), rates, strict=True)):
            try:
                found.append(self.at(speed, rate))
            except NO_EQUATIONS as error:
                refused[place] = error
        return joined(found) if found else None, refused

    @property
    def pattern(self) -> tuple:
        """The model: another scene may have any forces."""
        return (id(self),)

    def coefficients(self, speed: float) -> PeriodicSystem:
        """Return what :meth:`at_points` needs: the equations."""
        return self.at(speed)

    def at_points(self, speeds: np.ndarray, coefficients: Sequence) -> PeriodicSystem:
        """Return equations at speeds as one stack."""
        return joined(coefficients)

    # ------------------------------------------------------------------ equilibrium

    def in_scene(self, assembly: Assembly) -> Iterator[tuple[np.ndarray, slice, Terms]]:
        """Yield rows of the unknowns y, places of the coordinates, and y(θ) by these, terms."""
        scene, with_own = self.scene, iter(self._with_own)
        for body, place in zip(assembly.bodies, assembly.slices, strict=True):
            if isinstance(body, RotorBody):
                yield np.flatnonzero(scene.touching), place, _of_rotor(scene, body)
            elif isinstance(body, StandingBody):
                yield scene.others, place, {0: np.eye(body.size)}
            else:
                one = next(with_own)
                yield scene.own_unknowns(one), place, _of_own(body, one, assembly.turns)

    def _equilibrium(self, probe: Probe) -> _Standing:
        """Return the equilibrium under loads that stand still.

        The unevenness of the rotor is averaged, and its own unbalance is left out.
        """
        speed, scene = probe.speed, self.scene
        _, controllers = self._elements_for(0, "full")
        assembly = Assembly((*self._bodies(0, speed == 0.0), *controllers), (), 0)
        state = _Standing.of(self, probe, assembly)
        start = journal_start(scene, speed, np.arange(-1, 2)).sum(axis=0).real
        W = state.of_unknowns(0.0)[0]
        z = np.linalg.lstsq(W, start, rcond=1e-9)[0]
        own = la.block_diag(*(body.K[0] + speed * sum(body.K[1:2]) for body in assembly.bodies))
        still = probe.at_rest()
        angles = 2.0 * np.pi * np.arange(3) / 3.0 if speed else [0.0]
        weights = [state.by_coordinates(a)[0].T @ still.rotor_terms(a)[3] for a in angles]
        weight = np.mean(weights, axis=0)

        def at(z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            force, K, D = probe.forces(0.0, *replace(state, z=z)(0.0))
            by_z, by_rate = state.by_coordinates(0.0)
            return own + by_z.T @ (K @ by_z + D @ by_rate), own @ z - weight - by_z.T @ force

        def unbalanced(z: np.ndarray) -> np.ndarray:
            force = probe.force(0.0, *replace(state, z=z)(0.0))
            return own @ z - weight - state.by_coordinates(0.0)[0].T @ force

        metres = np.sqrt(np.maximum(np.diag(assembly.M), 1e-300) / scene.mass)
        for body, place in zip(assembly.bodies, assembly.slices, strict=True):
            if isinstance(body, OwnBody):
                metres[place] = np.maximum(metres[place], 1.0)  # of light pads
        where = f"linear scene at {speed:g} rad/s"
        return replace(state, z=equilibrium(scene, at, unbalanced, metres, z, _TOLERANCE, where))

    def _loaded(self, probe: Probe, state: _Standing) -> Sequence[Given]:
        """Return the supports, bearings under the loads that they have in an equilibrium."""
        probe.read(0.0, *state(0.0))
        least = _NO_LOAD * 9.81 * self.scene.mass
        return [
            _under_load(given, law, probe.speed, least) if follows_load(given) else given
            for given, law in zip(self.supports[""], probe.laws, strict=True)
        ]

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
    """A motion of constant coordinates z of an assembly, as a state of a scene.

    `parts` are those of :meth:`SceneModel.in_scene`.
    """

    probe: Probe
    parts: list[tuple[np.ndarray, slice, Terms]]
    z: np.ndarray

    @classmethod
    def of(cls, model: SceneModel, probe: Probe, assembly: Assembly) -> _Standing:
        """Return the undeformed state."""
        return cls(probe, list(model.in_scene(assembly)), np.zeros(assembly.size))

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
        return T @ W, self.probe.speed * T1 @ W + T @ W_t

    def __call__(self, theta: float) -> tuple[np.ndarray, np.ndarray]:
        """Return free coordinates and their rates at an angle."""
        return tuple(X @ self.z for X in self.by_coordinates(theta))


def _of_rotor(scene: LinearScene, body: RotorBody) -> Terms:
    """Return the unknowns that move the rotor by its coordinates, (r, l)."""
    source, alone = scene.body.selection.source, body.alone
    Q = alone.Q if len(alone.Q) == source.size else source.in_attached.T @ alone.Q
    L = scene.by_columns @ Q
    if body.is_apart:
        L = body.spin.about_axis(L)
    if not body.mean:
        return {0: L}
    return {-n: L @ part for n, part in alone.turning.parts(np.eye(L.shape[1])).items()}


def _of_own(body: OwnBody, one: SceneSupport, turns: int) -> Terms:
    """Return the unknowns that a support brings with it."""
    if isinstance(body, PadBody):
        return {0: -np.eye(body.size) / one.support.film.radius}
    if turns:
        return {0: np.eye(body.size)}
    half, quarter = np.eye(body.size // 2), axial_skew(3)[:2, :2]
    return {  # R(−θ) = cos θ − sin θ ẽ: pairs of a scene turn
        n: np.kron(half, 0.5 * (np.eye(2) + 1j * n * quarter)) for n in (1, -1)
    }


def _under_load(given: Given, law: Attached, speed: float, least: float) -> Given:
    """Return a bearing under the static load that it has where its law has been read."""
    place = np.array(law.connector.relative[:2])
    if isinstance(given, SqueezeFilmDamper) and not given.carries:  # another spring does
        return Support(given.interface, *given.coefficients_at(place, speed))
    if isinstance(given, ClearanceStop):
        return Support(given.interface, *given.slopes(*place, 0.0, 0.0, 0.0, speed))
    load = -np.array(law.connector.wrench(0.0)[:2])
    load[np.abs(load) <= least] = 0.0
    if np.abs(load - given.load).max() <= _SAME_LOAD * np.abs(load).max():
        return given  # it remembers its coefficients
    return replace(given, load=load)


def _without_rounding(X: np.ndarray) -> np.ndarray:
    """Return a matrix of differences without a skew part that is their rounding."""
    symmetric = 0.5 * (X + X.T)
    noise = np.abs(X - symmetric).max(initial=0.0) <= _ROUNDING * np.abs(X).max(initial=0.0)
    return symmetric if noise else X
