"""Scenes that the validations share: rotors, bearings, and two bodies started alike."""

from __future__ import annotations

from collections.abc import Callable, Mapping
from dataclasses import dataclass

import exudyn
import ngsolve as ngs
import numpy as np
from exudyn.FEM import FEMinterface
from exudyn.itemInterface import (
    CartesianSpringDamper,
    MarkerBodyPosition,
    MarkerSuperElementPosition,
    ObjectGround,
    SensorMarker,
    SensorSuperElement,
)
from netgen.occ import Cylinder, OCCGeometry, Pnt, Z

from exudyn_rotor import Formulation, ReducedRotor, SolidRotor, add_rotor, select_modes

STEEL = {"youngsModulus": 2.1e11, "poissonsRatio": 0.3, "density": 7850.0}
ENDS = ("left", "right")

# slight numerical damping: with none at all the multiplier of the 3D body's Euler parameters
# swings up until Newton's method fails
SPECTRAL_RADIUS = 0.99


def disc_on_shaft(maxh: float = 0.1, roundness: float = 1.0) -> ngs.Mesh:
    """Return a steel disc (radius 0.15 m) off the middle of a shaft (radius 0.02 m, 0.5 m).

    The better the `roundness`, the more elements go round the shaft, and the smaller is the
    unbalance that an uneven mesh has by itself.
    """
    shaft = Cylinder(Pnt(0, 0, 0), Z, 0.02, 0.5)
    disc = Cylinder(Pnt(0, 0, 0.2), Z, 0.15, 0.03)
    return _mesh(shaft + disc, maxh, roundness)


def cylinder(radius: float, length: float, maxh: float = 0.1) -> ngs.Mesh:
    """Return a steel cylinder along z with its middle in the origin."""
    return _mesh(Cylinder(Pnt(0, 0, -length / 2), Z, radius, length), maxh)


def _mesh(solid, maxh: float, roundness: float = 1.0) -> ngs.Mesh:
    """Name material and end faces, and mesh coarsely: few nodes keep the 3D markers fast."""
    solid.mat("steel")
    for name, end in zip(ENDS, (solid.faces.Min(Z), solid.faces.Max(Z)), strict=True):
        end.name = name
    return ngs.Mesh(OCCGeometry(solid).GenerateMesh(maxh=maxh, curvaturesafety=roundness))


@dataclass(frozen=True, eq=False)
class Model:
    """One mesh with one set of modes, as both bodies want it.

    Attributes
    ----------
    fem : FEMinterface
        With the modes that the 3D body shall have.
    rotor : SolidRotor
    reduced : ReducedRotor
    """

    fem: FEMinterface
    rotor: SolidRotor
    reduced: ReducedRotor

    @classmethod
    def of(cls, mesh: ngs.Mesh, mode_count: int) -> Model:
        """Reduce to free eigenmodes; the 3D body gets the very same columns."""
        fem = FEMinterface()
        fem.ImportMeshFromNGsolve(
            mesh, materials={"steel": STEEL}, boundaryNamesList=list(ENDS), meshOrder=2
        )
        rotor = SolidRotor.from_fem_interface(fem, "z")
        model = cls(fem, rotor, rotor.reduce(mode_count))
        model.share_modes()
        return model

    def share_modes(self) -> None:
        """Give the 3D body the flexible columns of the reduced rotor."""
        columns = self.reduced.shapes.matrix[:, len(self.reduced.rigid) :]
        self.fem.modeBasis = {"matrix": np.array(columns), "type": "NormalModes"}

    @property
    def rim(self) -> int:
        """Node farthest from the axis."""
        return int(np.argmax(np.linalg.norm(self.rotor.nodes[:, :2], axis=1)))

    @property
    def inertia(self) -> tuple[float, float]:
        """Polar and mean transverse moment of inertia ``I_p, I_t`` of the mesh [kg m²]."""
        first, second, along = np.diag(self.reduced.invariants.J)
        return float(first + second), float(along + (first + second) / 2)

    def rigid_velocity(self, angular_velocity: np.ndarray, pivot: np.ndarray) -> np.ndarray:
        """Return the nodal velocities (n, 3) of a rotation about a pivot [m/s]."""
        return np.cross(angular_velocity, self.rotor.nodes - pivot)


