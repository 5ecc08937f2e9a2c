"""Units of speeds and frequencies in tables, pictures and files; inside they are rad/s."""

from __future__ import annotations

from dataclasses import dataclass
from typing import Any

import numpy as np

from exudyn_rotor import checks

IN_HERTZ = 0.5 / np.pi  # 1 rad/s
_FACTORS = {"rad/s": 1.0, "Hz": IN_HERTZ, "rpm": 30.0 / np.pi}
_KNOWN = {"SI": ("rad/s", "rad/s"), "Hz": ("Hz", "Hz"), "rpm": ("rpm", "Hz")}
UNITS = tuple(_KNOWN)


@dataclass(frozen=True)
class Units:
    """Units in which speeds and frequencies are shown.

    Attributes
    ----------
    speed, frequency : {'rad/s', 'Hz', 'rpm'}
    """

    speed: str
    frequency: str

    @classmethod
    def of(cls, units: str) -> Units:
        """Return the units of a word.

        'SI' is rad/s, 'Hz' is Hz, 'rpm' has speeds in rpm and frequencies in Hz.

        Raises
        ------
        TypeError, ValueError
            For anything else.

        Examples
        --------
        >>> import numpy as np
        >>> shown = Units.of("rpm")
        >>> shown.speeds(np.pi), shown.frequencies(np.pi), shown.speed
        (30.0, 0.5, 'rpm')
        """
        return cls(*_KNOWN[checks.choice(units, "units", UNITS)])

    def speeds(self, values: Any) -> Any:
        """Return spin speeds [rad/s] in their unit."""
        return values * _FACTORS[self.speed]

    def frequencies(self, values: Any) -> Any:
        """Return frequencies [rad/s] in their unit."""
        return values * _FACTORS[self.frequency]
