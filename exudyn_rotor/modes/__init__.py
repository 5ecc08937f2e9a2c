"""Mode bases of a rotor."""

from exudyn_rotor.modes.component import ModeBasis, free_modes
from exudyn_rotor.modes.craig_bampton import craig_bampton_modes
from exudyn_rotor.modes.fem_interface import fem_interface_modes
from exudyn_rotor.modes.spinning import spinning_modes

__all__ = [
    "ModeBasis",
    "craig_bampton_modes",
    "fem_interface_modes",
    "free_modes",
    "spinning_modes",
]
