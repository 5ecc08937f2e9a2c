"""Scripts in Exudyn's manner run with the swapped call as with Exudyn's own."""

import numpy as np
import pytest

from validation.peer import bearings, machines, table
from validation.peer.scene import ORIGINAL, SWAPPED, Run, Scene, run

NAMES = [scene.name for scene in table.SCENES]


def scene(name: str) -> Scene:
    return table.SCENES[NAMES.index(name)]


def test_scenes_are_many_and_have_names_of_their_own():
    assert len(set(NAMES)) == len(NAMES) >= 15
    assert sum(one.by_class for one in table.SCENES) >= 6
    assert {one.name for one in (*bearings.SCENES, *machines.SCENES)} == set(NAMES)


# the step's error is the same in both but for O(h²) of the phase, and the tilt is below 1e-3
@pytest.mark.parametrize(
    "name", ["rigid markers on springs, z", "markers of the call with offset, z"]
)
def test_swapped_script_moves_like_the_original(name):
    row = table.measured(scene(name), fraction=0.03)
    assert row.holds, row.text()
    assert not row.messages
    assert row.deviation < 1e-3


def test_row_that_deviates_in_silence_does_not_hold():
    still = np.zeros((3, 3))
    moving = still + np.arange(3.0)[:, None]
    first = Run([moving], 1.0)
    one = scene("pendulum")
    assert table.Row(one, first, first).holds
    assert not table.Row(one, first, Run([1.1 * moving], 1.0)).holds
    assert table.Row(one, first, Run([1.1 * moving], 1.0, messages=("axis turned",))).holds
    assert not table.Row(one, first, Run([], np.nan, messages=("SolverError: stopped",))).holds


def test_error_of_a_call_is_what_the_user_sees():
    def wrong(script):
        script.flexible(machines.parts.bar(), axis="z", gravity="down")

    found = run(Scene("wrong", wrong, 0.1, 0.1), SWAPPED)
    assert not found.histories
    assert "gravity" in found.messages[-1]
    assert ORIGINAL != SWAPPED
