"""The unknowns of a scene by the coordinates of its linear model.

The equations of the rotor are those that it has on supports. What else Exudyn has in the scene acts
on the unknowns y, which are told from the coordinates z of the model at every angle,

    y = W(θ) z,    W = L exp(−Nθ) + A⁺ (R(−θ) U₀ − A L exp(−Nθ)),

where L takes coordinates of the rotor to those in the scene, A is the motion of the interfaces by
y, and U₀ the motion that a support in a list sees (:mod:`exudyn_rotor.linear.model.turning`): the
second term is the unevenness that is averaged, so that foreign connectors see the same motion as
supports. In a richer basis it is also what the interfaces move by further shapes.
"""

from __future__ import annotations

from dataclasses import dataclass

import numpy as np

from exudyn_rotor.linear.equations import Terms, add, turned
from exudyn_rotor.linear.model.assembly import Assembly, OwnBody, PadBody
from exudyn_rotor.linear.model.body import RotorBody, StandingBody
from exudyn_rotor.linear.model.scene.linear_scene import LinearScene
from exudyn_rotor.linear.model.turning import interface_motion, radius_of_gyration
from exudyn_rotor.multibody.supports.add_supports import SceneSupport
from exudyn_rotor.theory.rotating_axes import axial_skew

_DEPENDENT = 1e-3  # of singular values of the motion of interfaces


@dataclass(frozen=True, eq=False)
class Seen:
    """W(θ) as Fourier terms (k, l), at a speed."""

    W: Terms
    speed: float

    @classmethod
    def of(
        cls, scene: LinearScene, assembly: Assembly, own: list[SceneSupport], speed: float
    ) -> Seen:
        """Return the unknowns by the coordinates of an assembly.

        `own` are the supports whose coordinates its bodies of the kind OwnBody have, in order.
        """
        size, W = (scene.size, assembly.size), {}
        owners = iter(own)
        for body, place in zip(assembly.bodies, assembly.slices, strict=True):
            if isinstance(body, RotorBody):
                rows, terms = np.flatnonzero(scene.touching), _of_rotor(scene, body)
            elif isinstance(body, StandingBody):
                rows, terms = scene.others, {0: np.eye(body.size)}
            else:
                rows, terms = _of_own(scene, body, next(owners), assembly.turns, speed)
            for n, X in terms.items():
                W.setdefault(n, np.zeros(size, dtype=complex))[rows, place] += X
        return cls(W, speed)

    def at(self, theta: float) -> list[np.ndarray]:
        """Return W (k, l) at an angle and its first two derivatives by time."""
        return [
            sum(
                (1j * n * self.speed) ** p * X * np.exp(1j * n * theta) for n, X in self.W.items()
            ).real
            for p in range(3)
        ]


def _of_rotor(scene: LinearScene, body: RotorBody) -> dict[int, np.ndarray]:
    """Return the unknowns that move the rotor by its coordinates, (r, l)."""
    source, alone, columns = scene.body.selection.source, body.alone, scene.columns
    Q = alone.Q if len(alone.Q) == source.size else source.in_attached.T @ alone.Q
    L = (np.linalg.pinv(np.hstack([columns, scene.spin_column])) @ Q)[: columns.shape[1]]
    if body.is_apart:
        L = body.spin.about_axis(L)
    terms = {0: L}
    if body.mean:
        terms = {-n: L @ part for n, part in alone.turning.parts(np.eye(L.shape[1])).items()}
    names = [name for name in scene.interfaces if name in source.interfaces]
    if not names or not body.ratio:
        return terms
    reach = np.repeat([1.0, radius_of_gyration(alone.invariants)], 3)[:, None]
    A = np.vstack([reach * interface_motion(source, name) @ columns for name in names])
    inverse, lacking = np.linalg.pinv(A, rcond=_DEPENDENT), {}
    for i, name in enumerate(names):
        for n, X in turned(body.supported(name), -1).items():
            lacking.setdefault(n, np.zeros((len(A), L.shape[1]), dtype=complex))
            lacking[n][6 * i : 6 * i + 6] = reach * X
    add(lacking, {n: A @ X for n, X in terms.items()}, -1.0)
    if scene.spin_column.size and body.spin is not None:  # y has no spin
        spin = np.outer(body.spin.momentum, body.spin.momentum)
        lacking = {n: X - X @ spin for n, X in lacking.items()}
    add(terms, {n: inverse @ X for n, X in lacking.items()})
    return terms


def _of_own(
    scene: LinearScene, body: OwnBody, one: SceneSupport, turns: int, speed: float
) -> tuple[np.ndarray, dict[int, np.ndarray]]:
    """Return the unknowns that a support brings with it, and their rows."""
    rows = scene.own_unknowns(one)
    if isinstance(body, PadBody):
        return rows, {0: -np.eye(body.size) / one.support.film.radius}
    if turns or not speed:
        return rows, {0: np.eye(body.size)}
    half, quarter = np.eye(body.size // 2), axial_skew(3)[:2, :2]
    return rows, {  # R(−θ) = cos θ − sin θ ẽ: pairs of a scene turn
        n: np.kron(half, 0.5 * (np.eye(2) + 1j * n * quarter)) for n in (1, -1)
    }
