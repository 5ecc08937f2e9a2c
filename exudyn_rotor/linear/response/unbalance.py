"""Unbalances, and the balance quality grades of ISO 21940-11.

Source: ISO 21940-11:2016, "Mechanical vibration — Rotor balancing — Part 11: Procedures and
tolerances for rotors with rigid behaviour", Sect. 5 and 6: grade G = e_per Ω in mm/s, with the
permissible residual specific unbalance e_per and the highest service speed Ω.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from exudyn_rotor import checks


def permissible_unbalance(grade: float, mass: float, speed: float) -> float:
    """Return the permissible residual unbalance of a rotor, ``U = G m / Ω`` [kg m].

    Parameters
    ----------
    grade : float
        Balance quality grade G [mm/s]: 2.5 for G 2.5.
    mass : float
        Mass of the rotor [kg].
    speed : float
        Highest service speed [rad/s].

    Raises
    ------
    TypeError, ValueError
        If one of them is not a positive number.

    Examples
    --------
    >>> from exudyn_rotor import permissible_unbalance
    >>> permissible_unbalance(2.5, mass=40.0, speed=500.0)
    0.0002
    """
    grade = checks.number(grade, "grade", "mm/s", above=0.0)
    mass = checks.number(mass, "mass", "kg", above=0.0)
    speed = checks.number(speed, "speed", "rad/s", above=0.0)
    return 1e-3 * grade * mass / speed


@dataclass(frozen=True)
class Unbalance:
    """A small excess mass at a radius: a load ``Ω² U`` that stands still in the rotor frame.

    Parameters
    ----------
    at : str, int, or sequence of three floats
        Interface, mesh node, or the node nearest to a position in mesh coordinates [m]. Where on
        the radius the mass sits is in the amount already: the load acts on the mean motion of the
        interface.
    amount : float
        Mass times eccentricity U [kg m], positive.
    angle : float, optional
        Direction in the rotor frame, from n1 to n2 of :attr:`SpinAxis.plane` [rad].

    Raises
    ------
    TypeError, ValueError
        If the place is of another kind, the amount not positive, or a number not finite.

    Examples
    --------
    >>> from exudyn_rotor import Unbalance
    >>> Unbalance.from_grade("disc", 2.5, mass=40.0, speed=500.0, share=0.5)
    Unbalance(at='disc', amount=0.0001, angle=0.0)
    """

    at: str | int | Sequence[float]
    amount: float
    angle: float = 0.0

    def __post_init__(self) -> None:
        object.__setattr__(self, "at", checks.place(self.at, "at"))
        where = f"unbalance at {self.at!r}"
        amount = checks.number(self.amount, f"{where}: amount", "kg m")
        if amount <= 0.0:
            raise ValueError(
                f"{where}: amount needs a positive number [kg m], got {self.amount!r}; turn it by "
                "its angle, leave it out if there is none"
            )
        object.__setattr__(self, "amount", amount)
        angle = checks.number(self.angle, f"{where}: angle", "rad")
        object.__setattr__(self, "angle", angle)

    @classmethod
    def from_grade(
        cls,
        at: str | int | Sequence[float],
        grade: float,
        mass: float,
        speed: float,
        *,
        angle: float = 0.0,
        share: float = 1.0,
    ) -> Unbalance:
        """Return the largest unbalance that a balance quality grade permits.

        Parameters
        ----------
        at : str, int, or sequence of three floats
        grade, mass, speed : float
            See :func:`permissible_unbalance`.
        angle : float, optional
            In the rotor frame [rad].
        share : float, optional
            Part of the whole in this plane: 0.5 where two tolerance planes lie at equal distances
            from the centre of mass (ISO 21940-11:2016, Sect. 7).

        Raises
        ------
        TypeError, ValueError
            If `share` is not between 0 and 1, or another argument is refused.
        """
        share = checks.number(share, "share", above=0.0, most=1.0)
        return cls(at, share * permissible_unbalance(grade, mass, speed), angle)

    def __str__(self) -> str:
        """Return place, amount [g mm] and angle [deg] in words."""
        amount, angle = 1e6 * self.amount, np.degrees(self.angle)
        return f"unbalance of {amount:.4g} g mm at {self.at!r}, angle {angle:.4g} deg"

    @property
    def vector(self) -> np.ndarray:
        """Unbalance along (n1, n2, e), rotor frame, shape (3,) [kg m]."""
        return self.amount * np.array([np.cos(self.angle), np.sin(self.angle), 0.0])
