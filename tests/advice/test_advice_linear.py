"""What a proposal says of modes that are missing, against a rotor with many more."""

import numpy as np
import pytest
from models import centered_disc

from exudyn_rotor import Support, craig_bampton_modes, unbalance_response
from exudyn_rotor.advice.candidate import Candidate
from exudyn_rotor.advice.mode_choice import GROWTH, Response


@pytest.mark.parametrize("stiffness", [1e7, 1e8])
def test_what_modes_miss_of_the_response_to_unbalance_is_the_error_of_that(stiffness):
    """An eccentric rotor at 300 rad/s against one with 80 modes.

    The load, the last, is at rest in the rotor frame. It grows by 0.05 Ω there, which adds 5 % to
    the stiffness of supports by their damping.
    """
    solid = centered_disc().add_point_mass([0.15, 0, 0.215], 0.05)
    reduced, speed = solid.reduce(craig_bampton_modes(solid, 12, coupling="RBE3")), 300.0
    springs = stiffness * np.eye(3)
    supports = [Support(name, springs, springs / speed) for name in ("left", "right")]
    given = Candidate.of(reduced, supports)
    s = complex(GROWTH * speed)
    found, attached = (
        Response(one, speed, s).motion[:, -1] for one in (given, given.with_attachments())
    )
    many = solid.reduce(craig_bampton_modes(solid, 80, coupling="RBE3"))
    full, ours = (
        unbalance_response(r, [speed], supports=supports, accuracy=None).motion[..., :3].ravel()
        for r in (many, reduced)
    )
    error = np.linalg.norm(ours - full) / np.linalg.norm(full)
    missing = np.linalg.norm(found - attached) / np.linalg.norm(attached)
    assert missing == pytest.approx(error, rel=0.1)
