"""One thread of BLAS for small dense problems."""

import subprocess
import sys
from concurrent.futures import ThreadPoolExecutor
from threading import Barrier, Event, get_ident

import numpy as np
import pytest
from threadpoolctl import ThreadpoolController

import exudyn_rotor
from exudyn_rotor import threads
from exudyn_rotor.cached import cached_property
from exudyn_rotor.sweep import sweep
from exudyn_rotor.threads import eig, in_turns, meanwhile, one_thread, shared


def counts(_value: float = 0.0) -> set[int]:
    """Return the numbers of threads of numpy's and scipy's libraries, without Pardiso's."""
    loaded = ThreadpoolController().select(user_api="blas").info()
    names = {each["internal_api"] for each in loaded}
    numpys = names - {"mkl"} or names
    return {each["num_threads"] for each in loaded if each["internal_api"] in numpys}


@pytest.fixture
def two_threads():
    with ThreadpoolController().limit(limits=2, user_api="blas"):
        yield


@pytest.mark.usefixtures("two_threads")
def test_one_thread_until_the_last_holder_leaves():
    first, second = one_thread(), one_thread()
    first.__enter__()
    second.__enter__()
    first.__exit__(None, None, None)
    assert counts() == {1}
    second.__exit__(None, None, None)
    assert counts() == {2}


@pytest.mark.usefixtures("two_threads")
def test_a_sweep_uses_one_thread_for_each_value():
    with ThreadPoolExecutor(2) as executor:
        assert sweep(counts, [1.0, 2.0], executor=executor) == [{1}, {1}]
    assert sweep(counts, [1.0]) == [{1}]
    with pytest.raises(RuntimeError):
        sweep(lambda value: value.missing, [1.0])
    assert counts() == {2}


@pytest.mark.usefixtures("two_threads")
def test_eigenproblems_are_shared_out_and_the_same_to_the_digit(monkeypatch):
    matrices = np.random.default_rng(0).normal(size=(9, 60, 60))
    expected, lengths, solve = np.linalg.eig(matrices), [], np.linalg.eig
    monkeypatch.setattr(np.linalg, "eig", lambda part: lengths.append(len(part)) or solve(part))
    for found, known in zip(eig(matrices), expected, strict=True):
        np.testing.assert_array_equal(found, known)
    with one_thread():
        eig(matrices)
    eig(matrices[0])
    assert sorted(lengths) == [1] * 14 + [2] * 2 + [60]


@pytest.mark.usefixtures("two_threads")
def test_shared_work_is_done_in_order_by_two_threads_at_once():
    both = Barrier(2, timeout=20.0)

    def done(number: int) -> tuple[int, set[int], list[str]]:
        if number < 2:
            both.wait()
        return number, counts(), shared(str, [number, number])

    expected = [(number, {1}, [str(number)] * 2) for number in range(5)]
    assert shared(done, range(5)) == expected
    assert counts() == {2}
    with pytest.raises(ZeroDivisionError):
        shared(lambda number: 1 / number, [1, 0, 2, 0])


@pytest.mark.usefixtures("two_threads")
def test_one_thread_at_a_time_runs_but_for_eigenproblems(monkeypatch):
    other_ran, inside = Event(), []
    monkeypatch.setattr(np.linalg, "eig", lambda matrix: other_ran.wait(20.0) or 1 / 0)

    def done(number: int) -> int:
        inside.append(number)
        assert len(inside) == 1
        if number == 0:
            inside.remove(0)
            eig(np.eye(2))
            inside.append(0)
        else:
            other_ran.set()
        inside.remove(number)
        return number

    assert in_turns(done, range(6)) == list(range(6))
    assert other_ran.is_set()


PROPERTIES = """
import sys
import threading
import types
import numpy as np

sys.modules["exudyn_rotor"] = package = types.ModuleType("exudyn_rotor")
package.__path__ = sys.argv[1:]  # two modules alone, as the whole package takes seconds
from threadpoolctl import ThreadpoolController
from exudyn_rotor.cached import cached_property
from exudyn_rotor.threads import eig, in_turns

both, solve = threading.Barrier(2), np.linalg.eig
np.linalg.eig = lambda matrix: both.wait() * 0.0 + solve(matrix)[0]


class Equations:
    @cached_property
    def values(self):
        return eig(np.eye(2))


with ThreadpoolController().limit(limits=2, user_api="blas"):
    print(in_turns(lambda each: each.values.real.tolist(), [Equations(), Equations()]))
"""


