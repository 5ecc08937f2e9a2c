"""Critical speeds of a rotor; the equations are in :mod:`exudyn_rotor.linear.modal.resonance`."""

from __future__ import annotations

from collections.abc import Sequence
from dataclasses import dataclass

import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.bearings.given import Given
from exudyn_rotor.foundations.foundation import Foundation
from exudyn_rotor.linear.modal import basis_error
from exudyn_rotor.linear.modal.resonance import (
    NO_EQUATIONS,
    Resonance,
    Search,
    Stiffness,
    groups_of,
)
from exudyn_rotor.linear.modal.whirl import WHIRLS, Content, signed_diameters
from exudyn_rotor.linear.model.build import Target, linear_model, warn_of_left_out_stiffening
from exudyn_rotor.linear.model.linear_model import LinearModel
from exudyn_rotor.linear.over import ModelResult, basis_column, table_lines
from exudyn_rotor.linear.solve.motions import Motions
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.results import numbers, storable, words
from exudyn_rotor.solvers.factor import one_thread
from exudyn_rotor.units import Units

_JUDGED = 6  # critical speeds that count where no largest speed is given
_ALIKE = 0.5  # likeness of two shapes below which they are not the same motion
_BESIDE, _ERROR = 0.97, 1e-6  # of a critical speed: where its change is told, and its error


@storable
@dataclass(frozen=True, eq=False)
class CriticalSpeeds(ModelResult):
    """Critical speeds, ascending; an uneven rotor has both of a pair, from 0.5 % apart on.

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
    vectors : ndarray, shape (k, c)
        Mode shapes in the coordinates of the model, unit length; the strongest harmonic.
    basis_errors : ndarray, shape (c,), or None
        Estimated relative errors by the basis of a reduced rotor; NaN above the lowest six where
        no largest speed was given, None where they are not known.
    stiffening, axes, unevenness
        See :class:`Stability`; :attr:`vectors` are in these axes.

    Examples
    --------
    >>> from exudyn_rotor import CriticalSpeeds
    >>> result = CriticalSpeeds(1.0, [100.0], [0.0], ("forward",), [1], [[1.0]])
    >>> print(result.table())
    undamped critical speeds of order 1
    critical speed [rpm]  inertial [Hz]  rotor frame [Hz]  n  whirl
                  954.93        15.9155                 0  1  forward
    error of the basis: not known
    """

    order: float
    speeds: np.ndarray = numbers("speeds")
    frequencies_rotor: np.ndarray = numbers("speeds")
    whirl: tuple[str, ...] = words("speeds")
    nodal_diameters: np.ndarray = numbers("speeds", dtype=int, least=-1)
    vectors: np.ndarray = numbers("coordinates", "speeds", dtype=complex)
    basis_errors: np.ndarray | None = numbers("speeds", finite=False, optional=True)

    def __post_init__(self) -> None:
        super().__post_init__()
        checks.labels(self.whirl, "whirl", WHIRLS)

    def columns(self, units: str = "SI") -> dict[str, np.ndarray]:
        """Return the table as columns; `units` are those of :meth:`table`."""
        shown = Units.of(units)
        rotor = shown.frequencies(self.frequencies_rotor)
        return {
            f"critical speed [{shown.speed}]": shown.speeds(self.speeds),
            f"inertial [{shown.frequency}]": shown.frequencies(self.order * self.speeds),
            f"rotor frame [{shown.frequency}]": rotor,
            "nodal diameters": self.nodal_diameters,
            "whirl": np.array(self.whirl),
            **basis_column(self.basis_errors, len(self.whirl)),
        }

    @property
    def splits(self) -> None:
        """None: two planes of an averaged mesh have one critical speed."""

    def table(self, *, units: str = "rpm") -> str:
        """Return the critical speeds as lines of text.

        Parameters
        ----------
        units : {'rpm', 'Hz', 'SI'}
            'SI' rad/s.
        """
        lines = [f"undamped critical speeds of order {self.order:g}"]
        lines += table_lines(self.columns(units)) if self.speeds.size else ["none"]
        return "\n".join([*lines, *self._closing(self.basis_errors)])


def critical_speeds(
    target: Target,
    *,
    supports: Sequence[Given] | Given = (),
    foundation: Foundation | None = None,
    body: RotorBody | Sequence[RotorBody] | None = None,
    order: float = 1.0,
    max_speed: float | None = None,
    nodal_diameters: Sequence[int] = (0, 1),
    stiffening: str = "auto",
    axes: str = "auto",
    accuracy: float | None = 1e-2,
) -> CriticalSpeeds:
    """Compute the undamped critical speeds of a rotor on supports, or of a scene.

    Damping, also structural, and the skew part of the supports' stiffness do not take part; in a
    scene the skew part of damping, as of an annular seal, does no work and stays.

    Parameters
    ----------
    target : ReducedRotor, SolidRotor, RotorTrain, exudyn.MainSystem or LinearModel
        See :func:`linear_model`.
    supports : sequence of Support or bearings, optional
        Of a rotor.
    foundation : Foundation, optional
        What carries them; the ground by default.
    body : RotorBody or sequence of RotorBody, optional
        The rotor in a scene, or all of several, see :func:`linear_model`.
    order : float, optional
        Excitation order p ≥ 0 in the inertial frame; 1 for unbalance, 0 for a load at rest.
    max_speed : float, optional
        Largest speed of interest [rad/s]; needed where a stiffness depends on the speed, as of
        tables, films, scenes and an initial displacement: there the zeros are bracketed at 200
        speeds up to it, and two of one mode that are closer than a 200th of it may be missed.
        Speeds beyond tables, and those at which a film carries nothing, are left out, with a
        warning.
    nodal_diameters : sequence of int, optional
        Which waves may be excited: 0 for axial and torsional motion, 1 for bending and tilting.
    stiffening : {'auto', 'none', 'tilt', 'full'}
    axes : {'auto', 'inertial', 'rotor'}
        Of the equations, see :func:`linear_model`.
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
        interface, or a support with a negative stiffness.

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
    critical speed [rpm]  inertial [Hz]  rotor frame [Hz]  n  whirl
                  954.93        15.9155            31.831  1  backward
                  954.93        15.9155            31.831  1  backward
                  954.93        15.9155                 0  1  forward
                  954.93        15.9155                 0  1  forward
    stiffening: tilt
    """
    given = checked(order, max_speed, nodal_diameters)
    checks.accuracy(accuracy)
    model = linear_model(
        target, supports=supports, foundation=foundation, body=body, stiffening=stiffening,
        axes=axes,
    ).undamped()  # fmt: skip
    search = Search(model, *given)
    result = collected(search, accuracy is not None)
    search.warn()
    model.warn_beyond(result.order * result.speeds)
    if result.speeds.size:
        warn_of_left_out_stiffening(model, max_speed or result.speeds[0])
    warn_of_critical(model, result.speeds, result.basis_errors, accuracy)
    return result


