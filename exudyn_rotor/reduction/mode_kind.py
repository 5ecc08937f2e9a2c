"""What the columns of a reduced basis are."""

from __future__ import annotations

from collections.abc import Sequence
from enum import Enum


class ModeKind(Enum):
    """What a column of a reduced basis is; the value names it for people.

    The translations and tilts 1 and 2 are along and about n1 and n2 of
    :attr:`exudyn_rotor.SpinAxis.plane`, rotations about an axis through the centre of mass.

    Examples
    --------
    >>> [kind.value for kind in ModeKind if kind.is_tilt]
    ['tilt 1', 'tilt 2']
    """

    TRANSLATION_1 = "translation 1"
    TRANSLATION_2 = "translation 2"
    AXIAL = "translation along axis"
    SPIN = "spin"
    TILT_1 = "tilt 1"
    TILT_2 = "tilt 2"
    FREE = "free motion"  # any rigid motion that a grounded rotor still has
    ELASTIC = "mode"

    @property
    def is_tilt(self) -> bool:
        """True for the two tilts."""
        return self in (ModeKind.TILT_1, ModeKind.TILT_2)


# in the order of the columns of every rotor that nothing holds
RIGID_KINDS = tuple(kind for kind in ModeKind if kind not in (ModeKind.FREE, ModeKind.ELASTIC))


def rigid_names(kinds: Sequence[ModeKind]) -> tuple[str, ...]:
    """Return the names of rigid motions; those of a grounded rotor are numbered."""
    return tuple(
        f"{kind.value} {number}" if kind is ModeKind.FREE else kind.value
        for number, kind in enumerate(kinds, start=1)
    )
