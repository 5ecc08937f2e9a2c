"""The tests under every kernel of OpenBLAS that this processor can run.

numpy, scipy and NGSolve bring an OpenBLAS each, which picks its kernel by the processor: sums run
in another order and rounding differs. Run ``python -m validation kernels``; arguments go to pytest.
Takes as many times the time of the tests as there are kernels. Where the environment sets
OPENBLAS_CORETYPE, only that kernel runs.
"""

from __future__ import annotations

import os
import platform
import re
import subprocess
import sys
import time
from collections.abc import Mapping
from dataclasses import dataclass
from pathlib import Path

VARIABLE = "OPENBLAS_CORETYPE"
NATIVE = "native"
ROOT = Path(__file__).parents[1]
# kernel and the processor's features that it needs
NEEDS = {
    "SkylakeX": {"avx512f", "avx512cd", "avx512bw", "avx512dq", "avx512vl"},
    "Haswell": {"avx2", "fma"},
    "Nehalem": set(),
}
# run by each kernel first: which one the libraries have really taken
_LOADED = """
import ctypes, re
import numpy, scipy.linalg, ngsolve
found = set()
for path in sorted(set(re.findall(r"/\\S*openblas\\S*", open("/proc/self/maps").read()))):
    for name in ("scipy_openblas_get_corename64_", "scipy_openblas_get_corename",
                 "openblas_get_corename64_", "openblas_get_corename"):
        try:
            function = getattr(ctypes.CDLL(path), name)
        except AttributeError:
            continue
        function.restype = ctypes.c_char_p
        found.add(function().decode())
        break
print(" + ".join(sorted(found)))
"""


@dataclass(frozen=True)
class Outcome:
    """Result of the tests under one kernel.

    Attributes
    ----------
    kernel, loaded : str
        Kernel asked for, and those that the libraries have taken ('' if not known).
    passed, failed : int
        Number of tests; errors count as failed.
    seconds : float
        Duration of the run [s].
    code : int
        Exit code of pytest.
    """

    kernel: str
    loaded: str
    passed: int
    failed: int
    seconds: float
    code: int

    @property
    def holds(self) -> bool:
        """True if the tests ran under this kernel alone and passed."""
        names = {NATIVE, self.loaded.lower()}
        taken = not self.loaded or self.kernel.lower() in names
        return taken and self.code == 0 and self.passed > 0


def features() -> set[str]:
    """Return the features of the processor that Linux names; empty elsewhere."""
    try:
        text = Path("/proc/cpuinfo").read_text(encoding="utf-8")
    except OSError:
        return set()
    line = re.search(r"^flags\s*:(.*)$", text, re.MULTILINE)
    return set(line[1].split()) if line else set()


def kernels(flags: set[str], machine: str, environment: Mapping[str, str]) -> list[str]:
    """Return the kernels to run: those of x86-64 that the features allow, or the native one."""
    if environment.get(VARIABLE):
        return [environment[VARIABLE]]
    if machine.lower() not in ("x86_64", "amd64"):
        return [NATIVE]
    return [name for name, needed in NEEDS.items() if needed <= flags]


def counts(output: str) -> tuple[int, int]:
    """Return how many tests passed and failed according to pytest's last line."""
    found = {word: int(number) for number, word in re.findall(r"(\d+) ([a-z]+)", _summary(output))}
    failed = sum(found.get(word, 0) for word in ("failed", "error", "errors"))
    return found.get("passed", 0), failed


def _summary(output: str) -> str:
    lines = [line for line in output.splitlines() if re.search(r"\d+ [a-z]+.* in [\d.]+s", line)]
    return lines[-1] if lines else ""


def run(kernel: str, arguments: list[str]) -> Outcome:
    """Run the tests under a kernel; their output is passed on."""
    environment = dict(os.environ) | ({} if kernel == NATIVE else {VARIABLE: kernel})
    loaded = ""
    if Path("/proc/self/maps").exists():
        command = [sys.executable, "-c", _LOADED]
        answer = subprocess.run(command, env=environment, capture_output=True, text=True)
        loaded = answer.stdout.strip()
    start = time.perf_counter()
    command = [sys.executable, "-m", "pytest", *arguments]
    with subprocess.Popen(
        command, cwd=ROOT, env=environment, stdout=subprocess.PIPE, text=True
    ) as process:
        output = []
        for line in process.stdout:
            print(line, end="", flush=True)
            output.append(line)
    seconds = time.perf_counter() - start
    return Outcome(kernel, loaded, *counts("".join(output)), seconds, process.returncode)


def table(outcomes: list[Outcome]) -> str:
    """Return one line per kernel."""
    lines = [f"{'kernel':<12} {'loaded':<12} {'passed':>7} {'failed':>7} {'time':>8}"]
    lines += [
        f"{o.kernel:<12} {o.loaded or '?':<12} {o.passed:7d} {o.failed:7d} {o.seconds:6.0f} s"
        + ("" if o.holds else "  FAIL")
        for o in outcomes
    ]
    return "\n".join(lines)


def main() -> None:
    """Run all kernels; ends with an error code unless all tests pass under each."""
    if os.environ.get(VARIABLE):
        print(f"{VARIABLE} is set to {os.environ[VARIABLE]}: only this kernel runs")
    outcomes = []
    for kernel in kernels(features(), platform.machine(), os.environ):
        print(f"\n{kernel}", flush=True)
        outcomes.append(run(kernel, sys.argv[1:]))
    print(f"\n{table(outcomes)}")
    if not all(outcome.holds for outcome in outcomes):
        raise SystemExit(1)
