"""Geometry of a bearing's bore: pads between axial grooves, each an arc with its own centre.

The film over a pad of clearance c_p and centre a has, with the journal at q, the thickness
``h(φ) = c_p − (q − a) · u(φ)``, ``u = (cos φ, sin φ)``; the angle φ counts from n1 to n2, in the
direction of a positive spin. A pad with preload m has its centre beyond that of the bearing,
``a = −m c_p u(φ_m)`` at the angle φ_m of its middle, so that the assembled clearance there is
(1 − m) c_p (T. Someya, *Journal-Bearing Databook*, 1989, ch. 2).
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np
from numpy.typing import ArrayLike

from exudyn_rotor import checks

WHOLE = 2.0 * np.pi


@dataclass(frozen=True, eq=False)
class Pad:
    """An arc of the bore, from one groove to the next.

    Parameters
    ----------
    start : float
        Angle at which it begins, from n1 to n2 [rad].
    arc : float
        Its extent [rad]; 2π is a bore without a groove.
    clearance : float
        Its radius of curvature less the journal's [m].
    center : array_like, (2,), optional
        Its centre of curvature along n1 and n2, from the bearing's centre [m].

    Raises
    ------
    TypeError, ValueError
        For an arc beyond 2π, or a clearance that is not positive.

    Examples
    --------
    >>> from exudyn_rotor import Pad
    >>> lower = Pad(start=3.2, arc=2.9, clearance=1e-4)
    >>> float(lower.clearance)
    0.0001
    """

    start: float
    arc: float
    clearance: float
    center: ArrayLike = (0.0, 0.0)

    def __post_init__(self) -> None:
        checks.number(self.start, "start", "rad")
        checks.number(self.arc, "arc", "rad", above=0.0, most=WHOLE * (1.0 + 1e-12))
        checks.number(self.clearance, "clearance", "m", above=0.0)
        object.__setattr__(self, "center", checks.vector(self.center, "center", "m", 2))

    @property
    def closed(self) -> bool:
        """True for a whole circle: its film has no edges."""
        return self.arc > WHOLE * (1.0 - 1e-12)


def grooved_pads(
    clearance: float,
    grooves: Sequence[float] = (),
    groove_width: float = 0.0,
    preload: float = 0.0,
) -> tuple[Pad, ...]:
    """Return the pads between axial grooves: plain, axial-groove, elliptical and lobed bores.

    Parameters
    ----------
    clearance : float
        Radius of curvature of the pads less the journal's [m].
    grooves : sequence of float, optional
        Angles of the middles of the grooves, ascending within one turn, from n1 to n2 [rad]; none
        for a plain bore. Its film begins where the pressure leaves zero without a slope, in front
        of the widest gap. In most tables it begins at the widest gap, which at ε = 0.1, L/D = 1
        leaves 2 % less load and an attitude smaller by 4°.
    groove_width : float, optional
        Extent of every groove [rad]; of a single one above 0.
    preload : float, optional
        m = 1 − (assembled clearance)/(clearance of the pads), 0 ≤ m < 1; two pads with a preload
        are an elliptical (lemon) bore.

    Returns
    -------
    tuple of Pad

    Raises
    ------
    TypeError, ValueError
        For grooves that overlap, a single one without width, and a preload without grooves.

    Examples
    --------
    Two grooves of 20° on the horizontal line, where n1 points up, and an elliptical bore:

    >>> import numpy as np
    >>> from exudyn_rotor import grooved_pads
    >>> len(grooved_pads(1e-4, [np.pi / 2, 3 * np.pi / 2], np.radians(20.0)))
    2
    >>> lemon = grooved_pads(1e-4, [np.pi / 2, 3 * np.pi / 2], np.radians(20.0), preload=0.5)
    >>> round(float(lemon[0].center[0]), 9)
    5e-05
    """
    checks.number(clearance, "clearance", "m", above=0.0)
    checks.number(groove_width, "groove_width", "rad", least=0.0)
    checks.number(preload, "preload", least=0.0, below=1.0)
    middles = checks.vector(grooves, "grooves", "rad", None)
    if not len(middles):
        if preload > 0.0:
            raise ValueError("preload: needs grooves, which tell one pad from the next")
        return (Pad(0.0, WHOLE, clearance),)
    if len(middles) == 1 and groove_width == 0.0:
        raise ValueError(
            "groove_width: a single groove without width is none; give one above 0 rad"
        )
    arcs = np.diff(middles, append=middles[0] + WHOLE) - groove_width
    if np.any(arcs <= 0.0):
        raise ValueError(
            f"grooves: need ascending angles within one turn, more than groove_width = "
            f"{groove_width:g} rad apart, got {checks.shown(middles)}"
        )
    starts = middles + 0.5 * groove_width
    return tuple(
        Pad(start, arc, clearance, -preload * clearance * direction(start + 0.5 * arc).T)
        for start, arc in zip(starts.tolist(), arcs.tolist(), strict=True)
    )


def direction(angle: ArrayLike) -> np.ndarray:
    """Return (cos φ, sin φ), shape (…, 2)."""
    return np.stack([np.cos(angle), np.sin(angle)], axis=-1)