@dataclass(frozen=True)
class Bearings:
    """Equal linear bearings at both ends.

    Parameters
    ----------
    stiffness : tuple of float
        Along inertial x, y, z [N/m].
    damping : float
        In every direction [N s/m].
    """

    stiffness: tuple[float, float, float]
    damping: float = 0.0

    def tilt_stiffness(self, rotor: SolidRotor) -> float:
        """Mean stiffness against tilting about the centre of mass [N m/rad]."""
        arms = [rotor.interfaces[end].center[2] - rotor.center_of_mass[2] for end in ENDS]
        return float(np.mean(self.stiffness[:2]) * np.sum(np.square(arms)))


@dataclass(frozen=True)
class Start:
    """Initial state: spin about the axis plus a rotation rate across it, about the centre of mass.

    Parameters
    ----------
    speed : float
        Spin [rad/s].
    tilt_rate : float
        Angular velocity about inertial x [rad/s].
    """

    speed: float
    tilt_rate: float

    @property
    def angular_velocity(self) -> np.ndarray:
        """Angular velocity in inertial axes [rad/s]."""
        return np.array([self.tilt_rate, 0.0, self.speed])


@dataclass(frozen=True)
class Orbits:
    """Motion in inertial axes at common times.

    Attributes
    ----------
    time : ndarray, shape (s,)
        [s]
    left, right, rim : ndarray, shape (s, 3)
        Positions of the interfaces and of a node at the rim [m].
    """

    time: np.ndarray
    left: np.ndarray
    right: np.ndarray
    rim: np.ndarray

    def combined(self, other: Orbits, rule: Callable) -> Orbits:
        """Return ``rule(own, other)`` of all positions."""
        tracks = ("left", "right", "rim")
        return Orbits(self.time, *(rule(getattr(self, n), getattr(other, n)) for n in tracks))

    @property
    def excursion(self) -> dict[str, float]:
        """Largest way from the initial position [m]; keys as in :func:`deviation`."""
        return deviation(self, self.combined(self, lambda a, b: np.broadcast_to(a[:1], a.shape)))

    @property
    def tilt(self) -> np.ndarray:
        """Complex tilt ``φx + iφy`` of the line between the interfaces [rad], shape (s,)."""
        slope = (self.right - self.left)[:, :2] / (self.right - self.left)[:, 2:]
        return 1j * (slope[:, 0] + 1j * slope[:, 1])


def fixed_axis_orbits(
    model: Model,
    start: Start,
    bearings: Bearings,
    duration: float,
    step: float,
    samples: int,
    *,
    translation: str = "free",
    constant_speed: bool = False,
    stiffening: str = "tilt",
    spectral_radius: float = SPECTRAL_RADIUS,
) -> Orbits:
    """Return the motion of the fixed-axis body; the spin is free or held at the start's speed."""
    mbs = exudyn.SystemContainer().AddSystem()
    spin = start.speed if constant_speed else "free"
    selection = select_modes(model.reduced, Formulation(translation, spin))
    # what the frame's own spin leaves over is a modal velocity; the modes are mass-orthonormal
    own = model.rigid_velocity(start.angular_velocity * [0, 0, 1], selection.origin)
    rest = model.rigid_velocity(start.angular_velocity, model.rotor.center_of_mass) - own
    amounts = model.reduced.shapes.matrix.T @ (model.rotor.mass @ rest.ravel())
    body = add_rotor(
        mbs,
        model.reduced,
        translation=translation,
        spin=spin,
        stiffening=stiffening,
        initial_speed=None if constant_speed else start.speed,
        modal_velocities=selection.T.T @ amounts,
        markers=dict.fromkeys(ENDS, "position"),
    )
    _add_bearings(mbs, model, body.markers, bearings)
    sensors = _add_sensors(mbs, model, body.objects["marker_body"], body.markers)
    return simulate(mbs, sensors, duration, step, samples, spectral_radius)


def three_d_orbits(
    model: Model, start: Start, bearings: Bearings, duration: float, step: float, samples: int
) -> Orbits:
    """Return the motion of Exudyn's own 3D body (Euler parameters)."""
    mbs = exudyn.SystemContainer().AddSystem()
    omega, center = start.angular_velocity, model.rotor.center_of_mass
    made = mbs.CreateFFRFReducedOrderObject(
        "rotor",
        model.fem,
        initialVelocity=-np.cross(omega, center),
        initialAngularVelocity=omega,
    )
    body = made["FFRFReducedOrderObjectDict"]["oFFRFreducedOrder"]
    markers = {
        name: mbs.AddMarker(
            MarkerSuperElementPosition(
                bodyNumber=body,
                meshNodeNumbers=interface.nodes,
                weightingFactors=interface.weights,
            )
        )
        for name, interface in model.rotor.interfaces.items()
    }
    _add_bearings(mbs, model, markers, bearings)
    sensors = _add_sensors(mbs, model, body, markers)
    return simulate(mbs, sensors, duration, step, samples, SPECTRAL_RADIUS)


