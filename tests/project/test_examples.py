"""Every example and the README's script run without a display and meet their asserted numbers."""

import runpy
import sys
from pathlib import Path

import matplotlib
import pytest

ROOT = Path(__file__).parents[2]
EXAMPLES = sorted((ROOT / "examples").glob("*.py"))


@pytest.fixture(autouse=True)
def _no_display(monkeypatch, tmp_path):
    matplotlib.use("Agg")
    monkeypatch.chdir(tmp_path)


@pytest.mark.filterwarnings("error::UserWarning")  # what an example shows needs no excuse
@pytest.mark.parametrize("path", EXAMPLES, ids=lambda path: path.stem)
def test_example(path):
    runpy.run_path(str(path), run_name="__main__")


def readme_script() -> str:
    text = (ROOT / "README.md").read_text(encoding="utf-8")
    return text.split("```python\n")[1].split("```")[0]


def test_readme_script_runs_and_is_short(tmp_path):
    script = readme_script()
    assert len([line for line in script.splitlines() if line.strip()]) <= 15
    (tmp_path / "readme.py").write_text(script, encoding="utf-8")
    results = runpy.run_path(str(tmp_path / "readme.py"))
    orbit = results["mbs"].GetSensorStoredData(results["orbit"])
    assert len(orbit) > 100
    assert 1e-6 < abs(orbit[:, 1:3]).max() < 1e-3


def test_command_line_names_the_demo(monkeypatch, capsys):
    monkeypatch.delitem(sys.modules, "exudyn_rotor.__main__", raising=False)
    monkeypatch.setattr(sys, "argv", ["exudyn_rotor", "--help"])
    with pytest.raises(SystemExit) as ended:
        runpy.run_module("exudyn_rotor", run_name="__main__")
    assert ended.value.code == 0
    assert "demo" in capsys.readouterr().out
