"""What the columns of a reduced basis are, and what they hold at interfaces and mesh nodes."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass
from enum import Enum

import numpy as np

from exudyn_rotor import checks


class ModeKind(Enum):
    """What a column of a reduced basis is; the value names it for people.

    The translations and tilts 1 and 2 are along and about n1 and n2 of
    :attr:`exudyn_rotor.SpinAxis.plane`, rotations about an axis through the centre of mass.

    Examples
    --------
    >>> [kind.value for kind in ModeKind if kind.is_tilt]
    ['tilt 1', 'tilt 2']
    """

    TRANSLATION_1 = "translation 1"
    TRANSLATION_2 = "translation 2"
    AXIAL = "translation along axis"
    SPIN = "spin"
    TILT_1 = "tilt 1"
    TILT_2 = "tilt 2"
    FREE = "free motion"  # any rigid motion that a grounded rotor still has
    ELASTIC = "mode"

    @property
    def is_tilt(self) -> bool:
        """True for the two tilts."""
        return self in (ModeKind.TILT_1, ModeKind.TILT_2)


# in the order of the columns of every rotor that nothing holds
RIGID_KINDS = tuple(kind for kind in ModeKind if kind not in (ModeKind.FREE, ModeKind.ELASTIC))


def rigid_names(kinds: Sequence[ModeKind]) -> tuple[str, ...]:
    """Return the names of rigid motions; those of a grounded rotor are numbered."""
    return tuple(
        f"{kind.value} {number}" if kind is ModeKind.FREE else kind.value
        for number, kind in enumerate(kinds, start=1)
    )


@dataclass(frozen=True, eq=False)
class ReducedInterface:
    """Mean motion of an interface in the reduced basis.

    Attributes
    ----------
    reference, center : ndarray, shape (3,)
        Point whose motion is reported, and weighted centre of the nodes, mesh coordinates [m].
    radius : float
        Root mean square radius of the nodes [m].
    motion : ndarray, shape (6, k)
        Displacement of the reference point and rotation vector per column, mesh axes.

    Raises
    ------
    TypeError, ValueError
        If shapes do not fit, an entry is not finite, or the radius is negative.
    """

    reference: np.ndarray
    center: np.ndarray
    radius: float
    motion: np.ndarray

    def __post_init__(self) -> None:
        checks.keep(
            self,
            reference=checks.vector(self.reference, "interface: reference", "m"),
            center=checks.vector(self.center, "interface: center", "m"),
            radius=checks.number(self.radius, "interface: radius", "m", least=0.0),
            motion=checks.array(self.motion, "interface: motion", shape=(6, None)),
        )


@dataclass(frozen=True, eq=False)
class ModeShapes:
    """Mode shapes at mesh nodes, for sensors and drawing.

    Attributes
    ----------
    nodes : ndarray, shape (n, 3)
        Reference positions, mesh coordinates [m].
    matrix : ndarray, shape (3n, k)
        Displacement columns, mesh axes.
    triangles : ndarray of int, shape (t, 3) or (t, 6)
    stress : ndarray or None, shape (n, 6, k)
        Stress columns xx, yy, zz, yz, xz, xy, mesh axes [Pa].

    Raises
    ------
    TypeError, ValueError
        If shapes do not fit, an entry is not finite, or a triangle names a node that is not there.
    """

    nodes: np.ndarray
    matrix: np.ndarray
    triangles: np.ndarray
    stress: np.ndarray | None = None

    def __post_init__(self) -> None:
        nodes = checks.array(self.nodes, "shapes: nodes", "m", shape=(None, 3))
        matrix = checks.array(self.matrix, "shapes: matrix", shape=(nodes.size, None))
        triangles = checks.array(self.triangles, "shapes: triangles", shape=(None, None), dtype=int)
        if triangles.shape[1] not in (3, 6):
            raise ValueError(f"shapes: triangles need 3 or 6 nodes, got {triangles.shape[1]}")
        if triangles.size and not 0 <= triangles.min() <= triangles.max() < len(nodes):
            raise ValueError(
                f"shapes: triangles need nodes 0 to {len(nodes) - 1}, got {triangles.min()} to "
                f"{triangles.max()}"
            )
        stress = self.stress
        if stress is not None:
            shape = (len(nodes), 6, matrix.shape[1])
            stress = checks.array(stress, "shapes: stress", "Pa", shape=shape)
        checks.keep(self, nodes=nodes, matrix=matrix, triangles=triangles, stress=stress)


@dataclass(frozen=True, eq=False)
class Centrifugal:
    """Static fields about which the rotor vibrates; all of them, not modes only.

    Attributes
    ----------
    displacement : ndarray or None, shape (3n,)
        Per ω², mesh axes [m s²].
    stress : ndarray or None, shape (n, 6)
        Per ω² at the nodes, components xx, yy, zz, yz, xz, xy, mesh axes [Pa s²].
    yield_stress : float or None
        Yield stress of the material [Pa].
    constant_stress : ndarray or None, shape (n, 6)
        Stress at rest, which does not depend on the speed, components as in `stress` [Pa].

    Raises
    ------
    TypeError, ValueError
        If shapes do not fit, an entry is not finite, or the yield stress is not positive.
    """

    displacement: np.ndarray | None = None
    stress: np.ndarray | None = None
    yield_stress: float | None = None
    constant_stress: np.ndarray | None = None

    def __post_init__(self) -> None:
        fields = {}
        if self.displacement is not None:
            name = "centrifugal: displacement"
            fields["displacement"] = checks.vector(self.displacement, name, "m s²", size=None)
        for name in ("stress", "constant_stress"):
            if getattr(self, name) is not None:
                values = checks.array(getattr(self, name), f"centrifugal: {name}", shape=(None, 6))
                fields[name] = values
        if self.yield_stress is not None:
            name = "centrifugal: yield_stress"
            fields["yield_stress"] = checks.number(self.yield_stress, name, "Pa", above=0.0)
        checks.keep(self, **fields)

    def stress_at(self, speed: float) -> np.ndarray | None:
        """Return the static stress at a spin speed [rad/s], with that at rest, (n, 6) [Pa].

        None where the stress per ω² is not known.
        """
        speed = checks.number(speed, "speed", "rad/s")
        if self.stress is None:
            return None
        by_spin = speed**2 * self.stress
        return by_spin if self.constant_stress is None else self.constant_stress + by_spin
