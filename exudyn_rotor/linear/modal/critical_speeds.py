"""Critical speeds of a rotor.

The equations are in :mod:`exudyn_rotor.linear.modal.resonance`.
"""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.bearings.support import Support
from exudyn_rotor.linear import options
from exudyn_rotor.linear.modal.hermitian_zeros import same_speed
from exudyn_rotor.linear.modal.listing import signed_diameters
from exudyn_rotor.linear.modal.resonance import Resonance, resonances
from exudyn_rotor.linear.modal.whirl import WHIRLS, WhirlContent
from exudyn_rotor.linear.models.basis.basis_error import NOT_KNOWN, BasisError, in_table
from exudyn_rotor.linear.models.linear_model import (
    Target,
    linear_model,
    warn_of_left_out_stiffening,
)
from exudyn_rotor.linear.models.protocol import LinearModel
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.results import Result, numbers, storable, words
from exudyn_rotor.theory.stiffening import LEVELS
from exudyn_rotor.units import Units

JUDGED = 6  # critical speeds that count where no largest speed is given


@storable
@dataclass(frozen=True, eq=False)
class CriticalSpeeds(Result):
    """Critical speeds, ascending.

    Attributes
    ----------
    order : float
        Excitation order p: the excitation has the frequency pΩ in the inertial frame.
    speeds : ndarray, shape (c,)
        [rad/s]
    frequencies_rotor : ndarray, shape (c,)
        Frequency of the motion in the rotor frame [rad/s].
    whirl : tuple of str
        Words of :attr:`Campbell.whirl`; unbalance alone excites no purely backward mode.
    nodal_diameters : ndarray of int, shape (c,)
    splits : ndarray, shape (c,), or None
        A pair that an uneven mesh or shaft splits by less than 1 % is listed once, by the lower
        speed; the upper one is ``speeds · (1 + splits)``. 0 for single ones.
    vectors : ndarray, shape (k, c)
        Mode shapes in the coordinates of the rotor frame, unit length; the strongest harmonic.
    basis_errors : ndarray, shape (c,), or None
        Estimated relative errors by the basis of a reduced rotor; NaN above the lowest six where
        no largest speed was given, None where they are not known.
    stiffening : str or None
        Level of centrifugal stiffening, 'none', 'tilt' or 'full'; None where it is not known.

    Examples
    --------
    >>> from exudyn_rotor import CriticalSpeeds
    >>> result = CriticalSpeeds(1.0, [100.0], [0.0], ("forward",), [1], [[1.0]])
    >>> print(result.table())
    undamped critical speeds of order 1
      [rad/s]      [Hz]        n  whirl
      100          15.9155     1  forward
    error of the basis: not known
    """

    order: float
    speeds: np.ndarray = numbers("speeds")
    frequencies_rotor: np.ndarray = numbers("speeds")
    whirl: tuple[str, ...] = words("speeds")
    nodal_diameters: np.ndarray = numbers("speeds", dtype=int, least=-1)
    vectors: np.ndarray = numbers("coordinates", "speeds", dtype=complex)
    stiffening: str | None = None
    splits: np.ndarray | None = numbers("speeds", optional=True)
    basis_errors: np.ndarray | None = numbers("speeds", finite=False, optional=True)

    def __post_init__(self) -> None:
        super().__post_init__()
        if self.stiffening is not None:
            checks.choice(self.stiffening, "stiffening", LEVELS)
        checks.labels(self.whirl, "whirl", WHIRLS)

    def columns(self, units: str = "SI") -> dict[str, np.ndarray]:
        """Return the table as columns; `units` are those of :meth:`table`."""
        shown = Units.of(units)
        rotor = shown.frequencies(self.frequencies_rotor)
        errors = self.basis_errors
        return {
            f"critical speed [{shown.speed}]": shown.speeds(self.speeds),
            f"frequency in the rotor frame [{shown.frequency}]": rotor,
            "nodal diameters": self.nodal_diameters,
            "whirl": np.array(self.whirl),
            "split": np.zeros(len(self.whirl)) if self.splits is None else self.splits,
            "basis error": np.full(len(self.whirl), np.nan) if errors is None else errors,
        }

    def table(self, *, units: str = "SI") -> str:
        """Return the critical speeds as lines of text.

        The error of the basis is '-' where it is not estimated, see :attr:`basis_errors`.

        Parameters
        ----------
        units : {'SI', 'rpm', 'Hz'}
            Of the first column, 'SI' rad/s; the second one is in Hz.
        """
        shown = Units.of(units)
        unit = f"[{shown.speed}]"
        errors = self.basis_errors
        reduced = errors is not None and np.any(errors > 0.0)
        label = "      basis error" if reduced else ""
        lines = [
            f"undamped critical speeds of order {self.order:g}",
            f"  {unit:<11}  [Hz]        n  whirl{label}",
        ]
        for i, (speed, n) in enumerate(zip(self.speeds, self.nodal_diameters, strict=True)):
            count, hertz = n if n >= 0 else "-", speed / (2.0 * np.pi)
            word = f"{self.whirl[i]:<9}  {in_table(errors[i]):<7}" if reduced else self.whirl[i]
            split = 0.0 if self.splits is None else self.splits[i]
            word += f"  pair, the other {split:.1e} above" if split > 0.0 else ""
            lines.append(
                f"  {shown.speeds(speed):<11.6g}  {hertz:<10.6g}  {count}  {word}".rstrip()
            )
        if not self.speeds.size:
            lines.append("  none")
        if self.stiffening:
            lines.append(f"stiffening: {self.stiffening}")
        return "\n".join(lines if errors is not None else [*lines, NOT_KNOWN])