def _add_bearings(
    mbs: exudyn.MainSystem, model: Model, markers: Mapping, bearings: Bearings
) -> None:
    """Hold both interfaces to where they stand at rest."""
    ground = mbs.AddObject(ObjectGround())
    for end in ENDS:
        rest = model.rotor.interfaces[end].center
        fixed = mbs.AddMarker(MarkerBodyPosition(bodyNumber=ground, localPosition=rest))
        mbs.AddObject(
            CartesianSpringDamper(
                markerNumbers=[fixed, markers[end]],
                stiffness=bearings.stiffness,
                damping=[bearings.damping] * 3,
            )
        )


def _add_sensors(
    mbs: exudyn.MainSystem, model: Model, body: exudyn.ObjectIndex, markers: Mapping
) -> list[exudyn.SensorIndex]:
    """Record the positions of both interfaces and of the rim node."""
    position = exudyn.OutputVariableType.Position
    record = {"outputVariableType": position, "storeInternal": True}
    ends = [mbs.AddSensor(SensorMarker(markerNumber=markers[end], **record)) for end in ENDS]
    rim = SensorSuperElement(bodyNumber=body, meshNodeNumber=model.rim, **record)
    return [*ends, mbs.AddSensor(rim)]


def simulate(
    mbs: exudyn.MainSystem,
    sensors: list[exudyn.SensorIndex],
    duration: float,
    step: float,
    samples: int,
    spectral_radius: float,
) -> Orbits:
    """Integrate every step almost to round-off, and read the sensors.

    Raises
    ------
    ValueError
        If the time between two samples is not a whole number of steps.
    """
    steps = duration / samples / step
    if abs(steps - round(steps)) > 1e-6:
        raise ValueError(f"{steps:.6g} steps from one sample to the next; needs a whole number")
    mbs.Assemble()
    settings = exudyn.SimulationSettings()
    settings.solution.file.write = False
    settings.solution.sensors.writePeriod = duration / samples
    settings.linearSolver.solverType = exudyn.LinearSolverType.EigenSparse
    integration = settings.timeIntegration
    integration.endTime = duration
    integration.numberOfSteps = samples * round(steps)
    integration.generalizedAlpha.spectralRadius = spectral_radius
    integration.newton.useModifiedNewton = True
    integration.newton.relativeTolerance = 1e-10
    integration.newton.absoluteTolerance = 1e-12
    integration.newton.modifiedNewtonContractivity = 0.05
    integration.verboseMode = 0
    mbs.SolveDynamic(settings)
    stored = [mbs.GetSensorStoredData(sensor) for sensor in sensors]
    return Orbits(stored[0][:, 0], *(data[:, 1:] for data in stored))


def deviation(first: Orbits, second: Orbits) -> dict[str, float]:
    """Return the largest differences of two motions [m].

    ``lateral``
        Of the interfaces, in the inertial plane across the axis.
    ``radius``
        Of the interfaces' distances from the axis: does not see a phase error.
    ``axial``
        Of the interfaces, along the axis.
    ``rim``
        Of the rim node along the axis, where a tilt of the disc shows first. The motion in the
        plane is left out: it is the spin, with the phase error of the Euler parameters.
    """
    ends = [(getattr(first, end), getattr(second, end)) for end in ENDS]
    return {
        "lateral": max(_length(a[:, :2] - b[:, :2]).max() for a, b in ends),
        "radius": max(np.abs(_length(a[:, :2]) - _length(b[:, :2])).max() for a, b in ends),
        "axial": max(np.abs(a[:, 2] - b[:, 2]).max() for a, b in ends),
        "rim": float(np.abs(first.rim[:, 2] - second.rim[:, 2]).max()),
    }


def _length(vectors: np.ndarray) -> np.ndarray:
    return np.linalg.norm(vectors, axis=1)


def extrapolated(coarse: Orbits, fine: Orbits) -> Orbits:
    """Return Richardson's combination of the steps h and h/2, for errors of order h²."""
    return coarse.combined(fine, lambda a, b: (4.0 * b - a) / 3.0)
