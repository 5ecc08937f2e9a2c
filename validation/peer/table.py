"""Peer scenes: scripts in Exudyn's manner, with its call and with the swapped one, in one process.

For each scene a row: mesh nodes, modes and markers of the flexible bodies, the largest difference
of what the scene observes over the size of that motion, and the time of the solution with both
calls, the least of some repeats in turns. Where the swapped script warns or fails, the message is
shown; a row without a message must stay below 1e-3. The exit code is 1 if one does not. Bodies are
added by the method of ``mbs``, in scenes with a * by Exudyn's class and its twin.

    python -m validation peer [--quick] [--repeats 3] [scene …]
"""

from __future__ import annotations

import argparse
from dataclasses import dataclass

import numpy as np

from validation.peer import bearings, machines
from validation.peer.scene import ORIGINAL, SWAPPED, Run, Scene, deviation, run

SCENES = (*bearings.SCENES, *machines.SCENES)
LARGEST = 1e-3  # deviation of a scene without a message
SOLVER = "SolverError"  # that Exudyn's solver stopped tells nobody why
QUICK = 0.05  # share of the time that --quick runs


@dataclass(frozen=True)
class Row:
    """One scene, with both calls.

    Attributes
    ----------
    scene : Scene
    original, swapped : Run
        The last of the repeats; their time is the least of all.
    """

    scene: Scene
    original: Run
    swapped: Run

    @property
    def deviation(self) -> float:
        """Largest difference over the size of the motion; NaN where a run failed."""
        if not (self.original.histories and self.swapped.histories):
            return np.nan
        return deviation(self.original, self.swapped)

    @property
    def messages(self) -> tuple[str, ...]:
        """What the user of the swapped call is told and that of the other is not."""
        return tuple(text for text in self.swapped.messages if text not in self.original.messages)

    @property
    def holds(self) -> bool:
        """Whether the original runs, and the swapped call agrees or says something."""
        if not self.original.histories:
            return False
        clear = [text for text in self.messages if SOLVER not in text]
        return bool(clear) or self.deviation < LARGEST

    def text(self) -> str:
        """Return the row of the table, and below it the messages."""
        first, second = self.original, self.swapped
        name = self.scene.name + " *" * self.scene.by_class
        times = f"{1e3 * first.seconds:7.0f} {1e3 * second.seconds:7.0f}"
        line = (
            f"{name:39} {first.nodes:5} {first.modes:5}  "
            f"{first.markers:21} "
            f"{self.deviation:9.1e} {times} {first.seconds / second.seconds:6.2f}"
            f"{'' if self.holds else '  !'}"
        )
        cause = [f"    cause: {self.scene.note}"] if self.scene.note else []
        return "\n".join([line, *(f"    says: {text}" for text in self.messages), *cause])


def measured(scene: Scene, fraction: float = 1.0, repeats: int = 1) -> Row:
    """Run a scene with both calls in turns and take the least time of each."""
    pairs = [
        (run(scene, ORIGINAL, fraction), run(scene, SWAPPED, fraction)) for _ in range(repeats)
    ]
    first, second = pairs[-1]
    least = np.min([[a.seconds, b.seconds] for a, b in pairs], axis=0)
    return Row(scene, _timed(first, least[0]), _timed(second, least[1]))


def _timed(one: Run, seconds: float) -> Run:
    return Run(one.histories, seconds, one.nodes, one.modes, one.markers, one.messages)


def main() -> int:
    """Print the table."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("scenes", nargs="*", help="parts of names; all scenes by default")
    parser.add_argument("--quick", action="store_true", help="few steps, no repeats")
    parser.add_argument("--repeats", type=int, default=3, help="of which the least time is taken")
    given = parser.parse_args()
    chosen = [
        scene
        for scene in SCENES
        if not given.scenes or any(part in scene.name for part in given.scenes)
    ]
    print(
        f"{'scene':39} {'nodes':>5} {'modes':>5}  {'markers':21} {'deviation':>9} "
        f"{'ms':>7} {'swapped':>7} {'ratio':>6}"
    )
    rows = []
    for scene in chosen:
        rows.append(
            measured(scene, QUICK) if given.quick else measured(scene, repeats=given.repeats)
        )
        print(rows[-1].text(), flush=True)
    ratios = [row.original.seconds / row.swapped.seconds for row in rows if row.swapped.histories]
    silent = [row.scene.name for row in rows if not row.holds]
    if ratios:
        print(f"\nspeed ratio: least {min(ratios):.2f}, median {np.median(ratios):.2f}")
    print(f"without a message and above {LARGEST:g}: {', '.join(silent) or 'none'}")
    return int(bool(silent))
