"""The linear model of a scene: the rotor as in a list of supports, and what Exudyn has beside it.

The equations of the rotor are those that it has on supports. What is beside it acts on its motion y
in the scene, which is told from the coordinates z of the model at every angle of a revolution,

    y = W(θ) z,    W = L exp(−Nθ) + A⁺ (R(−θ) U₀ − A L exp(−Nθ)),

where L takes coordinates of the rotor to those in the scene, A is the motion of the interfaces by
y, and U₀ the motion that a support in a list sees (:mod:`exudyn_rotor.linear.model.turning`): the
second term is the unevenness that is averaged, so that connectors see the same motion as supports.
"""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace
from functools import cached_property

import numpy as np
import scipy.linalg as la

from exudyn_rotor.bearings.support import Support
from exudyn_rotor.linear.equations import PeriodicSystem, Terms, add, joined, turned
from exudyn_rotor.linear.model.assembly import NO_EQUATIONS, Assembly, is_isotropic_matrix
from exudyn_rotor.linear.model.body import RotorAlone, RotorBody, StandingBody, rotor_body
from exudyn_rotor.linear.model.linear_model import LinearModel, beside
from exudyn_rotor.linear.model.scene.films import film_bodies, film_elements
from exudyn_rotor.linear.model.scene.linear_scene import LinearScene
from exudyn_rotor.linear.model.scene.probe import Rest
from exudyn_rotor.linear.model.scene.sampled_terms import terms_of
from exudyn_rotor.linear.model.turning import interface_motion
from exudyn_rotor.theory.rotating_axes import axial_skew

