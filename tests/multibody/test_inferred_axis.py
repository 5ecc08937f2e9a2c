"""A spin axis that no one named: taken from the body where it shows it, else asked for."""

import exudyn as exu
import numpy as np
import pytest
from models import STEEL, block_beam, disc_fem, disc_rotor
from point_rotors import free_stiffness

from exudyn_rotor import SolidRotor
from exudyn_rotor.multibody.twins.axis_of_body import axis_at_rest


def rings(count=6, height=0.3, extra=(), seats=2):
    """Return rings of equal masses about z, as seats, and masses (place, kg) beside them."""
    angle = 2.0 * np.pi * np.arange(count) / count
    circle = 0.1 * np.column_stack([np.cos(angle), np.sin(angle), 0.0 * angle])
    levels = np.linspace(-height, height, 3)
    places = [circle + np.array([0.0, 0.0, z]) for z in levels]
    nodes = np.vstack(places + [place for place, _ in extra])
    masses = np.r_[np.ones(3 * count), [mass for _, mass in extra]]
    return SolidRotor.from_matrices(
        np.kron(np.diag(masses), np.eye(3)),
        free_stiffness(nodes, 1e8 * np.eye(nodes.size)),
        nodes,
        "y",
        interfaces={f"seat {i}": np.arange(i * count, (i + 1) * count) for i in range(seats)},
    )


def test_round_body_on_round_seats_shows_its_axis():
    for rotor in (rings(), disc_rotor()):
        np.testing.assert_array_equal(axis_at_rest(rotor).direction, [0.0, 0.0, 1.0])


@pytest.mark.parametrize(
    ("rotor", "reason"),
    [
        # a bar with the bolts of a pendulum at its ends
        (lambda: SolidRotor.from_ngsolve(block_beam(), STEEL, "x"), "'left' is not round"),
        # of square section: its moments of inertia are those of a round one
        (lambda: rings(4), "'seat 0' is not round"),
        (lambda: rings(extra=[((0.5, 0.0, 0.0), 20.0)]), "the centre of mass is"),
        (
            lambda: rings(extra=[((0.2, 0.0, 0.3), 3.0), ((-0.2, 0.0, -0.3), 3.0)]),
            "off a principal axis",
        ),
        (
            lambda: rings(extra=[((0.4, 0.0, 0.0), 3.0), ((-0.4, 0.0, 0.0), 3.0)]),
            "not those of a round body",
        ),
        (lambda: rings(seats=1), "its 1 node sets are not on one line"),
    ],
)
def test_other_bodies_at_rest_are_asked_for_it(rotor, reason):
    with pytest.raises(ValueError, match=rf"axis: is not known: .*{reason}.*give axis="):
        axis_at_rest(rotor())


def test_angular_velocity_shows_the_axis_but_not_its_direction():
    """As on Exudyn's body, the node's angle counts about the positive axis."""
    for sign in (1.0, -1.0):
        mbs = exu.SystemContainer().AddSystem()
        made = mbs.CreateFixedAxisFFRFReducedOrderObject(
            "rotor", disc_fem(), initialAngularVelocity=[0.0, 0.0, 40.0 * sign]
        )
        parts = made["FFRFReducedOrderObjectDict"]
        np.testing.assert_array_equal(parts["rotorBody"].axis.direction, [0.0, 0.0, 1.0])
        mbs.Assemble()
        rates = mbs.GetNodeOutput(parts["nRigidBody"], exu.OutputVariableType.Coordinates_t)
        assert rates[5] == 40.0 * sign