def checked(
    order: float, max_speed: float | None, nodal_diameters: Sequence[int]
) -> tuple[float, list[int], float | None]:
    """Return order, nodal diameters and largest speed of an analysis."""
    order = checks.number(order, "order", least=0.0)
    if max_speed is not None:
        max_speed = checks.number(max_speed, "max_speed", "rad/s", above=0.0)
    values = checks.whole_numbers(nodal_diameters, "nodal_diameters", most=4)
    if not values.size:
        raise ValueError("nodal_diameters: needs at least one whole number from 0 to 4, got none")
    return order, sorted({int(n) for n in values}), max_speed


def collected(search: Search, estimate: bool) -> CriticalSpeeds:
    """Return the result of a search; errors by the basis where they are asked for."""
    model = search.model
    found, rotor, codes, diameters = _named(search.resonances(), search.content)
    speeds = np.array([one.speed for one in found])
    errors = None
    if estimate and basis_error.is_known(model, 1.0):
        errors = _basis_errors(search, found)
    shapes = [x[np.argmax(np.linalg.norm(x, axis=1))] for _, x, _ in found]
    shapes = np.array(shapes, dtype=complex).reshape(-1, model.size).T
    return CriticalSpeeds(
        order=search.order,
        speeds=speeds,
        frequencies_rotor=rotor * speeds,
        whirl=tuple(WHIRLS[code] for code in codes),
        nodal_diameters=diameters,
        vectors=shapes / np.maximum(np.linalg.norm(shapes, axis=0), 1e-300),
        stiffening=model.stiffening,
        basis_errors=errors,
        axes=model.axes,
        unevenness=model.unevenness,
    )


def _named(
    found: Sequence[Resonance], content: Content
) -> tuple[list[Resonance], np.ndarray, np.ndarray, np.ndarray]:
    """Return ascending critical speeds, those of one speed from backward to forward waves.

    With their frequencies in the frame of the rotor over Ω, whirl codes and nodal diameters.
    """
    rotor, codes, diameters = [np.zeros(len(found), dtype=kind) for kind in (float, int, int)]
    for i, (_, vectors, multiples) in enumerate(found):
        center = multiples[len(multiples) // 2]
        orders = np.round(multiples - center).astype(int)
        shape = vectors[None, :, :, None] / np.linalg.norm(vectors)
        # all frequencies go with the speed, so that one speed stands for all
        motion = Motions(np.ones(1), np.array([[1j * center]]), shape, orders, np.zeros(1))
        name = content.named(motion, apart=True)
        codes[i], diameters[i] = name.codes[0, 0], name.diameters[0, 0]
        rotor[i] = name.rotor[0, 0]
    groups = groups_of(np.array([one.speed for one in found]))
    row = np.lexsort((signed_diameters(codes, diameters), groups))
    return [found[i] for i in row], rotor[row], codes[row], diameters[row]


@one_thread()
def _basis_errors(search: Search, found: Sequence[Resonance]) -> np.ndarray:
    """Return relative errors of the lowest critical speeds by the basis, NaN of others, (c,).

    Each motion is followed into the model with the shapes that the basis lacks.
    """
    model, errors = search.model, np.full(len(found), np.nan)
    judged = found if search.limit is not None else found[:_JUDGED]
    if model.is_full:
        errors[: len(judged)] = 0.0
        return errors
    stiffness = Stiffness(model.richer, search.order)
    lifted = basis_error.lifting(model, model.richer)
    for i, one in enumerate(judged):
        lift = one.vectors @ lifted.T
        try:
            pair = one.speed, stiffness.within(lift)
            speed, x = stiffness.refined(pair, one.multiples, _BESIDE * one.speed, _ERROR)
        except NO_EQUATIONS:
            continue
        x, y = lift, stiffness.motions(x, one.multiples)
        likeness = abs(np.vdot(x, y)) ** 2 / (np.vdot(x, x) * np.vdot(y, y)).real
        if likeness > _ALIKE:
            errors[i] = abs(speed / one.speed - 1.0)
    return errors


def warn_of_critical(
    model: LinearModel, speeds: np.ndarray, errors: np.ndarray | None, accuracy: float | None
) -> None:
    """Warn where the basis leaves out too much for some critical speed [rad/s]."""
    if errors is not None and np.any(errors > 0.0):
        worst = Units.of("rpm").speeds(speeds.flat[np.nanargmax(errors)])
        basis_error.warn(errors, f"the critical speed of {worst:.5g} rpm", model, accuracy)