_HELD = 1e-8  # share of a motion of the rotor that is none of the scene
_WAVE_FREE = 0.99  # share of a held motion that must be no lateral wave
_DEPENDENT = 1e-3  # of singular values of the motion of interfaces
_LEAST = 1e-9  # share of harmonics of coefficients that is rounding of differences
_SKEW = 1e-9  # share of stiffness and damping that is


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
        source = scene.body.selection.source
        return cls({"": source}, {"": 1.0}, {"": ()}, (), None, scene.stiffening, axes, scene=scene)

    # ------------------------------------------------------------------ what it consists of

    @cached_property
    def _touching(self) -> np.ndarray:
        """Which of the unknowns of the scene move the rotor, (k,)."""
        return np.any(self.scene.N[: self.scene.modal.stop] != 0.0, axis=0)

    @cached_property
    def _columns(self) -> np.ndarray:
        """Columns of the reduced rotor by the unknowns that move it, (n, r)."""
        scene, rotor = self.scene, self.rotors[""]
        moved = rotor.invariants.S.T @ scene.axes[:, : scene.count]
        known = np.hstack([moved, scene.body.selection.T])
        return known @ scene.N[: scene.modal.stop, self._touching]

    def _held(self, alone: RotorAlone) -> np.ndarray:
        """Return motions of a rotor that it does not have in the scene, orthonormal (k, f)."""
        columns = self._columns / np.linalg.norm(self._columns, axis=0)
        return la.null_space(columns.T @ alone.Q, rcond=_HELD)

    def _alone(self, name: str, whole: bool) -> RotorAlone:
        alone = super()._alone(name, whole)
        held = self._held(alone)
        if not held.shape[1]:
            return alone
        if not whole:
            held = la.orth(alone.turning.still @ held)
        V = beside(held)
        terms = alone.terms
        terms = replace(
            terms,
            h=V.T @ terms.h,
            g=V.T @ terms.g,
            **{
                name: None if X is None else V.T @ X @ V
                for name, X in ((n, getattr(terms, n)) for n in ("G", "C_hat", "W", "B", "K4"))
            },
        )
        spin = alone.spin
        if spin is not None and np.linalg.norm(spin.momentum @ V) < 0.5:
            spin = None
        elif spin is not None:
            spin = replace(
                spin, momentum=spin.momentum @ V, turn=spin.turn @ V, rigid=V.T @ spin.rigid
            )
        return replace(
            alone,
            invariants=alone.invariants.in_basis(V),
            terms=terms,
            Q=alone.Q @ V,
            turning=alone.turning.within(V),
            spin=spin,
        )

    @cached_property
    def _own_unevenness(self) -> dict[str, float]:
        alone = super()._alone("", False)
        held = self._held(alone)  # a motion that is held across the axis turns with the rotor
        still = np.linalg.norm(alone.turning.still @ held, axis=0)
        return {"": alone.unevenness(self.places("")) if np.all(still > _WAVE_FREE) else np.inf}

    def places(self, name: str) -> tuple[str, ...]:
        """Return the interfaces at whose markers anything acts."""
        mbs, used = self.scene.body.mbs, set()
        for number in range(mbs.systemData.NumberOfObjects()):
            used |= {int(marker) for marker in mbs.GetObject(number).get("markerNumbers", ())}
        known = self.rotors[""].interfaces
        return tuple(
            n for n, marker in self.scene.body.markers.items() if int(marker) in used and n in known
        )

    @cached_property
    def turns(self) -> int:
        """Whether the axes of the rotor turn with Ω (1) or stand still (0)."""
        if self.wanted_axes != "auto":
            return int(self.wanted_axes == "rotor")
        given = [one.support for one in self.scene.body.supports]
        plain = [one for one in given if isinstance(one, Support)]
        alike = [all(map(is_isotropic_matrix, one.matrices(0.0))) for one in plain]
        turning = [one.frame == "rotor" for one in plain]
        if self._own_unevenness[""] > self.largest_unevenness:
            return 1
        if any(turns and not same for turns, same in zip(turning, alike, strict=True)):
            return 1
        # a basis with halves of pairs is taken whole where that is constant, too
        constant = 0 < len(plain) == len(given) and all(alike) and not self._standing.size
        constant = constant and not any(one.varies for one in plain)
        return int(constant and self._alone("", False).has_halves)

    def _assembled(self, turns: int, at_rest: bool = False, kind: str = "") -> Assembly:
        alone = self._alone("", self.turns == 1)
        ratio, frame = (0.0, 0) if at_rest else (1.0, turns)
        rotor = rotor_body("", alone, ratio, frame, is_apart=not at_rest)
        voids = [] if self.is_undamped else film_bodies(self.scene, frame)
        return Assembly((rotor, self._standing, *voids), (), frame)

    @cached_property
    def _standing(self) -> StandingBody:
        """What is beside the rotor, its stiffness and damping left out."""
        others = ~self._touching
        M = self.scene.mass_matrix[np.ix_(others, others)]
        labels = tuple(f"scene, {number}" for number in range(1, len(M) + 1))
        points = {}
        for one in self.scene.remembering:
            if one.base is not None:
                motion = self.scene.base_motion(one)[:, others]
                points[one.support.interface] = np.vstack([motion, 0.0 * motion])
        none = np.zeros(M.shape)
        return StandingBody("scene", 0, M, (none,), (none,), labels, points=points)

    # ------------------------------------------------------------------ equations

    def at(self, speed: float, frequency: float | None = None) -> PeriodicSystem:
        """Return the equations at a spin speed [rad/s], about the steady motion there.

        They do not depend on the frequency.

        Raises
        ------
        UnconvergedError
            Where no steady motion is found, or 192 angles do not resolve the coefficients.
        """
        points, journals = self.scene.points(speed)
        points = points if speed else points[:1]
        assembly = self.assembly(speed)
        elements = film_elements(self.scene, journals, speed, assembly, self.is_undamped)
        system = replace(assembly, elements=elements).system(speed)
        W = _Seen.of(self, assembly.bodies[0])
        samples = zip(
            *(W.acting(point.rest, speed, self.is_undamped) for point in points), strict=False
        )
        M, D, K = (np.array(each) for each in samples)
        k = self._running_size
        own = assembly.M.copy()
        own[assembly.slices[1], assembly.slices[1]] = 0.0
        own[:k, :k] += M.mean(axis=0)
        scale = 1.0 / np.sqrt(np.diag(own)[:k])
        free = _unresisted(K, scale) & _unresisted(D, scale)
        for X in (D, K):
            X[:, free], X[:, :, free] = 0.0, 0.0
        # of a round rotor the mean is taken, but for what unbalance moves in each revolution
        for terms, X in ((system.D, D), (system.K, K)):
            found = terms_of(X, scale, _LEAST)
            if assembly.turns == 0 and self.scene.about != "steady":
                found = {0: found[0]}
            add(terms, {n: np.pad(Y, (0, self.size - k)) for n, Y in found.items()})
        return replace(system, M=own)

    def _systems(
        self, speeds: np.ndarray, within: str = "", frequencies: np.ndarray | None = None
    ) -> tuple[PeriodicSystem | None, dict[int, Exception]]:
        found, refused = [], {}
        for place, speed in enumerate(speeds.tolist()):
            try:
                found.append(self.at(speed))
            except NO_EQUATIONS as error:
                refused[place] = error
        return joined(found) if found else None, refused

    @property
    def pattern(self) -> tuple:
        """The model: another scene may have any forces."""
        return (id(self),)

    def coefficients(self, speed: float) -> PeriodicSystem:
        """Return the equations at a speed [rad/s], which stand for coefficients."""
        return self.at(speed)

    def at_points(
        self, speeds: np.ndarray, coefficients: Sequence[PeriodicSystem]
    ) -> PeriodicSystem:
        """Return equations at speeds as one stack."""
        return joined(coefficients)

    @property
    def _running_size(self) -> int:
        """Number of coordinates but those of films."""
        return sum(body.size for body in self.bodies[:2])

    def unknowns(self, motion: Mapping[int, np.ndarray], speed: float) -> dict[int, np.ndarray]:
        """Return harmonics of the unknowns y of the scene, given those (…, k) of coordinates."""
        W, found = _Seen.of(self, self.assembly(speed).bodies[0]).W, {}
        for m, rows in W.items():
            for n, x in motion.items():
                found[m + n] = found.get(m + n, 0.0) + x[..., : rows.shape[1]] @ rows.T
        return found

    # ------------------------------------------------------------------ what a scene tells

    @property
    def richer(self) -> None:
        """None: what connectors do with shapes that the rotor lacks is not known."""
        return None

    @property
    def stiffness_varies(self) -> bool:
        """True: a scene may have any forces."""
        return True

    @property
    def table_speeds(self) -> np.ndarray:
        """Speeds at the points of the tables of supports [rad/s]."""
        return np.unique(self.scene.table_speeds)

    @property
    def interfaces(self) -> tuple[str, ...]:
        """Names of the interfaces that have a marker."""
        return self.scene.interfaces

    def base_loads(self, speed: float = 1.0) -> None:
        """Return None: what the ground moves in a scene is not known."""
        return None

    @property
    def free_motions(self) -> tuple[str, ...]:
        """None that are known: the motion about which it is linearised needs all to be held."""
        return ()

    @property
    def _neutral(self) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        none = np.zeros((self.size, 0))
        return none, none, np.zeros(0, dtype=bool)

    def __repr__(self) -> str:
        names = ", ".join(self.interfaces) or "none"
        return (
            f"LinearModel of {self.size} coordinates in {self.axes} axes\n"
            f"scene around rotor {self.scene.body.name!r}, about={self.scene.about!r}, interfaces "
            f"{names}\nstiffening: {self.stiffening}, unevenness {self.unevenness:.2g}"
        )


