"""Flexible solid rotors about one fixed axis, for Exudyn multibody scenes.

Importing the package adds ``mbs.CreateFixedAxisFFRFReducedOrderObject`` to Exudyn, and lets
``mbs.Assemble()`` make the markers of a script on this package's rotors cheap.
"""

from __future__ import annotations

import ast
from importlib import import_module
from importlib.util import find_spec
from pathlib import Path
from typing import Any

import exudyn.utilities  # noqa: F401 (scripts find it in exudyn, as they always did)

import exudyn_rotor.multibody.twins.exudyn_call  # noqa: F401 (methods of Exudyn's MainSystem)

__version__ = "0.2.0"

# public names by their module, which is imported where one of them is first used; type checkers
# and editors read the same list
_STUB = ast.parse(Path(__file__).with_suffix(".pyi").read_text(encoding="utf-8"))
_MODULES = {
    each.name: node.module
    for node in _STUB.body
    if isinstance(node, ast.ImportFrom)
    for each in node.names
}

__all__ = sorted(_MODULES)


def __getattr__(name: str) -> Any:
    """Return a public name or a module of the package; they are imported here."""
    if name in _MODULES:
        value = getattr(import_module(_MODULES[name]), name)
    elif name.isidentifier() and name[0] != "_" and find_spec(f"{__name__}.{name}") is not None:
        value = import_module(f"{__name__}.{name}")
    else:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
