"""A function over many values: here, on threads, on processes or on a cluster."""

from __future__ import annotations

from collections.abc import Callable, Iterable
from concurrent.futures import Executor, Future
from pickle import PicklingError
from typing import TypeVar

from tqdm import tqdm

from exudyn_rotor import checks
from exudyn_rotor.calls import one_thread

Value = TypeVar("Value")
Result = TypeVar("Result")

# one task carries the function with its matrices, so few tasks; but enough to keep workers busy
_MOST_TASKS = 64


@one_thread()
def sweep(
    function: Callable[[Value], Result],
    values: Iterable[Value],
    *,
    executor: Executor | None = None,
    progress: bool = False,
    label: str = "",
) -> list[Result]:
    """Return ``[function(value) for value in values]``, computed by `executor`.

    Each value on one thread of BLAS and LAPACK, see :mod:`exudyn_rotor.calls`.

    Parameters
    ----------
    function : callable
        Takes one value. For processes and clusters it must be picklable: a function of a module, a
        :func:`functools.partial` of one, or an instance of a class with ``__call__``.
    values : iterable
        Picklable too.
    executor : concurrent.futures.Executor, optional
        Any executor of that interface: ``ThreadPoolExecutor``, ``ProcessPoolExecutor`` on one
        machine, ``dask.distributed.Client.get_executor()`` on many. By default all is computed
        here. The results and their order are the same with each.
    progress : bool, optional
        Show a progress bar.
    label : str, optional
        What is computed, for the bar and for errors.

    Raises
    ------
    TypeError
        If an argument is of another kind.
    ValueError
        When `function` raises one; the message names the value.
    RuntimeError
        The same for any other exception, and when the task cannot be pickled.

    Examples
    --------
    >>> from concurrent.futures import ThreadPoolExecutor
    >>> with ThreadPoolExecutor(2) as threads:
    ...     sweep(abs, [-1.0, 2.0], executor=threads)
    [1.0, 2.0]
    """
    checks.function(function, "function")
    if isinstance(values, str | bytes) or not isinstance(values, Iterable):
        raise TypeError(f"values: needs a sequence of values, got {checks.shown(values)}")
    checks.executor(executor)
    checks.flag(progress, "progress")
    checks.instance(label, "label", str)
    values = list(values)
    with tqdm(total=len(values), desc=label or None) if progress else _NoBar() as bar:
        if executor is None:
            results = []
            for value in values:
                results.append(_named(function, value, label))
                bar.update()
            return results
        return _submitted(function, values, executor, bar, label)


class _NoBar:
    """In the place of a progress bar, which makes a lock for processes even if it is not shown."""

    def __enter__(self) -> _NoBar:
        return self

    def __exit__(self, *_) -> None:
        pass

    def update(self, count: int = 1) -> None:
        pass


def _submitted(
    function: Callable, values: list, executor: Executor, bar: tqdm | _NoBar, label: str
) -> list[Result]:
    """Compute in chunks on the executor; the first error cancels what has not begun."""
    length = -(-len(values) // _MOST_TASKS) or 1
    chunks = [values[start : start + length] for start in range(0, len(values), length)]
    futures = [executor.submit(_chunk, function, chunk, label) for chunk in chunks]
    results = []
    try:
        for future in futures:
            done = _result(future, label)
            results.extend(done)
            bar.update(len(done))
    finally:
        for future in futures:
            future.cancel()
    return results


def _result(future: Future, label: str) -> list[Result]:
    """Return a chunk's results; errors of the function itself name their value already."""
    try:
        return future.result()
    except (PicklingError, AttributeError, TypeError) as error:
        raise RuntimeError(
            f"{label or 'sweep'}: the task cannot be sent to this executor ({error}); use "
            "functions of a module instead of lambdas, or threads"
        ) from error


@one_thread()
def _chunk(function: Callable, values: list, label: str) -> list[Result]:
    return [_named(function, value, label) for value in values]


def _named(function: Callable[[Value], Result], value: Value, label: str) -> Result:
    """Call the function; an error says at which value it arose."""
    try:
        return function(value)
    except Exception as error:
        kind = ValueError if isinstance(error, ValueError) else RuntimeError
        cause = str(error) if kind is ValueError else f"{type(error).__name__}: {error}"
        raise kind(f"{label or 'sweep'} at {value}: {cause}") from error