@dataclass(frozen=True, eq=False)
class _Seen:
    """W(θ): the unknowns of a scene by the coordinates of a model, as Fourier terms (k, l).

    N (l, l): the rates over Ω, seen from outside, of coordinates that turn.
    """

    W: Terms
    N: np.ndarray

    @classmethod
    def of(cls, model: SceneModel, body: RotorBody) -> _Seen:
        scene, alone, touching = model.scene, body.alone, model._touching
        columns, rotor = model._columns, model.rotors[""]
        L = np.linalg.pinv(columns) @ alone.Q
        waves = alone.turning.parts(np.eye(L.shape[1])) if body.mean else {0: np.eye(L.shape[1])}
        terms = {-n: L @ part for n, part in waves.items()}
        names = [n for n in model.interfaces if n in rotor.interfaces]
        if names and body.ratio:
            reach = np.repeat([1.0, model.radius], 3)[:, None]
            A = np.vstack([reach * interface_motion(rotor, n) @ columns for n in names])
            inverse = np.linalg.pinv(A, rcond=_DEPENDENT)
            U = {}
            for i, name in enumerate(names):
                for n, X in turned(body.supported(name), -1).items():
                    U.setdefault(n, np.zeros((len(A), L.shape[1]), dtype=complex))
                    U[n][6 * i : 6 * i + 6] = reach * X
            lacking = {n: X.astype(complex) for n, X in U.items()}
            add(lacking, {n: A @ X for n, X in terms.items()}, -1.0)
            add(terms, {n: inverse @ X for n, X in lacking.items()})
        others, still = np.flatnonzero(~touching), {}
        size = L.shape[1] + len(others)
        for n, X in terms.items():
            still[n] = np.zeros((len(touching), size), dtype=complex)
            still[n][touching, : L.shape[1]] = X
        still.setdefault(0, np.zeros((len(touching), size), dtype=complex))
        still[0][others, L.shape[1] + np.arange(len(others))] = 1.0
        if body.turns == 0 and body.ratio and len(scene.pairs):
            cls._turn_pairs(scene, still, others, L.shape[1])
        N = np.zeros((size, size))
        N[: L.shape[1], : L.shape[1]] = body.turns * alone.turning.generator
        return cls(still, N)

    @staticmethod
    def _turn_pairs(
        scene: LinearScene, terms: dict[int, np.ndarray], others: np.ndarray, begin: int
    ) -> None:
        """Let pairs that stand still be those of the scene, which turn."""
        quarter = axial_skew(3)[:2, :2]
        for pair in scene.pairs:
            rows = [int(np.flatnonzero(scene.N[place])[0]) for place in pair]
            columns = begin + np.searchsorted(others, rows)
            within = np.ix_(rows, columns)
            terms[0][within] = 0.0
            for n in (1, -1):  # R(−θ) = cos θ − sin θ ẽ
                terms.setdefault(n, np.zeros_like(terms[0]))
                terms[n][within] = 0.5 * (np.eye(2) + 1j * n * quarter)

    def acting(
        self, rest: Rest, speed: float, undamped: bool
    ) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
        """Return M, D, K (l, l) of what is beside the rotor at one angle."""
        W = [
            sum((1j * n * speed) ** p * X * np.exp(1j * n * rest.theta) for n, X in self.W.items())
            for p in range(3)
        ]
        W = [each.real for each in W]
        T, T1, T2 = rest.turns
        Z, Z1 = T @ W[0], T1 @ W[0] + T @ W[1]
        Z2 = T2 @ W[0] + 2.0 * T1 @ W[1] + T @ W[2]
        D, K = _without_noise(rest.D), _without_noise(rest.K)
        K = W[0].T @ (K @ W[0] + D @ (T.T @ Z1))
        D = W[0].T @ D @ W[0]
        if undamped:
            K = K - speed * D @ self.N  # by rates alone
            D = _without_noise(D)
            D, K = 0.5 * (D - D.T), 0.5 * (K + K.T)
        mass = Z.T @ rest.mass
        return mass @ Z, 2.0 * mass @ Z1 + D, mass @ Z2 + K


def _unresisted(samples: np.ndarray, scale: np.ndarray) -> np.ndarray:
    """Return which coordinates samples (n, k, k) act on by rounding of differences alone, (k,)."""
    sizes = np.abs(samples * np.outer(scale, scale)).max(axis=0, initial=0.0)
    return np.maximum(sizes.max(axis=0), sizes.max(axis=1)) <= _SKEW * sizes.max(initial=0.0)


def _without_noise(X: np.ndarray) -> np.ndarray:
    """Return a matrix of differences without a skew part that is their rounding."""
    symmetric = 0.5 * (X + X.T)
    noise = np.abs(X - symmetric).max(initial=0.0) <= _SKEW * np.abs(X).max(initial=0.0)
    return symmetric if noise else X
