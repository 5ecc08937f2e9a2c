"""One thread of BLAS for small dense problems."""

from concurrent.futures import ThreadPoolExecutor

import pytest
from threadpoolctl import ThreadpoolController

from exudyn_rotor.sweep import sweep
from exudyn_rotor.threads import one_thread


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