def test_eigenproblems_of_properties_leave_the_turn_to_others():
    """With a lock of all objects both threads would stop for good."""
    call = [sys.executable, "-c", PROPERTIES, *exudyn_rotor.__path__]
    done = subprocess.run(call, capture_output=True, text=True, timeout=10.0, check=True)
    assert done.stdout == "[[1.0, 1.0], [1.0, 1.0]]\n"


WITHIN = """
import os
import sys
import threading
import types
import numpy as np

sys.modules["exudyn_rotor"] = package = types.ModuleType("exudyn_rotor")
package.__path__ = sys.argv[1:]
from threadpoolctl import ThreadpoolController
from exudyn_rotor.threads import eig, in_turns, shared

os.cpu_count = lambda: 1
main, has_turn = threading.get_ident(), threading.Event()
np.linalg.eig = lambda matrix: has_turn.wait()


def done(number):
    if threading.get_ident() == main:
        has_turn.set()
        return shared(abs, [number, number])[0]
    eig(np.eye(2))
    return number


with ThreadpoolController().limit(limits=2, user_api="blas"):
    print(in_turns(done, range(4)))
"""


def test_shared_work_within_a_turn_does_not_wait_for_a_thread_that_waits_for_the_turn():
    """The one helper does, and would begin with the work within only after that."""
    call = [sys.executable, "-c", WITHIN, *exudyn_rotor.__path__]
    done = subprocess.run(call, capture_output=True, text=True, timeout=10.0, check=True)
    assert done.stdout == "[0, 1, 2, 3]\n"


@pytest.mark.usefixtures("two_threads")
def test_properties_are_computed_once_without_a_lock():
    """Two threads at one object get the same value."""
    computed, both = [], Barrier(2, timeout=20.0)

    class Equations:
        @cached_property
        def values(self) -> object:
            """Return values."""
            computed.append(both.wait())
            return object()

    one, other = Equations(), Equations()
    first, second = shared(lambda _number: one.values, range(2))
    assert first is second is one.values
    assert len(computed) == 2
    assert len({id(each) for each in shared(lambda each: each.values, [other, Equations()])}) == 2
    assert Equations.values.__doc__ == "Return values."


@pytest.mark.parametrize("threads", [1, 2])
def test_meanwhile_computes_once_beside_eigenproblems_and_passes_errors_on(threads, monkeypatch):
    began, ended, found = Event(), Event(), []
    solve = np.linalg.eig

    def waiting(part: np.ndarray) -> tuple[np.ndarray, np.ndarray]:
        began.set()
        assert threads == 1 or ended.wait(20.0)
        return solve(part)

    def done(value: float) -> float:
        assert began.wait(20.0)  # another thread has an eigenproblem
        found.append(get_ident())
        ended.set()
        return value

    monkeypatch.setattr(np.linalg, "eig", waiting)
    with ThreadpoolController().limit(limits=threads, user_api="blas"):
        with meanwhile(done, 3.0) as result:
            eig(np.random.default_rng(0).normal(size=(9, 60, 60)))
            assert len(found) == threads - 1
            assert (result(), result()) == (3.0, 3.0)
        assert found == [get_ident()]
        with meanwhile(divmod, 1, 0) as result:
            eig(np.random.default_rng(0).normal(size=(9, 60, 60)))
            with pytest.raises(ZeroDivisionError):
                result()


class Interrupted:
    """A lock that is interrupted when it is waited for a second time; another has it then."""

    def __init__(self) -> None:
        self.mine, self.taken, self.others = False, 0, False

    def acquire(self) -> bool:
        self.taken += 1
        if self.taken == 2:
            self.others = True
            raise KeyboardInterrupt
        self.mine = True
        return True

    def release(self) -> None:
        if not self.mine:
            raise RuntimeError("cannot release un-acquired lock")
        self.mine = False

    __enter__ = acquire

    def __exit__(self, *_error: object) -> None:
        self.release()


def test_an_interrupt_while_a_turn_is_waited_for_comes_through(monkeypatch):
    """As Ctrl-C; neither a lock of another thread is released nor one left behind."""
    made = []
    for name in ("Lock", "RLock"):
        monkeypatch.setattr(threads, name, lambda: made.append(Interrupted()) or made[-1], False)
    with pytest.raises(KeyboardInterrupt):
        in_turns(lambda item: eig(item), [np.eye(3)])
    assert made[0].others
    assert not made[0].mine
    monkeypatch.undo()
    assert np.allclose(in_turns(lambda item: eig(item)[0], [np.eye(3)]), 1.0)


def test_turns_within_turns_give_the_outer_one_back():
    def outer(item):
        first = threads._HERE.turn
        in_turns(eig, [item])
        return threads._HERE.turn is first

    assert in_turns(outer, [np.eye(3)] * 2) == [True, True]
    assert getattr(threads._HERE, "turn", None) is None
