"""Whether the tests notice wrong physics: signs, factors, dropped terms, swapped indices, frames.

Run ``python -m validation mutations``; ``--quick`` does ten, ``--list`` shows all, ``--only TEXT``
those with the text in their line. Each is put into a copy of the package, where the tests that must
fail run.
"""

from __future__ import annotations

import argparse
import os
import shutil
import signal
import subprocess
import sys
import tempfile
import time
from collections.abc import Iterable, Iterator
from concurrent.futures import ThreadPoolExecutor
from contextlib import contextmanager
from dataclasses import dataclass
from pathlib import Path

from validation.mutations.lists import ALL
from validation.mutations.mutation import PACKAGE, ROOT, Mutation

_FILES = ("pyproject.toml", "README.md", "CONTRIBUTING.md")
_COPIED = (PACKAGE, "tests", "validation", "examples", *_FILES)
_NO_CACHE = shutil.ignore_patterns("__pycache__", "*.png")
_LONGEST = 600.0  # seconds; a mutation that makes a test run on counts as killed
_QUICK = 10
# a wrong program may end so; a run that somebody ends from outside tells nothing
_CRASHES = (signal.SIGABRT, signal.SIGFPE, signal.SIGILL, signal.SIGSEGV)
# of pytest: all passed, tests failed; anything else says that the tests did not run
_PASSED, _FAILED = 0, 1


@dataclass(frozen=True)
class Outcome:
    """What the tests made of a mutation."""

    mutation: Mutation
    verdict: str  # 'killed', 'survived' or 'error'
    seconds: float
    note: str = ""

    def __str__(self) -> str:
        line = f"{self.verdict:8s} {self.seconds:6.1f} s  {self.mutation.name}"
        return f"{line}\n    {self.note}" if self.note else line


def quick(every: Iterable[Mutation], count: int = _QUICK) -> list[Mutation]:
    """Return the first mutation of each folder, `count` at most."""
    first: dict[str, Mutation] = {}
    for one in every:
        first.setdefault(one.folder, one)
    return list(first.values())[:count]


@contextmanager
def copied() -> Iterator[Path]:
    """Give a folder with a copy of the package, its tests and what they read."""
    with tempfile.TemporaryDirectory(prefix="mutations-") as folder:
        for name in _COPIED:
            source, target = ROOT / name, Path(folder) / name
            if source.is_dir():
                shutil.copytree(source, target, ignore=_NO_CACHE)
            else:
                shutil.copy(source, target)
        yield Path(folder)


def tried(mutation: Mutation) -> Outcome:
    """Apply a mutation to a copy and run its tests there."""
    start = time.perf_counter()
    try:
        text = mutation.applied()
    except ValueError as error:
        return Outcome(mutation, "error", 0.0, str(error))
    with copied() as folder:
        (folder / PACKAGE / mutation.file).write_text(text, encoding="utf-8")
        code, note = _tested(folder, mutation.tests, _LONGEST)
    verdict = {_PASSED: "survived", _FAILED: "killed"}.get(code, "error")
    return Outcome(mutation, verdict, time.perf_counter() - start, note)


def unchanged(chosen: Iterable[Mutation]) -> str:
    """Run all tests of mutations on a copy without any; return what is wrong, else nothing."""
    tests = list(dict.fromkeys(test for one in chosen for test in one.tests))
    with copied() as folder:
        code, note = _tested(folder, tests)
    return "" if code == _PASSED else f"the unchanged package does not pass its tests: {note}"


def _tested(folder: Path, tests: Iterable[str], longest: float | None = None) -> tuple[int, str]:
    """Return the exit code of the tests on the package in `folder`, and what they said.

    That is the test that failed, or the end of the output where no test ran.
    """
    environment = os.environ | {"PYTHONPATH": str(folder), "PYTHONDONTWRITEBYTECODE": "1"}
    command = [sys.executable, "-m", "pytest", "-x", "-q", "--tb=line", "-p", "no:cacheprovider"]
    command += ["-p", "no:xdist"] if _has_workers() else []
    command += ["-o", "addopts=", *(f"tests/{name}" for name in tests)]
    try:
        run = subprocess.run(
            command,
            cwd=folder,
            env=environment,
            capture_output=True,
            text=True,
            timeout=longest,
            check=False,
        )
    except subprocess.TimeoutExpired:
        return _FAILED, f"no end after {longest:g} s"
    lines = (run.stdout + run.stderr).splitlines()
    if run.returncode == _FAILED:
        failed = [line for line in lines if line.startswith(("FAILED ", "ERROR "))]
        return _FAILED, failed[0].partition(" - ")[0] if failed else ""
    if -run.returncode in _CRASHES:
        return _FAILED, f"ended by signal {-run.returncode}"
    return run.returncode, "" if run.returncode == _PASSED else " | ".join(lines[-5:])


def _has_workers() -> bool:
    try:
        import xdist  # noqa: F401
    except ImportError:
        return False
    return True


def summary(outcomes: list[Outcome]) -> str:
    """Return how many were killed in every folder, as text."""
    lines = ["folder                 killed  of"]
    for folder in dict.fromkeys(one.mutation.folder for one in outcomes):
        those = [one for one in outcomes if one.mutation.folder == folder]
        killed = sum(one.verdict == "killed" for one in those)
        lines.append(f"{folder:22s} {killed:6d} {len(those):3d}")
    killed = sum(one.verdict == "killed" for one in outcomes)
    return "\n".join([*lines, f"{'all':22s} {killed:6d} {len(outcomes):3d}"])


def main(arguments: list[str] | None = None) -> int:
    """Run the script; returns 0 if the tests noticed every mutation."""
    parser = argparse.ArgumentParser(description=__doc__.splitlines()[0])
    parser.add_argument("--quick", action="store_true", help=f"{_QUICK} mutations, one a folder")
    parser.add_argument("--list", action="store_true", help="print them and do nothing")
    parser.add_argument("--only", metavar="TEXT", default="", help="those with TEXT in their line")
    parser.add_argument("--jobs", type=int, default=2, help="how many at a time; 2 by default")
    given = parser.parse_args(arguments)
    chosen = [one for one in ALL if given.only in one.name]
    chosen = quick(chosen) if given.quick else chosen
    if not chosen:
        parser.error(f"--only: no mutation has {given.only!r} in its line; --list shows all")
    if given.jobs < 1:
        parser.error(f"--jobs: needs a number from 1, got {given.jobs}")
    if given.list:
        print("\n".join(one.name for one in chosen))
        return 0
    outcomes = []
    with ThreadPoolExecutor(given.jobs) as pool:
        before = pool.submit(unchanged, chosen)
        for outcome in pool.map(tried, chosen):
            print(outcome, flush=True)
            outcomes.append(outcome)
    print(summary(outcomes))
    if before.result():
        print(before.result())
    return 0 if not before.result() and all(one.verdict == "killed" for one in outcomes) else 1
