"""Imports go one way, in the order of the listing in CONTRIBUTING, 'Structure'."""

import ast
import re
from collections.abc import Iterator
from functools import cache
from graphlib import CycleError, TopologicalSorter
from pathlib import Path

import pytest

ROOT = Path(__file__).parents[2]
PACKAGE = ROOT / "exudyn_rotor"
NAME = PACKAGE.name


@cache
def order() -> list[str]:
    """Return the entries of the listing in CONTRIBUTING, 'theory/' or 'units.py', top down."""
    text = (ROOT / "CONTRIBUTING.md").read_text(encoding="utf-8")
    listing = text.split("### Structure", 1)[1].split(f"{NAME}/", 1)[1]
    listing = listing.split("\n    validation/")[0]
    lines = (re.split(r" {2,}", line.strip())[0] for line in listing.splitlines()[1:])
    return [
        entry for line in lines for entry in line.split(", ") if re.match(r"\w+(/|\.py)$", entry)
    ]


def modules() -> dict[str, Path]:
    """Return all modules of the package by their dotted name below it; '' is the package."""
    found = {}
    for path in sorted(PACKAGE.rglob("*.py")):
        parts = path.relative_to(PACKAGE).with_suffix("").parts
        found[".".join(part for part in parts if part != "__init__")] = path
    return found


MODULES = modules()


@cache
def tree(module: str) -> ast.Module:
    """Return the syntax of a module."""
    return ast.parse(MODULES[module].read_text(encoding="utf-8"))


@cache
def imports(module: str) -> frozenset[str]:
    """Return what a module imports of the package, anywhere: in functions and for types, too."""
    return frozenset(_imports(module))


def _imports(module: str) -> Iterator[str]:
    path = MODULES[module]
    folder = module.split(".") if path.name == "__init__.py" else module.split(".")[:-1]
    for node in ast.walk(tree(module)):
        if isinstance(node, ast.Import):
            yield from (_below(alias.name) for alias in node.names if _is_own(alias.name))
        elif isinstance(node, ast.ImportFrom):
            base = node.module or ""
            if node.level:
                above = [NAME, *filter(None, folder)]
                base = ".".join([*above[: len(above) - node.level + 1], *filter(None, [base])])
            if _is_own(base):
                for alias in node.names:
                    whole = _below(f"{base}.{alias.name}")
                    yield whole if whole in MODULES else _below(base)


def _is_own(name: str) -> bool:
    return name == NAME or name.startswith(f"{NAME}.")


def _below(name: str) -> str:
    return name.removeprefix(NAME).removeprefix(".")


def place(module: str) -> int:
    """Return where the entry of a module stands in the listing."""
    head = module.partition(".")[0] or "__init__"
    entry = f"{head}/" if (PACKAGE / head).is_dir() else f"{head}.py"
    assert entry in order(), f"{entry} is not listed under 'Structure' in CONTRIBUTING"
    return order().index(entry)


def test_every_entry_of_the_listing_exists():
    entries = order()
    assert len(entries) == len(set(entries))
    for entry in entries:
        assert (PACKAGE / entry).exists(), entry
    assert {place(module) for module in MODULES} == set(range(len(entries)))


OTHERS_OWN = {"_None", "_asdict", "_call_pardiso", "_getframe", "_name", "_replace"}


@cache
def private_names(entry: str) -> frozenset[str]:
    """Return the private names that an entry of the listing makes: defined, assigned, quoted."""
    found = set()
    for module in (module for module in MODULES if order()[place(module)] == entry):
        for node in ast.walk(tree(module)):
            made = getattr(node, "name", None) or getattr(node, "value", None)
            if isinstance(node, ast.Attribute | ast.Name) and isinstance(node.ctx, ast.Store):
                made = node.attr if isinstance(node, ast.Attribute) else node.id
            found.add(made if isinstance(made, str) else None)
    return frozenset(name for name in found if name and name.startswith("_"))


def used_names(module: str) -> Iterator[str]:
    """Return the names that a module takes of other objects and of the package's modules."""
    for node in ast.walk(tree(module)):
        if isinstance(node, ast.Attribute) and getattr(node.value, "id", "") not in ("self", "cls"):
            yield node.attr
        elif isinstance(node, ast.ImportFrom) and _is_own(node.module or ""):
            yield from (alias.name for alias in node.names)


def test_private_names_stay_in_their_entry():
    strange = {}
    for module in MODULES:
        names = {name for name in used_names(module) if re.match("_[^_]", name)}
        strange[module] = names - private_names(order()[place(module)]) - OTHERS_OWN
    assert not {module: names for module, names in strange.items() if names}


def test_imports_go_up_the_listing():
    pairs = {(module, imported) for module in MODULES for imported in imports(module)}
    assert not {(one, other) for one, other in pairs if place(other) > place(one)}


FOLDERS = sorted(name for name, path in MODULES.items() if path.name == "__init__.py" and name)


@pytest.mark.parametrize("folder", FOLDERS)
def test_no_circle_within_a_folder(folder):
    """Neither between its files nor between its folders."""
    graph: dict[str, set[str]] = {}
    for module in MODULES:
        if module.startswith(f"{folder}."):
            own = _entry(module, folder)
            inside = (name for name in imports(module) if name.startswith(f"{folder}."))
            graph.setdefault(own, set()).update({_entry(name, folder) for name in inside} - {own})
    try:
        TopologicalSorter(graph).prepare()
    except CycleError as error:
        pytest.fail(f"{folder}: a circle of imports: {' → '.join(reversed(error.args[1]))}")


def _entry(module: str, folder: str) -> str:
    return module.removeprefix(f"{folder}.").partition(".")[0]
