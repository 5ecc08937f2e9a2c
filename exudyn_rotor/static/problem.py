"""A rotor on its supports under loads that stand still: its equations, and what is seen of it.

A constant force leaves a rotor that turns in the equilibrium ``K(Ω) y = f`` of the equations in
axes in which the force stands still. With the speed comes the centrifugal load that stands still in
these axes: in axes of the ground the part that is alike around the axis.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, replace
from functools import cached_property

import numpy as np

from exudyn_rotor.bearings.annular_seal import AnnularSeal
from exudyn_rotor.bearings.given import Given, check_interfaces
from exudyn_rotor.bearings.series import SeriesSupport
from exudyn_rotor.bearings.support import Support
from exudyn_rotor.linear.equations import Terms, turned
from exudyn_rotor.linear.model.assembly import Assembly
from exudyn_rotor.linear.model.body import RotorBody
from exudyn_rotor.linear.model.build import linear_model
from exudyn_rotor.linear.model.linear_model import LinearModel
from exudyn_rotor.linear.model.rotor_train import RotorTrain
from exudyn_rotor.linear.response.loads import (
    At,
    BaseAcceleration,
    HarmonicForce,
    places,
    total,
)
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.static.equilibrium import Journals, equilibrium
from exudyn_rotor.static.resting import Nonlinear, RigidBearing
from exudyn_rotor.theory.rotating_axes import axes_of, axial_skew

_ROUNDING = 1e-9  # share of a load that is none
_BALANCED = 1e-3  # share of torques, and of forces at the radius of gyration, left over unnoticed


@dataclass(frozen=True, eq=False)
class Problem:
    """A rotor on its supports under loads that stand still in the axes of a `frame`.

    The `model` has the linear supports; a bearing is a spring without stiffness there. What each
    element is stands in `acting`: a support, a link or a bearing. The inner part of a bearing in
    series comes before the outer one, whose numbers are `outer`; the place of its ring is among the
    coordinates.
    """

    model: LinearModel
    acting: tuple[object, ...]
    outer: tuple[int, ...]
    speed: float
    frame: str

    @classmethod
    def of(
        cls,
        target: LinearModel | ReducedRotor | RotorTrain,
        supports: tuple[Given | RigidBearing, ...],
        stiffening: str,
        speed: float,
        frame: str,
    ) -> Problem:
        """Return the problem of a rotor on supports, or of a train or model with its own."""
        if isinstance(target, ReducedRotor):
            check_interfaces(supports, target.interfaces)
            model = linear_model(target, stiffening=stiffening)
            model = replace(model, supports={"": supports})
        else:
            model = linear_model(target, supports=supports, stiffening=stiffening)
        if type(model) is not LinearModel:
            raise TypeError(
                "target: needs a rotor, a train or a linear model of these; of a scene, "
                "steady_state(body) finds the equilibrium"
            )
        acting, outer, plain = [], [], {}
        for name, given in model.supports.items():
            plain[name] = []
            for one in given:
                is_series = isinstance(one, SeriesSupport)
                parts = (one.inner, one.outer) if is_series else (one,)
                laws = [_law(part, frame == "rotor" and speed != 0.0) for part in parts]
                springs = [x if isinstance(x, Support) else Support(x.interface) for x in laws]
                acting += laws
                if is_series:
                    outer.append(len(acting) - 1)
                    springs = [replace(one, inner=springs[0], outer=springs[1])]
                plain[name] += springs
        acting += model.links
        # at rest nothing is averaged, and all modes count, halves of pairs among them
        axes = "inertial" if frame == "inertial" and speed else "rotor"
        model = replace(model, supports=plain, wanted_axes=axes)
        return cls(model, tuple(acting), tuple(outer), speed, frame)

    @property
    def _assembly(self) -> Assembly:
        return self.model.assembly(self.speed)

    @cached_property
    def stiffness(self) -> np.ndarray:
        """K (k, k) in the axes of the loads."""
        system = self.model.at(self.speed, 0.0)
        if not system.is_constant:
            raise ValueError(
                "frame: the supports are not alike in all directions, so that no motion stands "
                "still in axes that turn with the rotor; unbalance_response and harmonic_response "
                "have motions that repeat"
            )
        K = system.matrices()[2]
        for n, H in system.H:
            K = K - (1j * np.sign(n * self.speed) * H).real
        return K

    @property
    def _turns(self) -> int:
        return int(self.frame == "rotor" and self.speed != 0.0)

    def _still(self, seen: Terms) -> np.ndarray:
        """Return what stands still in the axes of the loads of a motion seen from outside."""
        return turned(seen, -self._turns)[0].real

    def load(self, loads: Mapping[At, np.ndarray], gravity: np.ndarray) -> np.ndarray:
        """Return the load (k,) of forces and moments (6,), of gravity (3,) and of the rotation."""
        load = np.zeros(self.model.size)
        for body, place_of in zip(self._assembly.bodies, self._assembly.slices, strict=True):
            if isinstance(body, RotorBody) and 0 in body.unbalance:
                load[place_of] = (body.ratio * self.speed) ** 2 * body.unbalance[0].real
        acting = [
            HarmonicForce(at, wrench[:3] @ self.axes, wrench[3:] @ self.axes, self.frame)
            for at, wrench in loads.items()
        ]
        self._check_torque(acting)
        if np.any(gravity):
            along = gravity @ self.axes
            if self._turns and np.abs(along[:2]).max() > _ROUNDING * np.linalg.norm(gravity):
                raise ValueError("gravity: stands still in space; leave frame='rotor' out")
            acting.append(BaseAcceleration(-along))
        if acting:
            load += total(acting, self.model, self.speed)[0].real
        return load

    def _check_torque(self, loads: Sequence[HarmonicForce]) -> None:
        """Refuse a torque left over on a free spin of a train."""
        model = self.model
        spins = model.free_spins
        if len(model.rotors) == 1 or not spins.shape[1] or not loads:
            return
        left = np.linalg.norm(spins.T @ total(loads, model, self.speed)[0].real)
        inertia = max(rotor.invariants.Theta for rotor in model.rotors.values())
        size = sum(
            np.linalg.norm(one.moment) + model.radius * np.linalg.norm(one.force) for one in loads
        )
        if left * np.sqrt(inertia) > _BALANCED * size:
            raise ValueError(
                "loads: they leave a torque about the axis over, on a spin that nothing holds; "
                "balance it, name the rotor that a drive holds in RotorTrain(…, driven=[…]), or "
                "give a support that holds the spin"
            )

    @property
    def axes(self) -> np.ndarray:
        """(n1, n2, e) of the first rotor as columns."""
        return axes_of(next(iter(self.model.rotors.values())).axis)

    @cached_property
    def _motions(self) -> list[np.ndarray]:
        """Motion (p, k) of each element in the axes of the loads."""
        return [self._still(U) for U in self._assembly.motions]

    @cached_property
    def _bearings(self) -> list[int]:
        """Numbers of the elements of bearings with a law of their own."""
        return [i for i, one in enumerate(self.acting) if isinstance(one, Nonlinear)]

    @cached_property
    def _journals(self) -> Journals:
        owners = [self._assembly.elements[i].ends[0][0] for i in self._bearings]
        U = np.reshape([self._motions[i][:2] for i in self._bearings], (-1, 2, self.model.size))
        speeds = [self.model.ratios[owner] * self.speed for owner in owners]
        return Journals([self.acting[i] for i in self._bearings], speeds, U)

    def solved(self, load: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        """Return the coordinates (k,) and the force on the rotor of each bearing (b, 2) [N]."""
        model = self.model
        loaded = any(one.invariants.K0 is not None for one in model.rotors.values())
        if loaded and not self.speed and not self._bearings:
            values = np.linalg.eigvalsh(0.5 * (self.stiffness + self.stiffness.T))
            if values[0] < -_ROUNDING * values[-1]:
                raise ValueError(
                    "supports: the rotor buckles on them under the loads of its prestress; "
                    "rotor.prestress(loads=…, supports=…) with them finds the buckling load"
                )
        y, forces = equilibrium(self.stiffness, load, self._journals, model.free_spins)
        if y is None:
            names = [name for name in model.free_motions if "spin" not in name]  # drives hold them
            free = " or ".join(names) or "a combination of rigid motions"
            raise ValueError(
                f"loads: one acts on {free}, a motion that no support holds; give one that does (a "
                "3 × 3 stiffness acts along the axis, too)"
            )
        return y, forces

    def seen(self, y: np.ndarray, forces: np.ndarray, at: Sequence[At] | None) -> dict[str, object]:
        """Return the fields of a result that are known of coordinates and forces of bearings."""
        observed, elements = places(self.model, at, self.speed), self._assembly.elements
        motion = np.array([self._still(one.seen) @ y for one in observed])
        motion[[one.is_node for one in observed], 3:] = np.nan
        own = dict(zip(self._bearings, forces, strict=True))
        shown = [i for i in range(len(self.acting)) if i not in self.outer]
        reactions, moved = np.zeros((2, len(shown), 6))
        for row, i in enumerate(shown):
            u = self._motions[i] @ y
            # in axes that turn past an element its damping resists, too
            K, D = elements[i].matrices(self.speed, 0.0)
            K = K + (self._turns - elements[i].turns) * self.speed * D @ axial_skew(len(D))
            moved[row], reactions[row] = u[:6], -(K @ u)[:6]
            if i + 1 in self.outer:
                moved[row] += self._motions[i + 1] @ y
            reactions[row, :2] += own.get(i, 0.0)
        names = [self._label(elements[i].ends) for i in shown]
        begins = [self._label(elements[i].ends[:1]) for i in shown]
        return {
            "places": tuple(one.label for one in observed),
            "motion": motion,
            "supports": _different(names),
            "reactions": reactions,
            "journals": moved,
            "heights": np.array([self._height(one.label) for one in observed]),
            "support_heights": np.array([self._height(name) for name in begins]),
            "axes": self.axes,
        }

    def _label(self, ends: Sequence[tuple[str, str]]) -> str:
        """Return the rotors and interfaces that an element acts on, without foundations."""
        known = [end for end in ends if end[0] in self.model.rotors]
        return " – ".join(":".join(filter(None, end)) for end in known)

    def _height(self, label: str) -> float:
        """Return the position of a place along the axis [m]; NaN of a foundation's own points."""
        rotor = next(iter(self.model.rotors.values()))
        if label.startswith("node ") and label not in self.model.interfaces:
            point = rotor.shapes.nodes[int(label.removeprefix("node "))]
        else:
            body, name = self.model.owner(label)
            rotor = body.alone.rotor if isinstance(body, RotorBody) else rotor
            if name not in rotor.interfaces:
                return np.nan
            point = rotor.interfaces[name].reference
        return float(point @ rotor.axis.direction)

    def mesh(self, y: np.ndarray, stress: bool) -> dict[str, np.ndarray]:
        """Return the known fields of a result at the nodes of the only rotor."""
        body = self._assembly.bodies[0]
        rotor, several = body.alone.rotor, len(self.model.rotors) > 1
        if stress and several:
            raise ValueError("stress: is found for one rotor alone, not for a train")
        if several or (rotor.shapes is None and not stress):
            return {}
        x = body.Q @ y[: body.size]
        rest = self.speed**2 * rotor.unshown_stress if stress else 0.0
        return {
            "nodes": rotor.shapes.nodes,
            "displacement": (rotor.shapes.matrix @ x).reshape(-1, 3),
            "stress": rotor.shapes.stress @ x + rest if stress else None,
        }


def _law(one: Given | RigidBearing, turns: bool) -> Support | Nonlinear:
    """Return a linear support as it is for motions that stand still, or `turn` with the rotor.

    A bearing that is not linear is returned as it is given.
    """
    if isinstance(one, AnnularSeal):
        one = one.linearised()
    if isinstance(one, Support):  # what stands still has no mass
        return one if turns else replace(one.at_frequency(0.0), mass=0.0)
    if turns:
        raise ValueError(
            f"frame: the bearing at {one.interface!r} stands still, and its force is not "
            "proportional; loads that turn with the rotor need supports that are alike in all "
            "directions"
        )
    return one


def _different(names: Sequence[str]) -> tuple[str, ...]:
    """Return names with a number behind each that came before."""
    numbered = ((name, names[: i + 1].count(name)) for i, name in enumerate(names))
    return tuple(name if n == 1 else f"{name}, {n}" for name, n in numbered)
