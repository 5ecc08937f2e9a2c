"""The list of the scripts behind the numbers is complete, and the documents name no other."""

import importlib
import re
import runpy
import sys
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


def test_options_reach_the_script(monkeypatch, capsys):
    monkeypatch.delitem(sys.modules, "validation.__main__")  # it is run as a program
    monkeypatch.setattr(sys, "argv", ["validation", "savers", "--help"])
    with pytest.raises(SystemExit) as ended:
        runpy.run_module("validation", run_name="__main__")
    assert ended.value.code == 0
    assert "usage: python -m validation savers" in capsys.readouterr().out
    monkeypatch.setattr(sys, "argv", ["validation", "sabers"])
    with pytest.raises(SystemExit, match="'sabers' is unknown; there are: speed"):
        runpy.run_module("validation", run_name="__main__")
