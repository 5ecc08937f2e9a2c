"""Savers of one file that are killed, and savers beside a reader: no file may be lost.

Pairs of processes save to one path without pause and are killed at random moments; after each
pair the file must be there and whole. Then three savers run beside a reader, each of whose loads
must succeed. Prints a table; the exit code is 1 if a file was lost or could not be read.

    python -m validation savers [pairs] [seconds]
"""

from __future__ import annotations

import argparse
import multiprocessing
import tempfile
import time
from dataclasses import dataclass
from multiprocessing.context import BaseContext
from pathlib import Path

import numpy as np

from exudyn_rotor.storage import read_arrays, write_arrays

KIND = "trial"
SIZE = 40_000  # numbers in a file: a save takes some milliseconds, about half of it compression
LONGEST = 0.06  # s until a saver is killed
SEED = 7


@dataclass
class Outcome:
    """Counts of one trial."""

    saves: int = 0
    loads: int = 0
    lost: int = 0
    unreadable: int = 0
    drafts: int = 0

    @property
    def failed(self) -> bool:
        """Whether a file was lost, or a load failed."""
        return self.lost + self.unreadable > 0


def content(saver: int, count: int) -> dict[str, np.ndarray]:
    """Return what a saver writes the `count`-th time: every array tells who and when."""
    values = np.random.default_rng([saver, count]).normal(size=SIZE)
    return {"who": np.array([saver, count]), "values": values, "sum": np.array([values.sum()])}


def check(path: Path) -> None:
    """Load the file, and compare all of it with what its saver wrote.

    Raises
    ------
    OSError, ValueError
        If the file is not there or not whole, or mixes what two savers wrote.
    """
    data = read_arrays(path, KIND)
    expected = content(*data["who"])
    if any(not np.array_equal(data[name], value) for name, value in expected.items()):
        raise ValueError(f"{path}: mixes what two savers wrote")


def save_for_ever(path: Path, saver: int, started, saves) -> None:
    """Save without pause; to be killed."""
    count = 0
    while True:
        write_arrays(path, KIND, content(saver, count))
        count += 1
        saves[saver] = count
        started.set()


def context() -> BaseContext:
    """Return processes that start fast: forked from a server that has loaded the package."""
    if "forkserver" not in multiprocessing.get_all_start_methods():
        return multiprocessing.get_context("spawn")
    found = multiprocessing.get_context("forkserver")
    found.set_forkserver_preload(["exudyn_rotor.storage"])
    return found


class Savers:
    """Savers of one path; all are killed at the end."""

    def __init__(self, path: Path, count: int) -> None:
        made = context()
        self.saves = made.RawArray("q", count)  # without a lock, which a killed saver would keep
        self.processes = []
        self._started = [made.Event() for _ in range(count)]
        for saver, started in enumerate(self._started):
            arguments = (path, saver, started, self.saves)
            self.processes.append(made.Process(target=save_for_ever, args=arguments, daemon=True))

    def __enter__(self) -> Savers:
        for process in self.processes:
            process.start()
        for started in self._started:
            if not started.wait(60.0):
                raise RuntimeError("a saver did not start")
        return self

    def __exit__(self, *_: object) -> None:
        for process in self.processes:
            process.kill()
            process.join()


def killed_pairs(folder: Path, pairs: int) -> Outcome:
    """Kill pairs of savers at random moments; look at the file after each."""
    path, outcome = folder / "u.npz", Outcome()
    random = np.random.default_rng(SEED)
    for _ in range(pairs):
        write_arrays(path, KIND, content(9, 0))
        with Savers(path, 2) as savers:
            for process in savers.processes:
                time.sleep(random.uniform(0.0, LONGEST))
                process.kill()
                process.join()
            outcome.saves += sum(savers.saves)
        outcome.loads += 1
        if not path.exists():
            outcome.lost += 1
            continue
        try:
            check(path)
        except (OSError, ValueError):
            outcome.unreadable += 1
    outcome.drafts = len(list(folder.glob("u.npz.*.draft")))
    return outcome


def beside_a_reader(folder: Path, seconds: float) -> Outcome:
    """Read without pause beside three savers."""
    path, outcome = folder / "r.npz", Outcome()
    write_arrays(path, KIND, content(9, 0))
    with Savers(path, 3) as savers:
        end = time.monotonic() + seconds
        while time.monotonic() < end:
            outcome.loads += 1
            try:
                check(path)
            except FileNotFoundError:
                outcome.lost += 1
            except (OSError, ValueError):
                outcome.unreadable += 1
        outcome.saves = sum(savers.saves)
    outcome.drafts = len(list(folder.glob("r.npz.*.draft")))
    return outcome


def main() -> int:
    """Run both trials, print the table, return the exit code."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("pairs", type=int, nargs="?", default=40, help="of savers that are killed")
    parser.add_argument("seconds", type=float, nargs="?", default=20.0, help="beside a reader")
    options = parser.parse_args()
    pairs, seconds = options.pairs, options.seconds
    with tempfile.TemporaryDirectory() as name:
        folder = Path(name)
        own = folder / "u.npz.part"  # a file of the user's that looks like a draft
        own.write_text("mine")
        rows = {
            f"{pairs} pairs of savers killed": killed_pairs(folder, pairs),
            "three savers beside a reader": beside_a_reader(folder, seconds),
        }
        kept = own.read_text() == "mine"
    print(f"{'':32s}{'saves':>8s}{'loads':>8s}{'lost':>8s}{'unreadable':>12s}{'drafts left':>13s}")
    for label, row in rows.items():
        counts = f"{row.saves:8d}{row.loads:8d}{row.lost:8d}{row.unreadable:12d}{row.drafts:13d}"
        print(f"{label:32s}{counts}")
    print(f"another file with the suffix .part: {'left alone' if kept else 'LOST'}")
    return int(any(row.failed for row in rows.values()) or not kept)
