"""One thread per numerical library, small matrices; the tests share the cores; no display."""

import gc
import os

import pytest

# modules and collected tests stay to the end: looking through them for waste takes some seconds of
# each worker
gc.disable()

# before numpy and ngsolve are imported, which read them; processes that tests start have them, too.
# NGSolve's threads wait by spinning: two processes on two cores took three times as long
_THREADS = ("OMP_NUM_THREADS", "OPENBLAS_NUM_THREADS", "MKL_NUM_THREADS", "NGS_NUM_THREADS")
for _name in _THREADS:
    os.environ.setdefault(_name, "1")
os.environ["MPLBACKEND"] = "Agg"

from matplotlib import pyplot  # noqa: E402
from netgen.occ import OCCGeometry  # noqa: E402

# Netgen's four threads wait by spinning, too; without them it makes the same mesh
_generate = OCCGeometry.GenerateMesh
OCCGeometry.GenerateMesh = lambda *args, **options: _generate(*args, **{"nthreads": 1} | options)

_MOST_WORKERS = 4  # each takes up to 1 GB


@pytest.hookimpl(tryfirst=True)
def pytest_cmdline_main(config: pytest.Config) -> None:
    """Spread the whole suite over the cores where pytest-xdist is there and ``-n`` is not given."""
    options, workers = config.option, min(_MOST_WORKERS, os.cpu_count() or 1)
    chosen = getattr(options, "numprocesses", 0) is not None or options.usepdb
    single = any(".py" in name for name in config.args)  # quicker without the start of workers
    if hasattr(config, "workerinput") or chosen or single or workers == 1:
        return
    options.numprocesses = workers
    options.dist = "worksteal"  # neighbours stay together and share the models of their file


@pytest.hookimpl(trylast=True)
def pytest_collection_finish() -> None:
    """Collect garbage from here on, but not among what all tests need."""
    gc.freeze()
    gc.enable()


@pytest.fixture(autouse=True)
def _close_figures():
    """Close what a test drew; pyplot keeps figures otherwise, and warns of many."""
    yield
    pyplot.close("all")
