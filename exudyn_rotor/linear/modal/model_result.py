"""What the results of analyses of a linear model have in common."""

from __future__ import annotations

from dataclasses import dataclass, field

from exudyn_rotor import checks
from exudyn_rotor.linear.modal.basis_error import NOT_KNOWN
from exudyn_rotor.linear.model.linear_model import AXES
from exudyn_rotor.results import Result
from exudyn_rotor.theory.stiffening import LEVELS

_SHOWN = 1e-6  # unevenness that is told


@dataclass(frozen=True, eq=False)
class ModelResult(Result):
    """Result of the analysis of a linear model.

    Attributes
    ----------
    stiffening : str or None
        Level of centrifugal stiffening, 'none', 'tilt' or 'full'; None where it is not known.
    axes : {'inertial', 'rotor'}
        In which the equations were solved.
    unevenness : float
        Largest share of a rotor that differs around its axis, as that of a mesh, and was averaged
        over a turn.
    """

    stiffening: str | None = field(default=None, kw_only=True)
    axes: str = field(default="inertial", kw_only=True)
    unevenness: float = field(default=0.0, kw_only=True)

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.stiffening is not None:
            checks.choice(self.stiffening, "stiffening", LEVELS)
        checks.choice(self.axes, "axes", AXES[1:])
        checks.number(self.unevenness, "unevenness", least=0.0)

    def _closing(self, errors: object) -> list[str]:
        """Return the last lines of a table; `errors` of the basis, None where not known."""
        lines = [f"stiffening: {self.stiffening}"] if self.stiffening else []
        if self.unevenness > _SHOWN:
            lines.append(f"unevenness of the mesh, averaged: {self.unevenness:.2g}")
        return lines if errors is not None else [*lines, NOT_KNOWN]
