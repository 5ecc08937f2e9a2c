"""What stands between several rotors and the ground, as terms in axes that turn with the speed Ω.

An element has stiffness K and damping D of the motion x of its ends, in axes (n1, n2, e) that turn
with sΩ: s = 0 where it stands still. The coordinates are seen in axes that turn with Ω, so that
``x = R(wθ) u``, w = 1 − s, and

    K → Rᵀ K R + wΩ Rᵀ D R ẽ,    D → Rᵀ D R.
"""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass, replace

import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.bearings.bearing import bearing_of
from exudyn_rotor.bearings.rolling import RollingBearing
from exudyn_rotor.bearings.support import Support
from exudyn_rotor.drives.gear_mesh import GearMesh
from exudyn_rotor.linear.models.fourier_terms import turned_terms
from exudyn_rotor.linear.periodic.periodic_system import Terms
from exudyn_rotor.theory.rotating_axes import axial_skew

_SAME = 1e-9  # relative slip of gears that is rounding


@dataclass(frozen=True, eq=False)
class Link:
    """What connects two rotors: an inter-shaft bearing, a spring of their torsion, a gear mesh.

    Parameters
    ----------
    first, second : str
        Interfaces as 'rotor:interface'.
    connection : Support or GearMesh
        A support is at the interface of the first rotor and stands on the second instead of on the
        ground: it acts on the difference of the two motions along (n1, n2, e), which are parallel
        for all rotors. A tilt stiffness (3, 3) holds the torsion by its last entry. Tables are
        over the relative speed of the rotors; frame 'rotor' is that of the first.

    Raises
    ------
    TypeError, ValueError
        For names without a colon, two ends of one rotor, a support at another interface, a gear
        mesh with backlash or a stiffness that follows the teeth, and what ``linearised()`` of a
        bearing gives, unless that is a `RollingBearing`.

    Examples
    --------
    >>> from exudyn_rotor import Link, Support
    >>> Link("LP:rear", "HP:rear", Support("rear", 2e7, damping=500.0)).ends
    (('LP', 'rear'), ('HP', 'rear'))
    """

    first: str
    second: str
    connection: Support | GearMesh

    def __post_init__(self) -> None:
        (rotor, interface), (other, _) = self.ends
        checks.instance(self.connection, "connection", (Support, GearMesh))
        law, bearing = self.connection, bearing_of(self.connection)
        if bearing is not None and not isinstance(bearing, RollingBearing):
            raise ValueError(
                f"connection: the coefficients of a {type(bearing).__name__} hold on what does not "
                "turn; give those between two rotors as a table over Ω1 − Ω2. A journal in a round "
                "bore has there what it has in a bore at rest at the speed Ω1 + Ω2"
            )
        if isinstance(law, GearMesh) and (law.backlash is not None or law.variation.size):
            raise ValueError(
                "connection: a GearMesh with backlash, or with a stiffness that follows the teeth, "
                "is not linear; give one without backlash= and variation=, of the mean stiffness"
            )
        if isinstance(self.connection, Support) and self.connection.interface != interface:
            raise ValueError(
                f"connection: is at {self.connection.interface!r}, and the first end of the link "
                f"at {self.first!r}; give a Support({interface!r}, …)"
            )
        if rotor == other:
            raise ValueError(
                f"second: {self.second!r} is of the same rotor as {self.first!r}; a link is "
                "between two"
            )

    @property
    def ends(self) -> tuple[tuple[str, str], tuple[str, str]]:
        """Rotor and interface of both ends."""
        return _end(self.first, "first"), _end(self.second, "second")


def _end(name: str, label: str) -> tuple[str, str]:
    rotor, colon, interface = checks.label(name, label).partition(":")
    if not (rotor and colon and interface):
        raise ValueError(f"{label}: needs 'rotor:interface', got {name!r}")
    return rotor, interface


