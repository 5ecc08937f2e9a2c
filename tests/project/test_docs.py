"""The pages of the documentation: every block of Python runs, every command exists.

The blocks of a page run in one namespace, one after the other, as a reader would paste them. That
of README has a test of its own in ``test_examples.py``.
"""

import re
import warnings
from functools import cache
from pathlib import Path

import pytest
from matplotlib import pyplot
from test_warnings import TEXTS

import exudyn_rotor
from validation.__main__ import SCRIPTS

ROOT = Path(__file__).parents[2]
DOCS = ROOT / "docs"
PAGES = {
    path.relative_to(ROOT).as_posix(): path.read_text(encoding="utf-8")
    for path in sorted([*DOCS.rglob("*.md"), ROOT / "README.md", ROOT / "CONTRIBUTING.md"])
    if "_build" not in path.parts and "generated" not in path.parts
}
_BLOCK = re.compile(r"^```python\n(.*?)^```", re.MULTILINE | re.DOTALL)


def blocks(text: str) -> list[str]:
    """Return the blocks of Python of a page, each at its own line for tracebacks."""
    return ["\n" * text[: m.start(1)].count("\n") + m[1] for m in _BLOCK.finditer(text)]


def run(code: str, page: str, namespace: dict) -> None:
    with warnings.catch_warnings():
        warnings.filterwarnings("ignore", message=".* errs by about", category=UserWarning)
        exec(compile(code, page, "exec"), namespace)


@cache
def started(block: str) -> dict:
    """Run the block with which many pages begin, their mesh, once."""
    namespace = {"__name__": "page"}
    run(block, "first block of a page", namespace)
    return namespace


WITH_BLOCKS = [page for page in PAGES if page != "README.md" and blocks(PAGES[page])]


@pytest.mark.parametrize("page", WITH_BLOCKS)
def test_blocks_run(page, tmp_path, monkeypatch):
    monkeypatch.chdir(tmp_path)
    first, *rest = blocks(PAGES[page])
    namespace = dict(started(first.lstrip("\n")))
    for block in rest:
        run(block, page, namespace)
    pyplot.close("all")


@pytest.mark.parametrize("page", PAGES)
def test_commands_exist(page):
    text = PAGES[page]
    for name in re.findall(r"python -m validation ([a-z_0-9]+)", text):
        assert name in SCRIPTS, name
    for name in re.findall(r"python ((?:examples|validation|docs)/[\w/]+\.py)", text):
        assert (ROOT / name).exists(), name
    for name in re.findall(r"python -m pytest ([\w/.]+)", text):
        assert (ROOT / name).exists(), name
    for name in re.findall(r"python -m exudyn_rotor (\w+)", text):
        assert name == "demo"
    installed = set(re.findall(r"python -m pip install (?:--editable )?\"?\.\[(\w+)\]", text))
    extras = re.findall(r"^(\w+) = \[", (ROOT / "pyproject.toml").read_text(), re.MULTILINE)
    assert installed <= set(extras)


def test_reference_lists_every_public_name_once():
    listed = re.findall(r"^   (\w+)$", PAGES["docs/api/index.md"], re.MULTILINE)
    assert sorted(listed) == exudyn_rotor.__all__


def test_every_example_is_in_the_gallery():
    shown = re.findall(r"^```\{example\} (\w+)$", PAGES["docs/gallery.md"], re.MULTILINE)
    assert sorted(shown) == sorted(path.stem for path in (ROOT / "examples").glob("*.py"))


@pytest.mark.parametrize("text", sorted(set(TEXTS.values())))
def test_every_warning_is_explained(text):
    page = " ".join(PAGES["docs/warnings.md"].split())
    assert re.search(text, page), f"docs/warnings.md does not have {text!r}"


def test_every_script_of_validation_has_a_place():
    pages = "".join(text for page, text in PAGES.items() if page.startswith("docs/validation"))
    for name in SCRIPTS:
        assert f"python -m validation {name}" in pages, name
