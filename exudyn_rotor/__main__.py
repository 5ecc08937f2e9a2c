"""Command line: ``python -m exudyn_rotor demo``."""

from __future__ import annotations

import argparse

from exudyn_rotor.demo import run_demo


def main(arguments: list[str] | None = None) -> None:
    """Read the command line and run what it asks for."""
    parser = argparse.ArgumentParser(prog="python -m exudyn_rotor")
    commands = parser.add_subparsers(dest="command", required=True)
    demo = commands.add_parser("demo", help="compare the fixed-axis rotor with the 3D body")
    demo.add_argument(
        "--output", default="exudyn-rotor-demo", help="folder for the pictures (%(default)s)"
    )
    demo.add_argument("--quick", action="store_true", help="coarse mesh, a tenth of the time")
    options = parser.parse_args(arguments)
    run_demo(options.output, quick=options.quick)


if __name__ == "__main__":
    main()
