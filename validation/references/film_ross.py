"""Write ``film_ross.json``: journal bearings of finite length by the open package ROSS.

Run in an environment with ross-rotordynamics 2.3.0 and plotly 5: ``python film_ross.py``. Its
`PlainJournal` gets an oil of constant viscosity, so that it is isothermal, and floods the bore:
negative pressures are cut. Axes x, y with the load in −y; two pads of 160° about ±y.

``equilibria``: where ROSS finds them. ``grids``, ``turned``: force and coefficients with the
journal held at a place, on several grids, and on two of them at eight places by quarters of an
element.
"""

import json
from pathlib import Path

import numpy as np
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


BORES = [  # with the place where a load of 5000 N is in balance: ratio, angle from x [rad]
    {"geometry": "circular", "preload": 0.0, "place": [0.6691, -0.8405]},
    {"geometry": "lobe", "preload": 0.5, "place": [0.9768, -0.5407]},
]
GRIDS = [(n, 10) for n in range(40, 121, 10)] + [(60, 14), (60, 20), (60, 28), (120, 14)]
TURNED = [(60, 10), (120, 10)]


class Held(PlainJournal):
    """The bearing with its journal held at a place (ratio, angle)."""

    def __init__(self, place: list[float], **options) -> None:
        self.place = place
        super().__init__(**options)

    def run_thermo_hydro_dynamic(self, speed: float) -> None:
        """Take the place instead of a search for the equilibrium."""
        self.equilibrium_pos = np.array(self.place)
        self._equilibrium_pos_by_speed[float(speed)] = self.equilibrium_pos
        self._forces(self.equilibrium_pos, speed)


def options(bore: dict, elements: tuple[int, int], load: float) -> dict:
    """Return what both kinds of bearing are made of."""
    return {
        "n": 0,
        "axial_length": LENGTH,
        "journal_radius": RADIUS,
        "radial_clearance": CLEARANCE,
        "elements_circumferential": elements[0],
        "elements_axial": elements[1],
        "n_pad": 2,
        "pad_arc_length": 160,
        "preload": bore["preload"],
        "geometry": bore["geometry"],
        "reference_temperature": 50,
        "frequency": [SPEED],
        "fxs_load": 0.0,
        "fys_load": -load,
        "groove_factor": [0.5, 0.5],
        "lubricant": OIL,
        "initial_guess": [0.6, -0.8],
        "oil_supply_pressure": 0,
        "oil_flow_v": 1e-4,
    }


def coefficients(found: PlainJournal) -> dict:
    """Return stiffness and damping, each xx, xy, yx, yy."""
    names = ("xx", "xy", "yx", "yy")
    return {
        "stiffness": [float(getattr(found, f"k{name}")[0]) for name in names],
        "damping": [float(getattr(found, f"c{name}")[0]) for name in names],
    }


def solved(case: dict, elements: tuple[int, int]) -> dict:
    """Return eccentricity ratio, angle from x, stiffness and damping of one case."""
    found = PlainJournal(**options(case, elements, case["load"]), method=case["method"])
    ratio, angle = (float(value) for value in found.equilibrium_pos)
    return {
        **case,
        "elements": list(elements),
        "ratio": ratio,
        "angle": angle,
        **coefficients(found),
    }


def held(bore: dict, elements: tuple[int, int], turn: float = 0.0) -> dict:
    """Return the force on the journal and the coefficients, scaled to 5000 N, at one place."""
    place = [bore["place"][0], bore["place"][1] + turn]
    found = Held(place, **options(bore, elements, 5000.0), method="perturbation")
    return {
        **bore,
        "place": place,
        "elements": list(elements),
        "force": [float(f) for f in found._forces(np.array(place), SPEED)],
        **coefficients(found),
    }


if __name__ == "__main__":
    path = Path(__file__).with_name("film_ross.json")
    arc = np.radians(160.0)
    found = {
        "equilibria": [
            solved(case, (80, 10) if case["geometry"] == "lobe" else (40, 10)) for case in CASES
        ],
        "grids": [held(bore, elements) for bore in BORES for elements in GRIDS],
        "turned": [
            held(bore, elements, quarter * arc / elements[0] / 4)
            for bore in BORES
            for elements in TURNED
            for quarter in range(8)
        ],
    }
    lines = {key: ",\n  ".join(map(json.dumps, cases)) for key, cases in found.items()}
    text = ",\n".join(f' "{key}": [\n  {cases}\n ]' for key, cases in lines.items())
    path.write_text(f"{{\n{text}\n}}\n")