def critical_speeds(
    target: Target,
    *,
    supports: Sequence[Support] = (),
    body: RotorBody | Sequence[RotorBody] | None = None,
    order: float = 1.0,
    max_speed: float | None = None,
    nodal_diameters: Sequence[int] = (0, 1),
    stiffening: str = "auto",
    tolerance: float = 1e-9,
    residual: float = 1e-5,
    accuracy: float | None = 1e-2,
) -> CriticalSpeeds:
    """Compute the undamped critical speeds of a rotor on supports, or of a scene.

    Damping, also structural, and the skew part of the supports' stiffness do not take part; in a
    scene the skew part of damping, as of an annular seal, does no work and stays.

    Parameters
    ----------
    target : ReducedRotor, SolidRotor, exudyn.MainSystem or linear model
        See :func:`linear_model`.
    supports : sequence of Support, optional
        Of a rotor.
    body : RotorBody or sequence of these, optional
        The rotor in a scene, or all of several, see :func:`linear_model`.
    order : float, optional
        Excitation order p ≥ 0 in the inertial frame; 1 for unbalance, 0 for a load at rest.
    max_speed : float, optional
        Largest speed of interest [rad/s]; needed for a scene, for a large SolidRotor and for
        supports that depend on the speed or an initial displacement: there the zeros are
        bracketed at 200 speeds up to it and ten below these, and two of one mode that are closer
        than a 200th of it may be missed. Where tables begin above 0 rad/s, speeds from there on
        are looked at, with a warning.
    nodal_diameters : sequence of int, optional
        Which waves may be excited: 0 for axial and torsional motion, 1 for bending and tilting.
    stiffening : {'auto', 'none', 'tilt', 'full'}
    tolerance : float, optional
        Largest relative change of a critical speed by further harmonics.
    residual : float, optional
        Largest relative residual of a large SolidRotor; its critical speeds err by about the
        square.
    accuracy : float, optional
        Relative error of a critical speed by the basis of a reduced rotor, estimated, above which
        a warning is given. It looks at the speeds up to `max_speed`; without, at the lowest six.
        None for no estimate.

    Raises
    ------
    TypeError
        If the target, the body or a support is of another kind.
    ValueError
        For an order or speed that is negative or not finite, a missing `max_speed`, an unknown
        interface, or harmonics that do not die away.

    Examples
    --------
    >>> import numpy as np
    >>> from exudyn_rotor import SolidRotor, Support, critical_speeds
    >>> rod = 1e8 * np.kron([[1, -1], [-1, 1]], np.diag([0.0, 0.0, 1.0]))
    >>> nodes = [[0.0, 0.0, -0.1], [0.0, 0.0, 0.1]]  # two masses of 2 kg on a rod
    >>> rotor = SolidRotor.from_matrices(2.0 * np.eye(6), rod, nodes, "z")
    >>> rotor = rotor.with_interface("left", [0]).with_interface("right", [1])
    >>> supports = [Support(name, 2e4, damping=10.0) for name in ("left", "right")]
    >>> print(critical_speeds(rotor, supports=supports, nodal_diameters=[1]).table())
    undamped critical speeds of order 1
      [rad/s]      [Hz]        n  whirl
      100          15.9155     1  backward
      100          15.9155     1  backward
      100          15.9155     1  forward
      100          15.9155     1  forward
    stiffening: tilt
    """
    order, max_speed, waves = checked(order, max_speed, nodal_diameters)
    tolerance = options.accuracy(tolerance, "tolerance")
    residual = options.accuracy(residual, "residual")
    options.check_basis_accuracy(accuracy)
    model = linear_model(target, supports=supports, body=body, stiffening=stiffening).undamped()
    basis = BasisError.of(model, accuracy)
    result = critical_speeds_of(
        model, WhirlContent.of(model), order, waves, max_speed, tolerance, residual, basis
    )
    if result.basis_errors is not None:
        warn_of_critical(basis, result.speeds, result.basis_errors)
    return result


