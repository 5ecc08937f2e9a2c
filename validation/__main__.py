"""Run a script of this folder, a folder of them, or list all: ``python -m validation NAME …``."""

from __future__ import annotations

import ast
import importlib
import sys
from pathlib import Path
from typing import NamedTuple


class Script(NamedTuple):
    """A script: its module, and which numbers it makes."""

    module: str
    number: str


SCRIPTS = {
    "speed": Script("speed.speed", "cost of a step"),
    "set_up": Script("speed.set_up", "time of the set-up"),
    "linear": Script("speed.linear", "time of linear analyses"),
    "beside_ross": Script("speed.beside_ross", "beside ROSS"),
    "trade": Script("trade.trade", "accuracy for the time"),
    "against_3d": Script("exudyn_3d.against_3d", "agreement with the 3D body"),
    "full_3d": Script("exudyn_3d.full_3d", "agreement of full bodies with the full 3D body"),
    "peer": Script("peer.table", "the swapped call in scripts of Exudyn's manner"),
    "timoshenko": Script("references.timoshenko", "Timoshenko beam"),
    "benchmarks": Script("references.benchmarks", "published and independently computed rotors"),
    "calculix": Script("references.calculix", "rotating discs of CalculiX's test suite"),
    "branches": Script("branches", "a sweep through a fold beside runs"),
    "film": Script("references.film", "oil films of finite length"),
    "nonlinear": Script("stiffening.nonlinear", "nonlinear solid, clamped blade"),
    "spun_up_blade": Script("stiffening.spun_up_blade", "blade spun up"),
    "blade": Script("stiffening.blade", "rotating beams"),
    "disc": Script("stiffening.disc", "rotating discs"),
    "overhung": Script("stiffening.overhung", "overhung disc"),
    "extremes": Script("extremes.table", "the extremes"),
}


def summary(script: Script) -> str:
    """Return the first line of a script's docstring, without importing it."""
    path = Path(__file__).parent.joinpath(*script.module.split(".")).with_suffix(".py")
    return ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))).splitlines()[0]


def listing() -> str:
    """Return the name, the first line and the numbers of every script."""
    lines = ["python -m validation NAME [options]; --help after a name shows its options", ""]
    for name, script in SCRIPTS.items():
        lines += [f"{name:14} {summary(script)}", f"{'':15}numbers: {script.number}"]
    return "\n".join(lines)


def main() -> object:
    """Run the script that the first argument names; list all without one."""
    name, *options = sys.argv[1:] or ["--help"]
    if name in ("-h", "--help"):
        print(listing())
        return 0
    chosen = [one for one in SCRIPTS if SCRIPTS[one].module.startswith(f"{name}.")]
    chosen = [name] if name in SCRIPTS else chosen
    if not chosen:
        return f"{name!r} is unknown; there are: {', '.join(SCRIPTS)}"
    ends = []
    for one in chosen:
        sys.argv[:] = [f"python -m validation {one}", *options]
        ends.append(importlib.import_module(f"validation.{SCRIPTS[one].module}").main())
    return next((end for end in ends if end), 0)


if __name__ == "__main__":
    sys.exit(main())
