"""Which kernels of OpenBLAS the long run of the tests takes, and what it reads from each run."""

import pytest

from validation import kernels

AVX2 = {"sse4_2", "avx2", "fma"}
AVX512 = AVX2 | {"avx512f", "avx512cd", "avx512bw", "avx512dq", "avx512vl"}


@pytest.mark.parametrize(
    ("flags", "machine", "expected"),
    [
        (AVX512, "x86_64", ["SkylakeX", "Haswell", "Nehalem"]),
        (AVX512 - {"avx512vl"}, "x86_64", ["Haswell", "Nehalem"]),
        (AVX2, "AMD64", ["Haswell", "Nehalem"]),
        (set(), "x86_64", ["Nehalem"]),
        (set(), "aarch64", ["native"]),
    ],
)
def test_kernels_are_those_that_the_processor_can_run(flags, machine, expected):
    assert kernels.kernels(flags, machine, {}) == expected
    assert kernels.kernels(flags, machine, {kernels.VARIABLE: ""}) == expected
    assert kernels.kernels(flags, machine, {kernels.VARIABLE: "Zen"}) == ["Zen"]


@pytest.mark.parametrize(
    ("line", "expected"),
    [
        ("25 passed in 9.96s", (25, 0)),
        ("=== 2 failed, 1370 passed, 3 warnings in 201.11s (0:03:21) ===", (1370, 2)),
        ("1 error in 0.52s", (0, 1)),
        ("no tests ran in 0.01s", (0, 0)),
    ],
)
def test_summary_of_pytest_is_read(line, expected):
    assert kernels.counts(f"..F [100%]\n3 passed in earlier output\n{line}\n") == expected


def test_run_holds_only_under_the_kernel_asked_for():
    outcome = kernels.Outcome("Haswell", "Haswell", 3, 0, 1.0, 0)
    assert outcome.holds
    for change in (
        {"loaded": "Nehalem"},
        {"loaded": "Haswell + Nehalem"},
        {"passed": 0},
        {"failed": 1, "code": 1},
    ):
        other = kernels.Outcome(**(vars(outcome) | change))
        assert not other.holds
        assert "FAIL" in kernels.table([other])
