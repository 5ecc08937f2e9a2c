"""Two and more rotors whose speeds are in fixed ratios, on supports and linked to each other."""

from __future__ import annotations

from collections.abc import Mapping, Sequence
from dataclasses import dataclass, field, replace

import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.bearings.bearing import bearing_of
from exudyn_rotor.bearings.given import Given, check_interfaces, given_supports
from exudyn_rotor.bearings.rolling import RollingBearing
from exudyn_rotor.bearings.support import Support
from exudyn_rotor.drives.gear_mesh import GearMesh
from exudyn_rotor.linear.model.body import EVEN
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor

_EVEN_ENOUGH = 0.05  # unevenness up to which one of several rotors counts as round
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
        """Refuse gears whose speeds are not in the ratio of their radii."""
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


@dataclass(frozen=True, eq=False)
class RotorTrain:
    """Rotors whose speeds are in fixed ratios: what linear analyses take in place of a rotor.

    Parameters
    ----------
    rotors : mapping of str to ReducedRotor
        By names without a colon; interfaces are then 'rotor:interface'. The axes (n1, n2, e) of
        :attr:`SpinAxis.plane` are parallel for all rotors, whatever the axes of their meshes are.
    ratios : mapping of str to float
        Speed of each rotor over the speed Ω of the analysis, not 0; negative for one that turns
        the other way. Results are seen from axes that turn with Ω, 'forward' is in its sense.
    supports : mapping of str to sequence of Support or bearings, optional
        Of each rotor on the ground; bearings and tables at its own speed, magnetic bearings and
        pads with their coordinates.
    links : sequence of Link, optional
        Between rotors.
    largest_unevenness : float, optional
        Share of a rotor's matrices, and of the motions of its interfaces, that may differ around
        the axis, as that of a mesh does; weighted by what slow motions see. Up to it a rotor of
        another ratio than 1, or any beside gears or anisotropic supports at rest, counts as
        axisymmetric, by its mean over a turn. 0.05 by default, of one rotor alone 0.01 as without a
        train.
    driven : sequence of str, optional
        Rotors whose drive holds their speed: the mean rotation about the axis is the angle of Ω
        times the ratio, and no coordinate. The spins of all others are, and what nothing holds of
        them is free.

    Raises
    ------
    TypeError, ValueError
        For unknown names and bad numbers, and for gears of other ratios. Analyses refuse rotors,
        supports and links that are uneven where the equations do not repeat with the angle of Ω.

    Notes
    -----
    Unbalance, the rotors' own included, is that of rotors of ratio 1: :meth:`relative_to` makes the
    speed of another rotor that of the analysis.

    The mean over a turn leaves an error of frequencies of the order of the square of the
    unevenness. Frequencies of motions with more than four nodal diameters are those in the frame of
    their rotor.

    Examples
    --------
    Two rigid rotors, one of which turns 1.5 times as fast, on a spring between them:

    >>> import numpy as np
    >>> from exudyn_rotor import Link, RotorTrain, SolidRotor, Support, critical_speeds
    >>> rod = 1e9 * np.kron([[1, -1], [-1, 1]], np.diag([0.0, 0.0, 1.0]))
    >>> nodes = [[0.0, 0.0, -0.1], [0.0, 0.0, 0.1]]  # two masses of 2 kg on a rod
    >>> rotor = SolidRotor.from_matrices(2.0 * np.eye(6), rod, nodes, "z")
    >>> rotor = rotor.with_interface("left", [0]).with_interface("right", [1]).reduce(1)
    >>> springs = [Support(name, 2e4) for name in ("left", "right")]
    >>> links = [Link(f"LP:{n}", f"HP:{n}", Support(n, 3e4)) for n in ("left", "right")]
    >>> ratios = {"LP": 1.0, "HP": 1.5}
    >>> train = RotorTrain({"LP": rotor, "HP": rotor}, ratios, {"LP": springs}, links)
    >>> critical_speeds(train, nodal_diameters=[1]).speeds[::4].round(2)
    array([ 64.72, 189.24])
    """

    rotors: Mapping[str, ReducedRotor]
    ratios: Mapping[str, float]
    supports: Mapping[str, Sequence[Given]] = field(default_factory=dict)
    links: Sequence[Link] = ()
    largest_unevenness: float | None = None
    driven: Sequence[str] = ()

    def __post_init__(self) -> None:
        rotors = _checked_rotors(self.rotors)
        ratios = _checked_ratios(self.ratios, rotors)
        supports = {}
        given_for = checks.mapping(self.supports, "supports", "sequence of Support", rotors)
        for name, given in given_for.items():
            supports[name] = given_supports(given)
            check_interfaces(supports[name], rotors[name].interfaces)
        links = checks.instances(self.links, "links", Link)
        for link in links:
            for name, interface in link.ends:
                checks.choice(name, "links", rotors)
                checks.choice(interface, f"links: interface of {name!r}", rotors[name].interfaces)
            link._check_ratios(ratios)
        driven = checks.labels(self.driven, "driven", rotors)
        uneven = self.largest_unevenness
        if uneven is None:
            uneven = EVEN if len(rotors) == 1 else _EVEN_ENOUGH
        uneven = checks.number(uneven, "largest_unevenness", least=0.0, most=1.0)
        named = {"rotors": rotors, "ratios": ratios, "supports": supports}
        checks.keep(self, **{name: checks.read_only_mapping(each) for name, each in named.items()})
        checks.keep(self, links=links, largest_unevenness=uneven, driven=driven)

    def relative_to(self, rotor: str) -> RotorTrain:
        """Return the train for analyses over the speed of one of its rotors, whose ratio is 1.

        Where that rotor turns the other way, so do all speeds: a positive speed is then the
        reverse of a positive speed before.

        Parameters
        ----------
        rotor : str

        Raises
        ------
        TypeError, ValueError
            For an unknown name.
        """
        checks.choice(rotor, "rotor", self.rotors)
        unit = self.ratios[rotor]
        ratios = {name: 1.0 if name == rotor else r / unit for name, r in self.ratios.items()}
        return replace(self, ratios=ratios)


def _checked_rotors(given: Mapping[str, ReducedRotor]) -> Mapping[str, ReducedRotor]:
    rotors = checks.mapping(given, "rotors", "ReducedRotor")
    if not rotors:
        raise ValueError("rotors: needs at least one rotor, got none")
    for name, rotor in rotors.items():
        if ":" in checks.label(name, "rotors"):
            raise ValueError(f"rotors: needs names without a colon, got {name!r}")
        how = "reduce a SolidRotor by its method reduce(…)"
        checks.instance(rotor, f"rotors[{name!r}]", ReducedRotor, how)
    return rotors


def _checked_ratios(
    given: Mapping[str, float], rotors: Mapping[str, ReducedRotor]
) -> dict[str, float]:
    """Return the ratios in the order of the rotors."""
    ratios = checks.mapping(given, "ratios", "float")
    if set(ratios) != set(rotors):
        raise ValueError(
            f"ratios: needs one for each of the rotors {list(rotors)}, got {list(ratios)}"
        )
    ratios = {name: checks.number(ratios[name], f"ratios[{name!r}]") for name in rotors}
    if not all(ratios.values()):
        raise ValueError(
            f"ratios: needs numbers other than 0, got {ratios}; give a rotor that stands still "
            "as a foundation"
        )
    return ratios
