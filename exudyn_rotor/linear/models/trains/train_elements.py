"""What acts on the rotors of a train: supports and links, and those with coordinates of their own.

Elements stand in the order supports, links, then two for each support with coordinates of its own
(:mod:`.own_coordinates`): where it acts, the stiffness that acts without these, and nothing where
its sensors are.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import replace

from exudyn_rotor.bearings.given import linear_supports
from exudyn_rotor.linear.models.links import Element
from exudyn_rotor.linear.models.rotor.own_coordinates import OwnCoordinates, in_order, places
from exudyn_rotor.linear.models.rotor.rotor_on_supports import LinearRotor
from exudyn_rotor.linear.models.rotor.spin import Spin, rotations_of_reduced
from exudyn_rotor.linear.models.trains.rotor_train import RotorTrain


def elements_of(train: RotorTrain) -> tuple[tuple[Element, ...], OwnCoordinates]:
    """Return the elements of a train, and the coordinates that some of them bring.

    Raises
    ------
    ValueError
        For a bearing without the load that it needs, and for directions in which the equations do
        not repeat with θ.
    """
    plain, own = [], []
    for name, given in train.supports.items():
        linear, controlled = linear_supports(given)
        plain += [(name, one) for one in linear]
        own += [(name, one) for one in controlled]
    own = in_order(own, lambda each: each[1])
    pairs = [(name, each) for name, one in own for each in places(one, one.direct_stiffness)]
    elements = [Element.of_support(name, train.ratios[name], one) for name, one in plain]
    elements += [Element.of_link(link, train.ratios) for link in train.links]
    elements += [Element.of_support(name, train.ratios[name], one) for name, one in pairs]
    for element in elements:
        element.check()
    rates = tuple(train.ratios[name] for name, _ in own)
    return tuple(elements), OwnCoordinates(tuple(one for _, one in own), rates)


def place_of(index: int, elements: Sequence[Element], own: OwnCoordinates) -> int:
    """Return where the two elements of a support with coordinates of its own are."""
    return len(elements) - 2 * len(own.supports) + 2 * index


def held_elements(elements: Sequence[Element], own: OwnCoordinates) -> tuple[Element, ...]:
    """Return elements of which those with coordinates of their own have their static stiffness."""
    held = list(elements)
    for index, one in enumerate(own.supports):
        place = place_of(index, elements, own)
        slow, _ = places(one, one.static_stiffness)
        held[place] = replace(held[place], connection=slow)
    return tuple(held)


def places_of(name: str, elements: Sequence[Element]) -> tuple[str, ...]:
    """Return the interfaces of a rotor that elements act on."""
    return tuple(at for element in elements for owner, at in element.ends if owner == name)


def check_rotor(name: str, alone: LinearRotor, elements: Sequence[Element]) -> None:
    """Refuse what the equations of several rotors do not have.

    Raises
    ------
    ValueError
    """
    if alone.has_structural_damping:
        raise ValueError(
            f"rotors[{name!r}]: has structural damping, which is for responses of one rotor; give "
            "damping by mass= and stiffness="
        )
    if alone.spin is None:
        return
    on_ground = [e for e in elements if len(e.ends) == 1 and e.ends[0][0] == name]
    supports = [element.connection for element in on_ground]
    motions = [alone.interface_motion(support.interface) for support in supports]
    given = rotations_of_reduced(alone.rotor), supports, motions
    if Spin.of(*given, alone.invariants, alone.rotor.axis).coupled:
        raise ValueError(
            f"supports[{name!r}]: hold the spin by an arm off the axis, or turn with the rotor and "
            "hold its torsion, which is for analyses of one rotor"
        )
