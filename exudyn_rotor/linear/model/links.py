"""What connects two rotors of a train: bearings between shafts, springs of torsion, gears."""

from __future__ import annotations

from collections.abc import Mapping
from dataclasses import dataclass

import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.bearings.bearing import bearing_of
from exudyn_rotor.bearings.rolling import RollingBearing
from exudyn_rotor.bearings.support import Support
from exudyn_rotor.drives.gear_mesh import GearMesh

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

    def _check_ratios(self, ratios: Mapping[str, float]) -> None:
        """Refuse gears whose speeds are not in the ratio of their radii.

        Raises
        ------
        ValueError
        """
        if not isinstance(self.connection, GearMesh):
            return
        first, second = (ratios[rotor] for rotor, _ in self.ends)
        radii = self.connection.radii
        slip = radii @ [first, second]
        if abs(slip) > _SAME * np.abs(radii * [first, second]).max():
            raise ValueError(
                f"ratios: gears of radii {radii[0]:g} and {radii[1]:g} m turn with {first:g} and "
                f"{-first * radii[0] / radii[1]:.9g}, not {second:g}, times the speed: "
                f"{self.first} – {self.second}"
            )


def _end(name: str, label: str) -> tuple[str, str]:
    rotor, colon, interface = checks.label(name, label).partition(":")
    if not (rotor and colon and interface):
        raise ValueError(f"{label}: needs 'rotor:interface', got {name!r}")
    return rotor, interface