@dataclass(frozen=True, eq=False)
class Element:
    """A support or a link of a train.

    Attributes
    ----------
    ends : tuple of (str, str)
        Rotor and interface: one, or two for a link.
    connection : Support or GearMesh
    turns : float
        s, by which its axes turn.
    rate : float
        Speed over which its tables are, per Ω.
    frame : {1.0, 0.0}
        Whether the axes it is seen from turn with Ω, or stand still: w = 1 − s or −s.
    """

    ends: tuple[tuple[str, str], ...]
    connection: Support | GearMesh
    turns: float
    rate: float
    frame: float = 1.0

    @classmethod
    def of_support(cls, rotor: str, ratio: float, support: Support) -> Element:
        """Return a support of a rotor on the ground."""
        turns = ratio if support.frame == "rotor" else 0.0
        return cls(((rotor, support.interface),), support, turns, ratio)

    @classmethod
    def of_link(cls, link: Link, ratios: Mapping[str, float]) -> Element:
        """Return a link between two rotors.

        Raises
        ------
        ValueError
            For gears whose speeds are not in the ratio of their radii.
        """
        first, second = (ratios[rotor] for rotor, _ in link.ends)
        given = link.connection
        if isinstance(given, Support):
            turns = first if given.frame == "rotor" else 0.0
            return cls(link.ends, given, turns, first - second)
        slip = given.radii @ [first, second]
        if abs(slip) > _SAME * np.abs(given.radii * [first, second]).max():
            raise ValueError(
                f"ratios: gears of radii {given.radii[0]:g} and {given.radii[1]:g} m turn with "
                f"{first:g} and {-first * given.radii[0] / given.radii[1]:.9g}, not {second:g}, "
                f"times the speed: {link.first} – {link.second}"
            )
        return cls(link.ends, given, 0.0, first)

    @property
    def what(self) -> str:
        """The element, for messages."""
        return " – ".join(map(":".join, self.ends))

    @property
    def varies(self) -> bool:
        """True when a coefficient depends on the speed."""
        return isinstance(self.connection, Support) and self.connection.varies

    @property
    def stiffness_varies(self) -> bool:
        """True when a stiffness depends on the speed."""
        return isinstance(self.connection, Support) and self.connection.stiffness_varies

    @property
    def table_speeds(self) -> np.ndarray:
        """Ω at the points of its tables [rad/s]."""
        if not isinstance(self.connection, Support) or not self.rate:
            return np.zeros(0)
        return self.connection.table_speeds / self.rate

    def matrices(self, speed: float) -> tuple[np.ndarray, np.ndarray]:
        """Return stiffness and damping of the motion of the ends at Ω, in the element's axes."""
        if isinstance(self.connection, Support):
            self._check_range(self.rate * speed)
        return self._matrices(speed)

    def _check_range(self, rate: float) -> None:
        """Refuse a speed beyond a table; that of a link is the first rotor's less the second's."""
        try:
            self.connection.check_range(rate)
        except ValueError as error:
            if len(self.ends) == 1:
                raise
            (first, _), (second, _) = self.ends
            raise type(error)(  # no equilibrium is told from a speed beyond a table
                f"{error}; it is the speed of {first!r} less that of {second!r}, which the other "
                "order of the link's ends turns round"
            ) from None

    def undamped(self) -> Element:
        """Return it as :meth:`Support.undamped`; gears as they are."""
        given = self.connection
        return replace(self, connection=given.undamped()) if isinstance(given, Support) else self

    @property
    def at_rest(self) -> np.ndarray:
        """Stiffness at rest."""
        return self._matrices(0.0)[0]

    def _matrices(self, speed: float) -> tuple[np.ndarray, np.ndarray]:
        if isinstance(self.connection, Support):
            sides = [[1.0]] if len(self.ends) == 1 else [[1.0, -1.0], [-1.0, 1.0]]
            both = self.connection.matrices(self.rate * speed)
            return tuple(np.kron(sides, X) for X in both)
        return self.connection.matrices()

    def parts(self, speed: float) -> tuple[Terms, Terms, Terms]:
        """Return Fourier terms of damping, stiffness, and stiffness per Ω, seen with Ω."""
        stiffness, damping = self.matrices(speed)
        turning = self.drift * damping @ axial_skew(len(damping))
        return self._turned(damping), self._turned(stiffness), self._turned(turning)

    @property
    def drift(self) -> float:
        """w."""
        return self.frame - self.turns

    def check(self) -> None:
        """Refuse directions in which the equations do not repeat with θ."""
        for X in self._matrices(0.0):
            self._turned(X)

    def _turned(self, X: np.ndarray) -> dict[int, np.ndarray]:
        return turned_terms(X, self.drift, self.what)
