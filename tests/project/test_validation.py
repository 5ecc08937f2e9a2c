"""The list of the scripts behind the numbers is complete, and the documents name no other."""

import importlib
import re
from pathlib import Path

import pytest

from validation.__main__ import SCRIPTS, listing

ROOT = Path(__file__).parents[2]


@pytest.mark.parametrize("name", SCRIPTS)
def test_script_can_run(name):
    assert callable(importlib.import_module(f"validation.{SCRIPTS[name].module}").main)


def test_every_script_is_listed():
    names = ("timoshenko", "benchmarks", "rotor_trains")
    ross = {f"references.{name}_ross" for name in names}  # needs another package
    own = {"__main__", *ross}
    found = {
        ".".join(path.relative_to(ROOT / "validation").with_suffix("").parts)
        for path in (ROOT / "validation").rglob("*.py")
        if re.search(r"^def main\(", path.read_text(encoding="utf-8"), re.MULTILINE)
    }
    assert found - own == {script.module for script in SCRIPTS.values()}
    listed = listing()
    assert all(f"{name} " in listed for name in SCRIPTS)


def test_documents_name_scripts_that_exist():
    files = [*ROOT.glob("*.md"), *ROOT.glob("*/**/*.py")]
    text = "\n".join(path.read_text(encoding="utf-8") for path in files)
    named = set(re.findall(r"python -m validation ([a-z]\w*)", text))
    assert named <= set(SCRIPTS)
    assert len(named) > 10
