"""Write ``film_ross.json``: journal bearings of finite length by the open package ROSS.

Run in an environment with ros-rotordynamics 2.3.0: ``python film_ross.py``. Its `PlainJournal` gets
an oil of constant viscosity, so that it is isothermal, and floods the bore: negative pressures are
cut. Axes x, y with the load in −y; two pads of 160° about ±y.
"""

import json
from pathlib import Path

from ross.bearings.plain_journal import PlainJournal

RADIUS, CLEARANCE, LENGTH, VISCOSITY, SPEED = 0.05, 1e-4, 0.05, 0.02, 300.0
OIL = {
    "liquid_viscosity1": VISCOSITY,
    "temperature1": 313.15,
    "liquid_viscosity2": VISCOSITY * (1.0 - 1e-12),
    "temperature2": 373.15,
    "liquid_density": 870.0,
    "liquid_specific_heat": 1950.0,
    "liquid_thermal_conductivity": 0.13,
}
CASES = [
    {"geometry": "circular", "preload": 0.0, "load": 4500.0, "method": "perturbation"},
    {"geometry": "circular", "preload": 0.0, "load": 5000.0, "method": "perturbation"},
    {"geometry": "circular", "preload": 0.0, "load": 5500.0, "method": "perturbation"},
    {"geometry": "circular", "preload": 0.0, "load": 5000.0, "method": "lund"},
    {"geometry": "lobe", "preload": 0.5, "load": 5000.0, "method": "perturbation"},
]


def solved(case: dict, circumferential: int, axial: int) -> dict:
    """Return eccentricity ratio, angle from x, stiffness and damping of one case."""
    found = PlainJournal(
        n=0,
        axial_length=LENGTH,
        journal_radius=RADIUS,
        radial_clearance=CLEARANCE,
        elements_circumferential=circumferential,
        elements_axial=axial,
        n_pad=2,
        pad_arc_length=160,
        preload=case["preload"],
        geometry=case["geometry"],
        reference_temperature=50,
        frequency=[SPEED],
        fxs_load=0.0,
        fys_load=-case["load"],
        groove_factor=[0.5, 0.5],
        lubricant=OIL,
        initial_guess=[0.6, -0.8],
        method=case["method"],
        oil_supply_pressure=0,
        oil_flow_v=1e-4,
    )
    ratio, angle = (float(value) for value in found.equilibrium_pos)
    names = ("xx", "xy", "yx", "yy")
    return {
        **case,
        "elements": [circumferential, axial],
        "ratio": ratio,
        "angle": angle,
        "stiffness": [float(getattr(found, f"k{name}")[0]) for name in names],
        "damping": [float(getattr(found, f"c{name}")[0]) for name in names],
    }


if __name__ == "__main__":
    path = Path(__file__).with_name("film_ross.json")
    found = [
        solved(case, *((80, 10) if case["geometry"] == "lobe" else (40, 10))) for case in CASES
    ]
    path.write_text(json.dumps(found, indent=1) + "\n")
