"""The linear model of a scene: its rotor and laws as in a list of supports, and what is foreign.

Laws of this package enter as they do from a list, bearings under the static force that they have
in the equilibrium of the scene. What else Exudyn has there acts by its derivatives
(:mod:`.foreign`), and its coordinates are one more body.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
import scipy.linalg as la

from exudyn_rotor.bearings.clearance_stop import ClearanceStop
from exudyn_rotor.bearings.given import Given, linear_supports
from exudyn_rotor.bearings.squeeze_film import SqueezeFilmDamper
from exudyn_rotor.bearings.support import Support
from exudyn_rotor.linear.equations import PeriodicSystem, add, joined
from exudyn_rotor.linear.model.assembly import NO_EQUATIONS, Assembly, Element, End, elements_of
from exudyn_rotor.linear.model.body import RotorAlone, RotorBody, StandingBody
from exudyn_rotor.linear.model.linear_model import LinearModel
from exudyn_rotor.linear.model.scene.attached import Attached
from exudyn_rotor.linear.model.scene.equilibrium import equilibrium
from exudyn_rotor.linear.model.scene.foreign import Foreign, acting, between
from exudyn_rotor.linear.model.scene.journal_start import journal_start
from exudyn_rotor.linear.model.scene.linear_scene import LinearScene, follows_load
from exudyn_rotor.linear.model.scene.probe import Probe, probing
from exudyn_rotor.linear.model.scene.seen import Seen
from exudyn_rotor.multibody.supports.add_supports import SceneSupport
from exudyn_rotor.multibody.supports.ends import BaseEnd

ABOUT = ("equilibrium", "given")
_WAVE_FREE = 0.99  # share of a held motion that must be no lateral wave
_TOLERANCE = 1e-8  # of an equilibrium
_ANGLES = 7  # of a revolution, for the mean of the weight
_SAME_LOAD, _NO_LOAD = 1e-6, 1e-9  # of a load, and of the rotor's weight


@dataclass(frozen=True, eq=False)
class SceneModel(LinearModel):
    """The linear equations of a scene with a rotor in it; see :func:`linear_model`.

    Attributes
    ----------
    scene : LinearScene
    about : {'equilibrium', 'given'}
        State about which it is linearised.
    """

    scene: LinearScene = field(kw_only=True)
    about: str = field(kw_only=True)

    @classmethod
    def of(cls, scene: LinearScene, about: str, axes: str) -> SceneModel:
        """Return the model of a scene."""
        supports = scene.given
        if about == "equilibrium":  # any load, until that there is known
            share = np.array([0.0, -9.81 * scene.mass / max(len(supports), 1)])
            unknown = [follows_load(one) and one.load is None for one in supports]
            pairs = zip(supports, unknown, strict=True)
            supports = [replace(one, load=share) if yes else one for one, yes in pairs]
        return cls(
            {"": scene.body.selection.source}, {"": 1.0}, {"": supports}, (), None,
            scene.stiffening, axes, scene=scene, about=about,
        )  # fmt: skip

    # ------------------------------------------------------------------ what it consists of

    def _alone(self, name: str, whole: bool) -> RotorAlone:
        return self.scene.rotor(super()._alone(name, whole), whole)

    @cached_property
    def _own_unevenness(self) -> dict[str, float]:
        alone = super()._alone("", False)
        held = self.scene.held(alone)  # a motion held across the axis turns with the rotor
        still = np.linalg.norm(alone.turning.still @ held, axis=0)
        return {"": alone.unevenness(self.places("")) if np.all(still > _WAVE_FREE) else np.inf}

    def places(self, name: str) -> tuple[str, ...]:
        """Return the interfaces at which anything acts."""
        mbs, used = self.scene.body.mbs, set()
        for number in self.scene.foreign_objects:
            used |= {int(marker) for marker in mbs.GetObject(number).get("markerNumbers", ())}
        known = self.rotors[""].interfaces
        foreign = (n for n, marker in self.scene.body.markers.items() if int(marker) in used)
        both = (*super().places(name), *(n for n in foreign if n in known))
        return tuple(dict.fromkeys(both))

    @property
    def _is_alike(self) -> bool:
        return not self.scene.foreign and super()._is_alike

    def _elements_for(
        self, turns: int, kind: str = "", supports: Sequence[Given] | None = None
    ) -> tuple[list[Element], list]:
        kind = kind or ("undamped" if self.is_undamped else "full")
        elements, own = [], []
        for number, given in enumerate(supports or self.supports[""]):
            bases = {name: end for name, (end, _) in self._bases(number).items()}
            one = {"": [given]}
            more, added = elements_of(one, self.ratios, (), bases, turns, kind, len(own))
            elements, own = elements + more, own + added
        return elements, own

    def _bases(self, number: int) -> dict[str, tuple[End, BaseEnd]]:
        """Return what carries a support and its sensors, by their interfaces."""
        one = self.scene.body.supports[number]
        ends = {one.support.interface: one.connector.base}
        sensor = getattr(one.support, "sensor_interface", None)
        if sensor is not None:
            ends[sensor] = one.connector.sensor_base
        return {
            name: (("scene", f"{number}: {name}"), end)
            for name, end in ends.items()
            if end is not None
        }

    @cached_property
    def _standing_bodies(self) -> list[StandingBody]:
        """What is beside the rotor, with stiffness and damping of foundations."""
        scene = self.scene
        if not len(scene.others):
            return []
        M = scene.mass_beside
        labels = tuple(f"scene, {number}" for number in range(1, len(M) + 1))
        points = {
            end[1]: scene.base_motion(scene.body.supports[number], base)
            for number in range(len(scene.body.supports))
            for end, base in self._bases(number).values()
        }
        moves = scene.N[:, scene.others]
        K, D = (
            moves.T @ X[np.ix_(scene.free, scene.free)] @ moves for X in scene.foundation_matrices
        )
        return [StandingBody("scene", 0, M, (D,), (K,), labels, points=points)]

    @cached_property
    def _with_own(self) -> list[SceneSupport]:
        """Supports with coordinates of their own in linear models."""
        pairs = zip(self.scene.body.supports, self.supports[""], strict=True)
        return [one for one, given in pairs if linear_supports([given])[1]]

    # ------------------------------------------------------------------ equations

    @property
    def _is_list(self) -> bool:
        """Whether all is known without a look at Exudyn."""
        alike = self.about == "given" or not self.scene.follows_loads
        return alike and not self.scene.foreign and not self.scene.body.drives

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
            z, seen = self._equilibrium(probe)
            foreign = self._foreign(probe, seen, z)
            elements, _ = self._elements_for(self.turns, supports=self._under_loads(probe, seen, z))
            system = replace(assembly, elements=tuple(elements)).system(speed, frequency)
            self._add_foreign(system, probe, foreign, assembly)
        return system

    def _systems(
        self, speeds: np.ndarray, within: str = "", frequencies: np.ndarray | None = None
    ) -> tuple[PeriodicSystem | None, dict[int, Exception]]:
        if self._is_list:
            return super()._systems(speeds, within, frequencies)
        found, refused = [], {}
        basis = getattr(self, f"{within}_basis") if within else None
        rates = [None] * len(speeds) if frequencies is None else frequencies.tolist()
        for place, (speed, rate) in enumerate(zip(speeds.tolist(), rates, strict=True)):
            try:
                one = self.at(speed, rate)
            except NO_EQUATIONS as error:
                refused[place] = error
            else:
                found.append(one if basis is None else one.projected(basis))
        return joined(found) if found else None, refused

    @property
    def pattern(self) -> tuple:
        """The model: another scene may have any forces."""
        return (id(self),)

    def coefficients(self, speed: float) -> list | PeriodicSystem:
        """Return what :meth:`at_points` needs: the equations where more than laws is in them."""
        return super().coefficients(speed) if self._is_list else self.at(speed)

    def at_points(self, speeds: np.ndarray, coefficients: Sequence) -> PeriodicSystem:
        """Return equations at speeds as one stack."""
        return super().at_points(speeds, coefficients) if self._is_list else joined(coefficients)

    def _seen(self, assembly: Assembly, speed: float) -> Seen:
        return Seen.of(self.scene, assembly, self._with_own, speed)

    def _foreign(self, probe: Probe, seen: Seen, z: np.ndarray) -> Foreign:
        """Return derivatives about an equilibrium: those known, where they hold there."""
        if not self.scene.foreign and not probe.drives:
            none = np.zeros((1, self.scene.size, self.scene.size))
            return Foreign(none, none)
        known = self.scene.derivatives  # at two speeds: by dampers the places' go with the speed
        if known:
            found = between(known, probe.speed)
            if found.holds(probe, seen, z):
                return found
        found = Foreign.of(probe, seen, z)
        known.append((probe.speed, found))
        del known[:-2]
        return found

    def _add_foreign(
        self, system: PeriodicSystem, probe: Probe, foreign: Foreign, assembly: Assembly
    ) -> None:
        seen, undamped = self._seen(assembly, probe.speed), None
        if self.is_undamped:
            rotor, place = assembly.bodies[0], assembly.slices[0]
            undamped = np.zeros((assembly.size, assembly.size))
            undamped[place, place] = rotor.turns * rotor.alone.turning.generator
        D, K = foreign.terms(probe, seen, probe.speed, undamped)
        for terms, more in ((system.D, D), (system.K, K)):
            add(terms, {0: more[0]} if assembly.turns == 0 else more)

    # ------------------------------------------------------------------ equilibrium

    @cached_property
    def _weights(self) -> dict[bool, np.ndarray]:
        """Loads of the rotor's weight running and at rest, once known."""
        return {}

    def _equilibrium(self, probe: Probe) -> tuple[np.ndarray, Seen]:
        """Return an equilibrium under loads that stand still, by coordinates in inertial axes.

        The unevenness of the rotor is averaged, and its own unbalance is left out.
        """
        speed, scene = probe.speed, self.scene
        _, controllers = self._elements_for(0, "full")
        assembly = Assembly((*self._bodies(0, speed == 0.0), *controllers), (), 0)
        seen = self._seen(assembly, speed)
        T, T1, _ = probe.turn(0.0)
        W, W1, _ = seen.at(0.0)
        z = np.zeros(assembly.size)
        if self.about == "given":
            return z, seen
        orders = np.arange(-1, 2)
        start = journal_start(scene, speed, orders).sum(axis=0).real
        z = np.linalg.lstsq(W, start, rcond=1e-9)[0]
        own = la.block_diag(*(body.K[0] + speed * sum(body.K[1:2]) for body in assembly.bodies))
        if bool(speed) not in self._weights:
            self._weights[bool(speed)] = _mean_weight(probe.at_rest(), seen)
        weight = self._weights[bool(speed)]
        moving = speed * T1 @ W + T @ W1

        def at(z: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
            x, v = T @ W @ z, moving @ z
            force, K, D = probe.all_known(0.0, x, v)
            force = force + probe.foreign(0.0, x, v)
            more = probe.slopes_along(0.0, x, v)
            K, D = T.T @ (K @ T + more[0]), T.T @ (D @ T + more[1])
            return own + acting(probe, seen, 0.0, K, D)[1], own @ z - weight - W.T @ T.T @ force

        def unbalanced(z: np.ndarray) -> np.ndarray:
            return own @ z - weight - W.T @ T.T @ probe.force(0.0, T @ W @ z, moving @ z)

        metres = np.sqrt(np.maximum(np.diag(assembly.M), 1e-300) / scene.mass)
        for body, place in zip(assembly.bodies, assembly.slices, strict=True):
            if not isinstance(body, RotorBody | StandingBody):
                metres[place] = np.maximum(metres[place], 1.0)  # of light pads
        where = f"linear scene at {speed:g} rad/s"
        return equilibrium(scene, at, unbalanced, metres, z, _TOLERANCE, where), seen

    def _under_loads(self, probe: Probe, seen: Seen, z: np.ndarray) -> list[Given]:
        """Return the supports, bearings under the loads that they have by coordinates z."""
        if self.about == "given":
            return self.supports[""]
        T, T1, _ = probe.turn(0.0)
        W, W1, _ = seen.at(0.0)
        probe.read(0.0, T @ W @ z, (probe.speed * T1 @ W + T @ W1) @ z)
        least = _NO_LOAD * 9.81 * self.scene.mass
        return [
            _under_load(given, law, probe.speed, least) if follows_load(given) else given
            for given, law in zip(self.supports[""], probe.laws, strict=True)
        ]

    # ------------------------------------------------------------------ what a scene tells

    @cached_property
    def _held_at_rest(self) -> tuple[Assembly, np.ndarray]:
        assembly, K = super()._held_at_rest
        if self.scene.foreign:
            with probing(self.scene, 0.0) as probe:
                seen = self._seen(assembly, 0.0)
                foreign = self._foreign(probe, seen, np.zeros(assembly.size))
                K = K + foreign.terms(probe, seen, 0.0, None)[1][0]
        return assembly, K

    @property
    def stiffness_varies(self) -> bool:
        """Whether a stiffness depends on the speed; a scene may have any forces."""
        return bool(self.scene.foreign) or super().stiffness_varies

    def base_loads(self, speed: float = 1.0) -> None:
        """Return None: what the ground moves in a scene is not known."""
        return None

    def unknowns(self, motion: Mapping[int, np.ndarray], speed: float) -> dict[int, np.ndarray]:
        """Return harmonics of the unknowns y of the scene, given those (…, k) of coordinates."""
        found = {}
        for m, rows in self._seen(self.assembly(speed), speed).W.items():
            for n, x in motion.items():
                found[m + n] = found.get(m + n, 0.0) + x @ rows.T
        return found

    def __repr__(self) -> str:
        lines = super().__repr__().splitlines()
        lines[1] = f"scene around {lines[1].replace('rotor', repr(self.scene.body.name), 1)}"
        return "\n".join(lines)


def _mean_weight(still: Probe, seen: Seen) -> np.ndarray:
    """Return the load of the rotor's weight by coordinates in inertial axes (k,)."""
    angles = 2.0 * np.pi * np.arange(_ANGLES) / _ANGLES if seen.speed else [0.0]
    loads = [seen.at(a)[0].T @ still.turn(a)[0].T @ still.rotor_terms(a)[3] for a in angles]
    return np.mean(loads, axis=0)


def _under_load(given: Given, law: Attached, speed: float, least: float) -> Given:
    """Return a bearing under the static load that it has where its law has been read."""
    place = np.array(law.connector.relative[:2])
    if isinstance(given, SqueezeFilmDamper) and not given.carries:  # another spring does
        return Support(given.interface, *given.coefficients_at(place, speed))
    if isinstance(given, ClearanceStop):
        return Support(given.interface, *given.slopes(*place, 0.0, 0.0, 0.0, speed))
    load = -law.force(0.0).values[:2]
    load[np.abs(load) <= least] = 0.0
    if np.abs(load - given.load).max() <= _SAME_LOAD * np.abs(load).max():
        return given  # it remembers its coefficients
    return replace(given, load=load)
