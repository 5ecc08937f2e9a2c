"""What the package says about itself agrees."""

import re
import subprocess
import sys
from pathlib import Path

import exudyn_rotor

ROOT = Path(__file__).parents[2]


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
    assert 'exudyn_rotor = ["py.typed", "__init__.pyi"]' in read("pyproject.toml")


def test_public_names_are_there_sorted_and_with_an_example():
    assert exudyn_rotor.__all__ == sorted(exudyn_rotor.__all__)
    for name in exudyn_rotor.__all__:
        assert ">>> " in getattr(exudyn_rotor, name).__doc__, f"{name} lacks an example"


def run(script: str) -> str:
    """Return what a script prints in a process of its own."""
    command = [sys.executable, "-c", script]
    return subprocess.run(
        command, check=True, capture_output=True, text=True, cwd=ROOT
    ).stdout.strip()


def test_importing_the_package_takes_little_more_than_exudyn():
    """Neither libraries nor modules of rotors, and Exudyn has the new method all the same."""
    script = """
import exudyn, numpy.typing, sys
before = set(sys.modules)
import exudyn_rotor
standard = sys.stdlib_module_names
others = {name for name in set(sys.modules) - before if name.split(".")[0] not in standard}
print(exudyn.MainSystem.CreateFixedAxisFFRFReducedOrderObject.__module__)
print(*sorted(others))
"""
    new_method, loaded = run(script).splitlines()
    assert new_method == "exudyn_rotor.multibody.twins.exudyn_call"
    assert loaded.split() == [
        "exudyn.utilities",
        "exudyn_rotor",
        "exudyn_rotor.multibody",
        "exudyn_rotor.multibody.twins",
        "exudyn_rotor.multibody.twins.exudyn_call",
    ]


def test_models_need_no_matplotlib():
    script = "import sys, exudyn_rotor as er; er.SolidRotor, er.add_rotor, er.craig_bampton_modes"
    assert run(script + "; print('matplotlib' in sys.modules)") == "False"


def test_contributing_names_files_that_exist():
    files = re.findall(r"`([\w/]+\.(?:py|md))`", read("CONTRIBUTING.md"))
    assert len(files) > 20
    for name in files:
        assert (ROOT / name).exists() or (ROOT / "exudyn_rotor" / name).exists(), name