def warn_of_critical(basis: BasisError, speeds: np.ndarray, errors: np.ndarray) -> None:
    """Warn where the basis leaves out too much for some critical speed [rad/s]."""
    if np.any(errors > 0.0):
        worst = Units.of("rpm").speeds(speeds.flat[np.nanargmax(errors)])
        basis.warn(np.nan_to_num(errors), f"the critical speed of {worst:.5g} rpm")


def critical_speeds_of(
    model: LinearModel,
    content: WhirlContent,
    order: float,
    waves: Sequence[int],
    max_speed: float | None,
    tolerance: float = 1e-9,
    residual: float = 1e-5,
    basis: BasisError | None = None,
) -> CriticalSpeeds:
    """Return the critical speeds of an undamped model; arguments as :func:`checked` returns them.

    The `content` is that of the rotor, whatever its supports are.
    """
    critical = resonances(model, content, order, waves, max_speed, tolerance, residual)
    if critical:
        fastest = critical[0].speed if max_speed is None else max_speed
        warn_of_left_out_stiffening(model, fastest)
    errors = None
    if basis is not None and basis.is_known:
        errors = np.full(len(critical), np.nan)
        count = len(critical) if max_speed is not None else JUDGED
        errors[:count] = basis.critical_errors([entry.motions for entry in critical[:count]])
    return _collected(critical, content, order, model, errors)


def checked(
    order: float, max_speed: float | None, nodal_diameters: Sequence[int]
) -> tuple[float, float | None, list[int]]:
    """Return order and largest speed, and the signed waves to look for."""
    order = checks.number(order, "order", least=0.0)
    if max_speed is not None:
        max_speed = checks.number(max_speed, "max_speed", "rad/s", above=0.0)
    return order, max_speed, _waves(nodal_diameters, order)


def _waves(nodal_diameters: Sequence[int], order: float) -> list[int]:
    """Return the signed waves to look for; at order 0 a motion and its conjugate are one."""
    values = checks.whole_numbers(nodal_diameters, "nodal_diameters", most=4)
    if not values.size:
        raise ValueError("nodal_diameters: needs at least one whole number from 0 to 4, got none")
    counts = sorted({int(n) for n in values})
    backward = [-n for n in counts if n > 0 and order > 0.0]
    return counts + backward


def _collected(
    critical: list[Resonance],
    content: WhirlContent,
    order: float,
    model: LinearModel,
    basis_errors: np.ndarray | None,
) -> CriticalSpeeds:
    count = len(critical)
    speeds = np.array([entry.speed for entry in critical])
    codes, diameters = np.zeros(count, dtype=np.int64), np.zeros(count, dtype=np.int64)
    # together where the harmonics are the same, which is faster
    alike: dict[bytes, list[int]] = {}
    for index, entry in enumerate(critical):
        alike.setdefault(entry.multiples.tobytes(), []).append(index)
    for group in alike.values():
        vectors = np.stack([critical[index].vectors for index in group], axis=2)
        multiples = critical[group[0]].multiples
        _, codes[group], diameters[group] = content.classify(
            vectors, multiples, np.zeros(len(group)), speeds[group]
        )
    places = _places(speeds, codes, diameters)
    critical = [critical[place] for place in places]
    strongest = [np.argmax(np.linalg.norm(entry.vectors, axis=1)) for entry in critical]
    rates = [abs(entry.multiples[row]) for entry, row in zip(critical, strongest, strict=True)]
    shapes = [entry.vectors[row] for entry, row in zip(critical, strongest, strict=True)]
    return CriticalSpeeds(
        order=order,
        speeds=speeds,
        frequencies_rotor=np.array(rates) * speeds,
        whirl=tuple(WHIRLS[codes[place]] for place in places),
        nodal_diameters=diameters[places],
        vectors=np.array(shapes, dtype=complex).reshape(-1, model.size).T,
        stiffening=model.stiffening,
        splits=np.array([entry.split for entry in critical]),
        basis_errors=None if basis_errors is None else basis_errors[places],
    )


def _places(speeds: np.ndarray, codes: np.ndarray, diameters: np.ndarray) -> np.ndarray:
    """Return the order of rows: by speed, those of one speed from backward to forward waves.

    Rounding would order the latter by chance; what moves them apart is left in `speeds`.
    """
    groups = same_speed(list(range(len(speeds))), speeds.__getitem__)
    senses = signed_diameters(codes, diameters)
    return np.array([i for group in groups for i in sorted(group, key=senses.__getitem__)], int)
