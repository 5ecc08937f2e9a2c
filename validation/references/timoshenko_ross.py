"""Reference numbers of Timoshenko-beam rotors, computed by the open package ROSS.

Run it in an environment with ``ross-rotordynamics`` (not needed by anything else here); it writes
``timoshenko_ross.json``, which validation and tests read:

    python validation/references/timoshenko_ross.py

Steel shafts on two isotropic bearings at their ends: a uniform one, and one with two discs. A real
disc is bonded to the shaft over its width and stiffens it there; beam models bracket that: with
the disc's inertia at a point of the bare shaft (too soft), and with a shaft that cannot bend inside
the disc (too stiff).
"""

from __future__ import annotations

import json
from pathlib import Path

import ross

YOUNG, POISSON, DENSITY = 2.1e11, 0.3, 7850.0
UNIFORM = {"length": 1.5, "diameter": 0.05, "bearing_stiffness": 2e7, "elements": 60, "discs": []}
DISC = {"diameter": 0.25, "width": 0.05}
TWO_DISCS = {
    "length": 1.0,
    "diameter": 0.05,
    "bearing_stiffness": 2e7,
    "elements": 40,
    "discs": [0.3, 0.7],
    "disc": DISC,
}
SPEEDS = [0.0, 150.0, 300.0, 450.0, 600.0]
MODES = 6


def steel(stiffening: float = 1.0) -> ross.Material:
    """Return steel, its moduli multiplied by a factor."""
    young = stiffening * YOUNG
    return ross.Material(name="steel", rho=DENSITY, E=young, G_s=young / (2.0 * (1.0 + POISSON)))


def beam_rotor(shaft: dict, rigid_hubs: bool = False) -> ross.Rotor:
    """Return Timoshenko beam elements with rotatory inertia and gyroscopics, discs, bearings."""
    size = shaft["length"] / shaft["elements"]
    elements = []
    for index in range(shaft["elements"]):
        inside = any(abs((index + 0.5) * size - z) < 0.5 * DISC["width"] for z in shaft["discs"])
        elements.append(
            ross.ShaftElement(
                L=size,
                idl=0.0,
                odl=shaft["diameter"],
                material=steel(1e3 if rigid_hubs and inside else 1.0),
                shear_effects=True,
                rotary_inertia=True,
                gyroscopic=True,
            )
        )
    discs = [
        ross.DiskElement.from_geometry(
            n=round(z / size),
            material=steel(),
            width=DISC["width"],
            i_d=shaft["diameter"],
            o_d=DISC["diameter"],
        )
        for z in shaft["discs"]
    ]
    bearings = [
        ross.BearingElement(n=node, kxx=shaft["bearing_stiffness"], cxx=0.0)
        for node in (0, shaft["elements"])
    ]
    return ross.Rotor(elements, discs, bearings)


def lateral_frequencies(rotor: ross.Rotor, speed: float) -> tuple[list[float], list[str]]:
    """Return the lowest lateral frequencies in the inertial frame [rad/s] and their whirl."""
    modal = rotor.run_modal(speed, num_modes=40)
    lateral = [i for i, shape in enumerate(modal.shapes) if shape.mode_type == "Lateral"]
    order = sorted(lateral, key=lambda i: modal.wd[i])[:MODES]
    whirl = modal.whirl_direction()
    return [float(modal.wd[i]) for i in order], [str(whirl[i]) for i in order]


def forward_critical(rotor: ross.Rotor, pair: int) -> float:
    """Return the speed that equals the frequency of the forward mode of a pair [rad/s]."""
    speed = lateral_frequencies(rotor, 0.0)[0][2 * pair]
    for _ in range(8):  # gyroscopic splitting is small, so the fixed point is reached fast
        speed = lateral_frequencies(rotor, speed)[0][2 * pair + 1]
    return speed


def reference(shaft: dict, rigid_hubs: bool = False) -> dict:
    """Return frequencies over speed and forward critical speeds of one shaft."""
    rotor = beam_rotor(shaft, rigid_hubs)
    rows = [lateral_frequencies(rotor, speed) for speed in SPEEDS]
    return {
        "shaft": shaft,
        "frequencies": [row[0] for row in rows],
        "whirl": [row[1] for row in rows],
        "forward_critical_speeds": [forward_critical(rotor, pair) for pair in range(MODES // 2)],
    }


def main() -> None:
    """Write the reference file."""
    script = "validation/references/timoshenko_ross.py"
    data = {
        "source": f"ross-rotordynamics {ross.__version__}, {script}",
        "material": {"youngsModulus": YOUNG, "poissonsRatio": POISSON, "density": DENSITY},
        "speeds": SPEEDS,
        "uniform": reference(UNIFORM),
        "two discs, points": reference(TWO_DISCS),
        "two discs, rigid hubs": reference(TWO_DISCS, rigid_hubs=True),
    }
    target = Path(__file__).with_suffix(".json")
    target.write_text(json.dumps(data, indent=1) + "\n")
    print(target.read_text())


if __name__ == "__main__":
    main()
