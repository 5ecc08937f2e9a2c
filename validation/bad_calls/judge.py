"""Bad calls made one by one, and how each was answered."""

from __future__ import annotations

import dis
import inspect
import random
import re
import signal
import warnings
from collections.abc import Callable, Iterator
from dataclasses import dataclass
from pathlib import Path
from types import FrameType, TracebackType
from typing import Any

import exudyn
import numpy as np
from matplotlib import pyplot

import exudyn_rotor as er
from validation.bad_calls import calls, parameters
from validation.bad_calls.unusual import unusual
from validation.bad_calls.world import World

PACKAGE = str(Path(er.__file__).parent)
SECONDS = 20.0  # for one call; the slowest valid one takes one second

GOOD_ALONE = {
    *("three numbers", "range", "table", "block", "texts", "array of texts"),
    *("empty list", "empty tuple", "empty set", "empty array"),
}

CLEAR, UNNAMED, FOREIGN = "refused clearly", "not named", "foreign message"
ACCEPTED, HUNG, HALF_BUILT = "accepted", "hung", "half-built"
OUTCOMES = (CLEAR, UNNAMED, FOREIGN, ACCEPTED, HUNG, HALF_BUILT)


@dataclass(frozen=True)
class Case:
    """A call with a bad value for one of its arguments, or for two.

    Attributes
    ----------
    call : str
    labels : mapping of str to str
        What was put in, by argument.
    make : callable
        Returns these arguments, made anew.
    """

    call: str
    labels: dict[str, str]
    make: Callable[[], dict[str, Any]]

    def __str__(self) -> str:
        given = ", ".join(f"{argument}={label}" for argument, label in self.labels.items())
        return f"{self.call}({given})"


@dataclass(frozen=True)
class Answer:
    """How a call was answered: one of `OUTCOMES`, and what was said."""

    outcome: str
    said: str


def bad_cases(world: World) -> Iterator[Case]:
    """Yield calls with one bad value, every value for every argument of every call."""
    for name in calls.public_calls():
        _, good = calls.valid(name, world)
        for argument, parameter in calls.parameters(name).items():
            optional = parameter.default is None or "None" in str(parameter.annotation).split(" | ")
            kind = parameters.kind_of(name, argument)
            default = None if parameter.default is parameter.empty else parameter.default
            for label, make in kind.bad(good.get(argument, default), optional):
                yield _case(name, argument, label, make)


def pairs(cases: list[Case], count: int) -> Iterator[Case]:
    """Yield calls with two bad values, drawn at random from those with one."""
    draw = random.Random(count)
    by_call: dict[str, list[Case]] = {}
    for case in cases:
        by_call.setdefault(case.call, []).append(case)
    several = [case for case in cases if case.labels.keys() != by_call[case.call][0].labels.keys()]
    for one in draw.choices(several, k=count):
        others = [case for case in by_call[one.call] if case.labels.keys() != one.labels.keys()]
        other = draw.choice(others)
        labels = one.labels | other.labels
        yield Case(one.call, labels, lambda a=one, b=other: a.make() | b.make())


def good_cases(world: World) -> Iterator[Case]:
    """Yield calls with a good value of an unusual kind."""
    for name in calls.public_calls():
        function, good = calls.valid(name, world)
        own = inspect.signature(function).parameters
        for argument, parameter in calls.parameters(name).items():
            if argument in own:
                for label, make in unusual(good.get(argument, parameter.default)):
                    yield _case(name, argument, label, make)


def _case(name: str, argument: str, label: str, make: Callable[[], Any]) -> Case:
    return Case(name, {argument: label}, lambda: {argument: make()})


def answer(case: Case, world: World) -> Answer:
    """Make a call, and say how it was answered."""
    function, given = calls.valid(case.call, world)
    names = set(case.labels)
    for argument, label in case.labels.items():
        # a good value that does not fit the others: any of them may be named
        several = isinstance(function, type) or isinstance(given.get(argument), np.ndarray | list)
        if several and label in GOOD_ALONE:
            names |= set(calls.parameters(case.call))
    given |= case.make()
    scenes = [world.mbs, world.assembled]
    before = [state(mbs) for mbs in scenes]
    found = _outcome(function, given, names)
    pyplot.close("all")
    built = [state(mbs) for mbs in scenes] != before
    if built or found.outcome == ACCEPTED:
        world.renew()
    return Answer(HALF_BUILT, found.said) if built and found.outcome != ACCEPTED else found


def state(mbs: exudyn.MainSystem) -> tuple[int, ...]:
    """Return how many items of each kind a scene has, and whether it is ready to be solved."""
    data = mbs.systemData
    kinds = ("Nodes", "Objects", "Markers", "Loads", "Sensors")
    counts = (getattr(data, f"NumberOf{kind}")() for kind in kinds)
    return (*counts, mbs.systemIsConsistent)


def _outcome(function: Callable, given: dict[str, Any], names: set[str]) -> Answer:
    _alarm(SECONDS)
    try:
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")
            function(**given)
    except TimeoutError:
        return Answer(HUNG, f"more than {SECONDS:g} s")
    except KeyboardInterrupt:
        raise
    # whatever else it is, it is judged
    except BaseException as error:
        return _judged(error, names)
    finally:
        _alarm(0.0)
    return Answer(ACCEPTED, "")


def _judged(error: BaseException, names: set[str]) -> Answer:
    """Say whether an error is one of ours and names the argument."""
    said = f"{type(error).__name__}: {error}"
    if "unexpected keyword argument 'nonsense'" in said:  # Python's own words name it
        return Answer(CLEAR, said)
    place = innermost(error)
    if place is None or not isinstance(error, TypeError | ValueError | LookupError):
        return Answer(FOREIGN, said)
    if not any(re.search(rf"\b{name}\b", str(error)) for name in names):
        return Answer(UNNAMED, said)
    return Answer(CLEAR, said)


def innermost(error: BaseException) -> str | None:
    """Return where an error was raised by a ``raise`` of this package, else None.

    Errors of compiled code have the calling line as their innermost one, but no ``raise`` there.
    """
    last: TracebackType | None = error.__traceback__
    while last is not None and last.tb_next is not None:
        last = last.tb_next
    if last is None:
        return None
    code = last.tb_frame.f_code
    raised = dis.opname[code.co_code[last.tb_lasti]] == "RAISE_VARARGS"
    if not raised or not code.co_filename.startswith(PACKAGE):
        return None
    return f"{Path(code.co_filename).relative_to(PACKAGE)}:{last.tb_lineno}"


def home(name: str) -> str:
    """Return the folder of the package in which a call is defined."""
    function = inspect.unwrap(calls.function_of(name))
    return function.__module__.removeprefix("exudyn_rotor.").split(".")[0]


def _alarm(seconds: float) -> None:
    if hasattr(signal, "SIGALRM"):  # not on Windows
        signal.signal(signal.SIGALRM, _stop)
        signal.setitimer(signal.ITIMER_REAL, seconds)


def _stop(number: int, frame: FrameType | None) -> None:
    raise TimeoutError
