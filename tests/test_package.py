"""What the package says about itself agrees."""

import re
from pathlib import Path

import exudyn_rotor

ROOT = Path(__file__).parents[1]


def read(name: str) -> str:
    return (ROOT / name).read_text(encoding="utf-8")


def test_one_version():
    version = exudyn_rotor.__version__
    assert 'version = { attr = "exudyn_rotor.__version__" }' in read("pyproject.toml")
    assert f"version: {version}\n" in read("CITATION.cff")
    newest = re.search(r"^## \[(.+?)\]", read("CHANGELOG.md"), re.MULTILINE)[1]
    assert version.removesuffix(".dev0") == newest


def test_lowest_releases_are_those_that_are_allowed():
    """What `.ci/run` installs last; ruff, which formats as its release does, is not among them."""
    needed = read("pyproject.toml").partition("[project]")[2].partition("[tool.")[0]
    allowed = re.findall(r'"([\w-]+)(?:\[\w+\])?>=([\d.]+),<[\d.]+[;"]', needed)
    docs = re.search(r"^docs = (.*)$", needed, re.MULTILINE)[1]
    wanted = {f"{name}=={bound}" for name, bound in allowed if f'"{name}>' not in docs}
    lines = read(".ci/lowest.txt").splitlines()[1:]
    assert lines == sorted({line for line in wanted if not line.startswith("ruff")})


def test_types_are_published():
    assert (ROOT / "exudyn_rotor" / "py.typed").exists()
    assert 'exudyn_rotor = ["py.typed"]' in read("pyproject.toml")


def test_licence_is_the_one_of_the_file():
    assert 'license = "BSD-3-Clause"' in read("pyproject.toml")
    assert "license: BSD-3-Clause" in read("CITATION.cff")
    assert read("LICENSE").startswith("BSD 3-Clause License")


def test_public_names_are_there_sorted_and_with_an_example():
    assert exudyn_rotor.__all__ == sorted(exudyn_rotor.__all__)
    for name in exudyn_rotor.__all__:
        assert ">>> " in getattr(exudyn_rotor, name).__doc__, f"{name} lacks an example"


def test_contributing_names_files_that_exist():
    files = re.findall(r"`([\w/]+\.(?:py|md))`", read("CONTRIBUTING.md"))
    assert len(files) > 20
    for name in files:
        assert (ROOT / name).exists() or (ROOT / "exudyn_rotor" / name).exists(), name


def test_importing_the_package_leaves_slow_modules_alone():
    """SciPy's signals and statistics, needed by few functions, would take a fifth of the time."""
    slow = re.compile(r"^(from|import) scipy\.(signal|stats)\b", re.MULTILINE)
    files = sorted((ROOT / "exudyn_rotor").rglob("*.py"))
    assert [file.name for file in files if slow.search(file.read_text(encoding="utf-8"))] == []
