"""Thousands of bad calls: is each refused by a message that names the argument?

Run ``python -m validation bad_calls``, with ``--quick`` for a share of them, ``--list FILE`` to
keep what was not refused clearly. They run in processes of their own, so that a crash or a hang is
seen.
"""

from __future__ import annotations

import argparse
import itertools
import multiprocessing
import os
import random
from collections import Counter
from concurrent.futures import ThreadPoolExecutor
from multiprocessing.connection import Connection

from tqdm import tqdm

from validation.bad_calls.judge import (
    ACCEPTED,
    CLEAR,
    HALF_BUILT,
    HUNG,
    OUTCOMES,
    SECONDS,
    Answer,
    Case,
    answer,
    bad_cases,
    good_cases,
    home,
    pairs,
)
from validation.bad_calls.world import World

CRASHED = "crashed"
WANTED = 0.99  # share of bad calls that are refused clearly
MEMORY = 12e9  # bytes for one process: a list of 10^10 numbers is refused by the system
PAIRS = 3000  # calls with two bad values
Answers = list[tuple[Case, Answer]]


def all_cases(world: World) -> tuple[list[Case], int]:
    """Return all calls, and how many of them are bad; those with good values come last."""
    single = list(bad_cases(world))
    bad = [*single, *pairs(single, PAIRS)]
    return [*bad, *good_cases(world)], len(bad)


def chosen(total: int, count: int | None, seed: int = 0) -> list[int]:
    """Return the numbers of all cases, or of `count` of them drawn at random."""
    if count is None or count >= total:
        return list(range(total))
    return sorted(random.Random(seed).sample(range(total), count))


def answers(numbers: list[int], cases: list[Case], processes: int = 1) -> Answers:
    """Make the calls of these numbers in processes of their own."""
    shares = [numbers[start::processes] for start in range(processes)]
    with tqdm(total=len(numbers), desc="bad calls") as bar, ThreadPoolExecutor(processes) as pool:
        found = pool.map(lambda share: _answers_of(share, cases, bar), shares)
        return list(itertools.chain.from_iterable(found))


def _answers_of(numbers: list[int], cases: list[Case], bar: tqdm) -> Answers:
    """Make calls in one process after another: a new one after each crash or hang."""
    found: Answers = []
    while len(found) < len(numbers):
        left = numbers[len(found) :]
        context = multiprocessing.get_context("spawn")
        here, there = context.Pipe()
        process = context.Process(target=_work, args=(left, there), daemon=True)
        process.start()
        there.close()
        for number in left:
            end = _received(here, process)
            found.append((cases[number], end))
            bar.update()
            if end.outcome in (CRASHED, HUNG):
                break
        process.kill()
        process.join()
    return found


def _received(here: Connection, process: multiprocessing.process.BaseProcess) -> Answer:
    # the first one waits for the models, too
    if not here.poll(10.0 * SECONDS):
        return Answer(HUNG, "no answer")
    try:
        return here.recv()
    except EOFError:
        process.join()
        return Answer(CRASHED, f"exit code {process.exitcode}")


def _work(numbers: list[int], there: Connection) -> None:
    """Send the answers of calls; what Exudyn prints is dropped."""
    _limit_memory()
    os.dup2(os.open(os.devnull, os.O_WRONLY), 1)
    world = World()
    os.chdir(world.folder)
    cases, _ = all_cases(world)
    for number in numbers:
        there.send(answer(cases[number], world))


def _limit_memory() -> None:
    try:
        import resource
    except ImportError:  # not on Windows
        return
    _, most = resource.getrlimit(resource.RLIMIT_AS)
    resource.setrlimit(resource.RLIMIT_AS, (int(MEMORY), most))


def printed(found: Answers) -> str:
    """Return a table of the answers, one line per call."""
    kinds = [*OUTCOMES, CRASHED]
    counts: dict[tuple[str, str], Counter] = {}
    for case, end in found:
        counts.setdefault((home(case.call), case.call), Counter())[end.outcome] += 1
    width = max(len(call) for _, call in counts)
    lines = [f"{'':{width}} {'calls':>7}" + "".join(f"{kind:>16}" for kind in kinds)]
    folder = ""
    for (place, call), of_call in sorted(counts.items()):
        if place != folder:
            folder = place
            lines.append(f"\n{folder}")
        lines.append(
            f"{call:{width}} {of_call.total():7}" + "".join(f"{of_call[k]:16}" for k in kinds)
        )
    total = sum(counts.values(), Counter())
    lines.append(f"\n{'all':{width}} {total.total():7}" + "".join(f"{total[k]:16}" for k in kinds))
    return "\n".join(lines)


def share(found: Answers) -> float:
    """Return the share of bad calls that were refused clearly."""
    return sum(end.outcome == CLEAR for _, end in found) / max(len(found), 1)


def listed(found: Answers, wanted: str = CLEAR) -> str:
    """Return what was answered otherwise than wanted, one line each, by folder of the package."""
    failed = [(home(case.call), str(case), end) for case, end in found if end.outcome != wanted]
    failed.sort(key=lambda entry: entry[:2])
    return "\n".join(
        f"{place}: {case}: {end.outcome}: {' '.join(end.said.split())[:160]}"
        for place, case, end in failed
    )


def main() -> None:
    """Make all calls; ends with an error code if too many are not answered as they should be."""
    parser = argparse.ArgumentParser(description="Is every bad call refused clearly?")
    parser.add_argument("--quick", action="store_true", help="two thousand of them only")
    parser.add_argument("--list", metavar="FILE", help="write what was not refused clearly")
    parser.add_argument("--call", metavar="NAME", help="only calls whose name begins so")
    parser.add_argument("--processes", type=int, default=1, help="how many at a time")
    options = parser.parse_args()
    cases, bad_count = all_cases(World())
    numbers = chosen(len(cases), 2000 if options.quick else None)
    if options.call:
        numbers = [n for n in numbers if cases[n].call.startswith(options.call)]
    found = answers(numbers, cases, options.processes)
    is_bad = dict(zip(map(id, cases), (n < bad_count for n in range(len(cases))), strict=True))
    bad = [(case, end) for case, end in found if is_bad[id(case)]]
    good = [(case, end) for case, end in found if not is_bad[id(case)]]
    refused = listed(good, ACCEPTED)
    print(printed(bad))
    print(f"good values of unusual kinds: {len(good)} calls, refused: {refused or 'none'}")
    print(f"bad calls refused clearly: {share(bad):.2%}")
    if options.list:
        with open(options.list, "w", encoding="utf-8") as file:
            file.write("\n".join(filter(None, (listed(bad), refused, ""))))
    worst = sum(end.outcome in (CRASHED, HUNG, HALF_BUILT) for _, end in bad)
    if worst or refused or share(bad) < WANTED:
        raise SystemExit(f"{share(bad):.2%} refused clearly, {worst} crashed, hung or half-built")
