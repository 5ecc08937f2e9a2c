"""The linear model of a scene: its rotor and laws as in a list of supports, and what is foreign.

Laws of this package enter as they do from a list, bearings under the static force that they have
in the equilibrium of the scene. What else Exudyn has there is foreign: its coordinates are one
more body, and its forces have Exudyn's own derivatives by the coordinates of the model.
"""

from __future__ import annotations

from collections.abc import Iterable, Iterator, Sequence
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
from exudyn_rotor.linear.model.scene.steady_motion import WINDS_UP, newton, winds_up
from exudyn_rotor.multibody.supports.connector import Connector
from exudyn_rotor.multibody.supports.ends import BaseEnd

_WAVE_FREE = 0.99  # share of a held motion that must be no lateral wave
_TOLERANCE, _SMALLEST = 1e-8, 1e-5  # of an equilibrium, and [m] of the least that counts as one
_SAME_LOAD, _NO_LOAD = 1e-6, 1e-9  # of a load, and of the rotor's weight
_SAME = 0.05  # share of the stiffness of motions by which the unevenness of a mesh may change it
_PACES = 0.0, 1e-4, 1e-2, 1.0  # speeds that are compared, over a frequency of the scene
_SAME_SLOPE, _NO_SLOPE = 1e-6, 1e-12  # shares of a stiffness that are rounding of a difference
_WOUND = 0.2  # the same by moments of springs about the axis, whose mean over a turn is 1e-5 then
_ROUNDING = 1e-7  # share of a matrix of Exudyn's differences that is their rounding
_NOT_HELD = 1e-6  # share of a stiffness on the spin that leaves it free
_TURNS_OTHERWISE = (
    "linear scene at {:g} rad/s: an object acts otherwise as the rotor turns; let it act at "
    "interfaces, body.marker(name), or add a Support of frame='rotor' in its place; give a part "
    "that turns with the rotor to it, add_disc(…) or add_point_mass(…) of SolidRotor"
)
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
        way that few speeds do not show; all other forces are compared at speeds far apart.
        """
        scene, name = self.scene, "UserFunction"
        functions = [X for one in scene.foreign_items for n, X in one.items() if n.endswith(name)]
        follow = any(_follows_load(one.support) for one in scene.body.supports)
        if follow or scene.body.drives or any(functions):
            return None
        if not self._has_foreign:
            return {}, {}
        running, found = self.assembly(1.0), []
        stiffness = np.abs(np.diag(running.K))
        pace = np.sqrt(np.median(stiffness / np.maximum(np.diag(running.M), 1e-300))) or 1.0
        try:
            for speed in np.multiply(_PACES, pace).tolist():
                with probing(scene, speed) as probe:
                    state = self._equilibrium(probe)
                    found.append(self._foreign(probe, state, self.assembly(speed)))
        except NO_EQUATIONS:
            return None
        rest, first, *others = found
        size = np.sqrt(stiffness + np.abs(np.diag(first["K", 0, 0])))
        least = _SAME_SLOPE * np.outer(size, size) + _NO_SLOPE * size.max() ** 2
        for key, X in first.items():
            most = least / pace if key[0] == "D" else least
            if any(np.any(np.abs(one[key] - X) > most) for one in others):
                return None
        return rest, first

    def _added(self, speed: float) -> Powers:
        return self._constant[bool(speed)]

    def _alone(self, name: str, whole: bool) -> RotorAlone:
        return self.scene.rotor(super()._alone(name, whole), whole)

    @cached_property
    def _own_unevenness(self) -> dict[str, float]:
        alone = super()._alone("", False)
        held = self.scene.held(alone)  # a motion held across the axis turns with the rotor
        still = np.linalg.norm(alone.turning.still @ held, axis=0)
        return {"": np.inf} if np.any(still <= _WAVE_FREE) else super()._own_unevenness

    @property
    def _is_alike(self) -> bool:
        return not self._has_foreign and super()._is_alike

    @cached_property
    def stiffness_varies(self) -> bool:
        """Whether a stiffness depends on the speed; a foreign one may, with the equilibrium.

        A constant one counts as such, too, where it is negative for a motion: speeds are searched
        one by one then.
        """
        varies = super().stiffness_varies
        if varies or not self._has_foreign:
            return varies
        if not self._is_list:
            return True
        try:
            rest, basis = self.at(0.0), self.moving_basis
        except NO_EQUATIONS:
            return True
        K = rest.K[0] if basis is None else rest.projected(basis).K[0]
        return bool(np.linalg.eigvalsh(0.5 * (K + K.T)).min(initial=1.0) <= 0.0)

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
                undeformed = _Standing.of(probe, self.in_scene(assembly), assembly)
                K = K + self._foreign(probe, undeformed, assembly)["K", 0, 0]
        return assembly, K

    @cached_property
    def _neutral(self) -> tuple[np.ndarray, np.ndarray]:
        shifts, spins = super()._neutral
        assembly, K = self._held_at_rest
        if spins.size or not self.scene.is_spin_free or not self._has_foreign:
            return shifts, spins
        spin, pair = self.bodies[0].spin, np.zeros((2, self.size, 1))
        pair[:, assembly.slices[0], 0] = spin.turn, spin.momentum
        along, share = _turned_along(assembly, pair[0, :, 0], K, K)
        if share > _NOT_HELD:
            return shifts, spins
        for body, at in zip(self.bodies, assembly.slices, strict=False):
            if isinstance(body, StandingBody):
                pair[:, at, 0] = along[at], body.M @ along[at]
        pair[1] /= np.linalg.norm(pair[1])
        pair[0] /= np.sum(pair[0] * pair[1])
        return shifts, pair

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
        return replace(assembly, elements=tuple(elements)).system(float(speed), frequency, foreign)

    def _foreign(self, probe: Probe, state: _Standing, assembly: Assembly) -> Powers:
        """Return what foreign forces add to the equations of an assembly, about a state.

        In axes that stand still it is the mean over a turn, as of the rotor's matrices.

        Raises
        ------
        UnconvergedError
            Where it changes as the rotor turns, but for the unevenness of the mesh, and where it
            holds the spin at a speed.
        """
        moved, found = _Standing.of(probe, self.in_scene(assembly), assembly), []
        # what stands still has two harmonics in axes that turn
        count = (5 if self.turns else 3) if probe.speed else 1
        angles = 2.0 * np.pi * np.arange(count) / count
        # where nothing moves, damping adds no stiffness
        seen = probe.at_rest() if self.is_undamped else probe
        for theta in angles:
            x, v = state(theta)
            _, *slopes = seen.forces(theta, x, 0.0 * v if self.is_undamped else v, laws=False)
            found.append(self._of_assembly(*slopes, *moved.by_coordinates(theta)))
        orders = np.fft.fftfreq(count, 1.0 / count).round().astype(int)
        spectrum = np.fft.fft(np.array(found), axis=0) / count
        on_spin, is_wound = self._on_spin(seen, moved, assembly, angles)
        _, share = _turned_along(assembly, self._spin_row(assembly), spectrum[0, 1], on_spin[0, 1])
        if is_wound and share > _NOT_HELD and probe.speed:
            raise UnconvergedError(WINDS_UP.format(probe.speed))
        if not self.turns or not probe.speed:
            size = np.sqrt(np.abs(np.diag(assembly.K + spectrum[0, 1].real)))
            least = _WOUND if is_wound else _SAME
            least = least * np.outer(size, size) + _ROUNDING * size.max() ** 2
            if np.any(np.abs(spectrum[1:, 1]) > least):
                told = WINDS_UP if is_wound else _TURNS_OTHERWISE
                raise UnconvergedError(told.format(probe.speed))
            orders, spectrum = orders[:1], spectrum[:1]
        powers: Powers = {}
        for n, (D, K) in zip(orders.tolist(), spectrum + on_spin[: len(spectrum)], strict=True):
            put(powers, "D", 0, {n: D})
            put(powers, "K", 0, {n: K})
        return powers

    def _on_spin(
        self, probe: Probe, moved: _Standing, assembly: Assembly, angles: np.ndarray
    ) -> tuple[np.ndarray, bool]:
        """Return what foreign forces add on and by a free spin, harmonics (n, 2, l, l).

        Damping and stiffness, and whether a spring about the axis is among them.
        """
        s, found, held = self._spin_row(assembly), [], []
        for theta in angles if self.scene.is_spin_free else ():
            by_z, by_rate = moved.by_coordinates(theta)
            wide = np.vstack([by_z, s]), np.vstack([by_rate, 0.0 * s])
            slopes = probe.on_spin(theta)
            found.append(self._of_assembly(*slopes, *wide))
            held.append(slopes[0][-1, -1])
        if not np.any(found):
            return np.zeros((len(angles), 2, len(s), len(s))), False
        return np.fft.fft(np.array(found), axis=0) / len(angles), winds_up(held)

    def _of_assembly(
        self, K: np.ndarray, D: np.ndarray, by_z: np.ndarray, by_rate: np.ndarray
    ) -> list[np.ndarray]:
        """Return damping and stiffness by the coordinates of an assembly, of Exudyn's."""
        if self.is_undamped:
            K, D = 0.5 * (K + K.T), 0.5 * (D - D.T)
        K = by_z.T @ _without_rounding(K) @ by_z + by_z.T @ D @ by_rate
        return [by_z.T @ D @ by_z, _without_rounding(K)]

    def _spin_row(self, assembly: Assembly) -> np.ndarray:
        """Return the turn of a free spin by the coordinates of an assembly, (l,)."""
        row = np.zeros(assembly.size)
        for body, place in zip(assembly.bodies, assembly.slices, strict=True):
            if isinstance(body, RotorBody) and len(self.scene.spin_by_columns):
                row[place] = _by_rotor(self.scene, body, self.scene.spin_by_columns)[0][0].real
        return row

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

    def in_scene(self, assembly: Assembly) -> Iterator[Part]:
        """Yield how the rotor and what is beside it move by the coordinates of an assembly."""
        scene = self.scene
        for body, place in zip(assembly.bodies, assembly.slices, strict=True):
            if isinstance(body, RotorBody):
                rows = np.flatnonzero(scene.touching)
                yield rows, place, _by_rotor(scene, body, scene.by_columns)
            elif isinstance(body, StandingBody):
                yield scene.others, place, {0: np.eye(body.size)}

    def _equilibrium(self, probe: Probe) -> _Standing:
        """Return the equilibrium under loads that stand still.

        The unevenness of the rotor is averaged, and its own unbalance is left out.
        """
        speed, scene = probe.speed, self.scene
        _, controllers = self._elements_for(0, "full")
        assembly = Assembly((*self._bodies(0, speed == 0.0), *controllers), (), 0)
        metres = np.sqrt(np.maximum(np.diag(assembly.M), 1e-300) / scene.mass)
        parts = list(self.in_scene(assembly))
        with_own = [one for one in scene.body.supports if one.connector.own]
        first = len(assembly.bodies) - len(controllers)
        for body, place, one in zip(controllers, assembly.slices[first:], with_own, strict=True):
            metres[place] = np.maximum(metres[place], 1.0)  # of light pads
            is_pads = isinstance(one.support, TiltingPadBearing)
            unit = -1.0 / one.support.film.radius if is_pads else 1.0
            parts.append((scene.own_unknowns(one), place, {0: unit * np.eye(body.size)}))
        state = _Standing.of(probe, parts, assembly)
        start = journal_start(scene, speed, np.arange(-1, 2)).sum(axis=0).real
        z = np.linalg.lstsq(state.of_unknowns(0.0)[0], start, rcond=1e-9)[0]
        own = la.block_diag(*(body.K[0] + speed * sum(body.K[1:2]) for body in assembly.bodies))
        still, by_z, by_rate = probe.at_rest(), *state.by_coordinates(0.0)
        angles = 2.0 * np.pi * np.arange(3) / 3.0 if speed else [0.0]
        weights = [state.by_coordinates(a)[0].T @ still.rotor_terms(a)[3] for a in angles]
        weight = np.mean(weights, axis=0)

        def linearised(z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            force, K, D = probe.forces(0.0, by_z @ z, by_rate @ z)
            return own + by_z.T @ (K @ by_z + D @ by_rate), own @ z - weight - by_z.T @ force

        def unbalanced(z: np.ndarray) -> np.ndarray:
            force = probe.forces(0.0, by_z @ z, by_rate @ z, slopes=False).values
            return own @ z - weight - by_z.T @ force

        z = newton(
            scene,
            linearised,
            unbalanced,
            z,
            metres,
            lambda z: _TOLERANCE * max(np.abs(z * metres).max(), _SMALLEST),
            lambda _: (
                f"linear scene at {speed:g} rad/s: no equilibrium found; is there a load that "
                "nothing holds, or a bearing or a magnetic force stronger than what holds the "
                "rotor? A damped run from rest shows what it does"
            ),
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

    @classmethod
    def of(cls, probe: Probe, parts: Iterable[Part], assembly: Assembly) -> _Standing:
        """Return the undeformed state."""
        return cls(probe, list(parts), np.zeros(assembly.size))

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


def _turned_along(
    assembly: Assembly, turn: np.ndarray, K: np.ndarray, on_spin: np.ndarray
) -> tuple[np.ndarray, float]:
    """Return how things beside a rotor turn with it, (l,), and which share of stiffness is left.

    By the stiffness (l, l), and that `on_spin`, for coordinates `turn` of the rotor.
    """
    whole, along, beside = np.zeros(len(K)), np.zeros(len(K)), np.zeros(len(K), dtype=bool)
    whole[assembly.slices[0]] = turn[assembly.slices[0]]
    for body, place in zip(assembly.bodies, assembly.slices, strict=True):
        beside[place] = isinstance(body, StandingBody)
    force = on_spin.real @ whole
    along[beside] = -np.linalg.lstsq(K.real[np.ix_(beside, beside)], force[beside])[0]
    resistance = whole @ force
    return along, abs(resistance + whole @ on_spin.real @ along) / max(abs(resistance), 1e-300)


def _by_rotor(scene: LinearScene, body: RotorBody, rows: np.ndarray) -> Terms:
    """Return rows (r, n) by columns of the reduced rotor by its coordinates, (r, l)."""
    source = scene.body.selection.source
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
