"""List the scripts of this folder, or run one: ``python -m validation NAME …``."""

from __future__ import annotations

import ast
import importlib
import sys
from pathlib import Path
from typing import NamedTuple


class Script(NamedTuple):
    """A script: its module, how long it takes on one core, and which numbers in README it makes."""

    module: str
    time: str
    number: str


SCRIPTS = {
    "speed": Script("speed.speed", "10 min", "cost of a step"),
    "ablation": Script("speed.ablation", "5 min", "cost of each ingredient of a scene"),
    "set_up": Script("speed.set_up", "5 min", "time of the set-up"),
    "trade": Script("trade.trade", "1 h", "accuracy for the time"),
    "against_3d": Script("exudyn_3d.against_3d", "10 min", "agreement with the 3D body"),
    "conical": Script("exudyn_3d.conical", "2 min", "conical frequencies"),
    "timoshenko": Script("references.timoshenko", "2 min", "Timoshenko beam"),
    "nonlinear": Script("stiffening.nonlinear", "2 min", "nonlinear solid, clamped blade"),
    "spun_up_blade": Script("stiffening.spun_up_blade", "10 min", "blade spun up"),
    "blade": Script("stiffening.blade", "5 min", "rotating beams"),
    "disc": Script("stiffening.disc", "5 min", "rotating discs"),
    "overhung": Script("stiffening.overhung", "2 min", "overhung disc"),
    "extremes": Script("extremes.table", "5 min", "the extremes"),
    "savers": Script("savers", "1 min", "no file lost"),
    "kernels": Script("kernels", "20 min", ""),
    "mutations": Script("mutations.run", "1 h", ""),
    "bad_calls": Script("bad_calls.report", "1 h", ""),
}


def summary(script: Script) -> str:
    """Return the first line of a script's docstring, without importing it."""
    path = Path(__file__).parent.joinpath(*script.module.split(".")).with_suffix(".py")
    return ast.get_docstring(ast.parse(path.read_text(encoding="utf-8"))).splitlines()[0]


def listing() -> str:
    """Return name, time and first line of every script."""
    lines = ["python -m validation NAME [options]; --help after a name shows its options", ""]
    for name, script in SCRIPTS.items():
        lines.append(f"{name:14} {script.time:>7}  {summary(script)}")
        if script.number:
            lines.append(f"{'':24}README: {script.number}")
    return "\n".join(lines)


def main() -> object:
    """Run the script that the first argument names; list all without one."""
    name, *options = sys.argv[1:] or ["--help"]
    if name in ("-h", "--help"):
        print(listing())
        return 0
    if name not in SCRIPTS:
        return f"{name!r} is unknown; there are: {', '.join(SCRIPTS)}"
    sys.argv[:] = [f"python -m validation {name}", *options]
    return importlib.import_module(f"validation.{SCRIPTS[name].module}").main()


if __name__ == "__main__":
    sys.exit(main())
