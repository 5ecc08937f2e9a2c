"""Objects with the attributes of ROSS 2.3.0's, and numbers that ROSS gives for them."""

from types import SimpleNamespace

import numpy as np

STEEL = SimpleNamespace(name="Steel", E=2.11e11, G_s=8.12e10, rho=7810.0)
# lateral frequencies of `example()` at 0 and 300 rad/s, by run_modal [rad/s]
EXAMPLE = {
    0.0: [91.80, 96.29, 274.57, 296.50, 722.90, 765.00],
    300.0: [91.71, 96.35, 270.61, 300.34, 690.30, 794.56],
}


class ShaftElement(SimpleNamespace):
    """A section of the shaft; the reader looks at the name of the class."""


def bearing(node: int, frequency=None, **coefficients: float) -> SimpleNamespace:
    """Return a bearing; with `frequency`, each coefficient is linear between its two values."""
    names = [f"{letter}{xy}" for letter in "kcm" for xy in ("xx", "xy", "yx", "yy", "zz")]
    values = {name: np.atleast_1d(coefficients.get(name, 0.0)) for name in names}
    curves = {
        f"{name}_interpolated": lambda s, v=v: np.interp(s, frequency, np.resize(v, 2))
        for name, v in values.items()
    }
    tag = f"Bearing {node}"
    return SimpleNamespace(n=node, n_link=None, tag=tag, frequency=frequency, **values, **curves)


def example(count: int = 6) -> SimpleNamespace:
    """Return ross.rotor_example(): two discs on a steel shaft of 1.5 m, bearings at the ends."""
    size = {"L": 1.5 / count, "idl": 0.0, "idr": 0.0, "odl": 0.05, "odr": 0.05, "material": STEEL}
    shaft = [ShaftElement(n=i, **size) for i in range(count)]
    disc = {"m": 32.58972765, "Ip": 0.32956362, "Id": 0.17808928}
    ends = {"kxx": 1e6, "kyy": 0.8e6}
    return SimpleNamespace(
        shaft_elements=shaft,
        disk_elements=[SimpleNamespace(n=n * count // 6, **disc) for n in (2, 4)],
        bearing_elements=[bearing(0, **ends), bearing(count, **ends)],
        point_mass_elements=[],
        nodes=list(range(count + 1)),
        nodes_pos=np.linspace(0.0, 1.5, count + 1),
    )
