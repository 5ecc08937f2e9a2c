"""Flexible solid rotors about one fixed axis, for Exudyn multibody scenes.

Importing the package adds ``mbs.CreateFixedAxisFFRFReducedOrderObject`` to Exudyn, and lets
``mbs.Assemble()`` make the markers of a script on this package's rotors cheap.
"""

from __future__ import annotations

from importlib import import_module
from importlib.util import find_spec
from typing import TYPE_CHECKING, Any

import exudyn.utilities  # noqa: F401 (scripts find it in exudyn, as they always did)

import exudyn_rotor.multibody.twins.exudyn_call  # noqa: F401 (methods of Exudyn's MainSystem)

if TYPE_CHECKING:
    from exudyn_rotor.advice.check_result import RunCheck as RunCheck
    from exudyn_rotor.advice.energy_balance import EnergyBalance as EnergyBalance
    from exudyn_rotor.advice.energy_balance import energy_balance as energy_balance
    from exudyn_rotor.advice.proposal import Proposal as Proposal
    from exudyn_rotor.advice.proposal import propose as propose
    from exudyn_rotor.advice.run_check import check_run as check_run
    from exudyn_rotor.advice.warning import AssumptionWarning as AssumptionWarning
    from exudyn_rotor.bearings.actuator import LinearActuator as LinearActuator
    from exudyn_rotor.bearings.actuator import SaturatingActuator as SaturatingActuator
    from exudyn_rotor.bearings.annular_seal import AnnularSeal as AnnularSeal
    from exudyn_rotor.bearings.clearance_stop import ClearanceStop as ClearanceStop
    from exudyn_rotor.bearings.film.film import OilFilm as OilFilm
    from exudyn_rotor.bearings.film.pads import Pad as Pad
    from exudyn_rotor.bearings.film.pads import grooved_pads as grooved_pads
    from exudyn_rotor.bearings.film.picture import plot_pressure as plot_pressure
    from exudyn_rotor.bearings.journal_bearing import JournalBearing as JournalBearing
    from exudyn_rotor.bearings.magnetic import MagneticBearing as MagneticBearing
    from exudyn_rotor.bearings.pid_controller import PIDController as PIDController
    from exudyn_rotor.bearings.rolling import RollingBearing as RollingBearing
    from exudyn_rotor.bearings.short_journal import ShortJournalBearing as ShortJournalBearing
    from exudyn_rotor.bearings.squeeze_film import SqueezeFilmDamper as SqueezeFilmDamper
    from exudyn_rotor.bearings.support import Support as Support
    from exudyn_rotor.bearings.tilting_pad import TiltingPadBearing as TiltingPadBearing
    from exudyn_rotor.drives.cardan import CardanJoint as CardanJoint
    from exudyn_rotor.drives.coupling import FlexibleCoupling as FlexibleCoupling
    from exudyn_rotor.drives.drive import Drag as Drag
    from exudyn_rotor.drives.drive import TorqueCurve as TorqueCurve
    from exudyn_rotor.drives.gear_mesh import GearMesh as GearMesh
    from exudyn_rotor.drives.motors import DirectCurrentMotor as DirectCurrentMotor
    from exudyn_rotor.drives.motors import InductionMotor as InductionMotor
    from exudyn_rotor.drives.motors import LimitedPower as LimitedPower
    from exudyn_rotor.evaluation.level_one import StabilityLevelOne as StabilityLevelOne
    from exudyn_rotor.evaluation.level_one import (
        anticipated_cross_coupling as anticipated_cross_coupling,
    )
    from exudyn_rotor.evaluation.level_one import stability_level_one as stability_level_one
    from exudyn_rotor.evaluation.placement import bearing_masses as bearing_masses
    from exudyn_rotor.evaluation.placement import standard_unbalances as standard_unbalances
    from exudyn_rotor.evaluation.separation import SeparationMargins as SeparationMargins
    from exudyn_rotor.evaluation.separation import separation_margins as separation_margins
    from exudyn_rotor.foundations.foundation import Foundation as Foundation
    from exudyn_rotor.foundations.mount import Mount as Mount
    from exudyn_rotor.foundations.record import BaseRecord as BaseRecord
    from exudyn_rotor.html_report import report as report
    from exudyn_rotor.linear.modal.campbell import Campbell as Campbell
    from exudyn_rotor.linear.modal.campbell import campbell as campbell
    from exudyn_rotor.linear.modal.critical_speed_map import CriticalSpeedMap as CriticalSpeedMap
    from exudyn_rotor.linear.modal.critical_speed_map import (
        critical_speed_map as critical_speed_map,
    )
    from exudyn_rotor.linear.modal.critical_speeds import CriticalSpeeds as CriticalSpeeds
    from exudyn_rotor.linear.modal.critical_speeds import critical_speeds as critical_speeds
    from exudyn_rotor.linear.model.build import linear_model as linear_model
    from exudyn_rotor.linear.model.linear_model import LinearModel as LinearModel
    from exudyn_rotor.linear.model.rotor_train import Link as Link
    from exudyn_rotor.linear.model.rotor_train import RotorTrain as RotorTrain
    from exudyn_rotor.linear.response.base_response import BaseResponse as BaseResponse
    from exudyn_rotor.linear.response.base_response import base_response as base_response
    from exudyn_rotor.linear.response.loads import BaseAcceleration as BaseAcceleration
    from exudyn_rotor.linear.response.loads import HarmonicForce as HarmonicForce
    from exudyn_rotor.linear.response.loads import Unbalance as Unbalance
    from exudyn_rotor.linear.response.loads import (
        permissible_unbalance as permissible_unbalance,
    )
    from exudyn_rotor.linear.response.response import HarmonicResponse as HarmonicResponse
    from exudyn_rotor.linear.response.response import UnbalanceResponse as UnbalanceResponse
    from exudyn_rotor.linear.response.steady_response import harmonic_response as harmonic_response
    from exudyn_rotor.linear.response.steady_response import (
        unbalance_response as unbalance_response,
    )
    from exudyn_rotor.linear.response.steady_state import SteadyState as SteadyState
    from exudyn_rotor.linear.response.steady_state import steady_state as steady_state
    from exudyn_rotor.linear.stability.sensitivity import Sensitivity as Sensitivity
    from exudyn_rotor.linear.stability.sensitivity import sensitivity as sensitivity
    from exudyn_rotor.linear.stability.stability import Stability as Stability
    from exudyn_rotor.linear.stability.stability import stability as stability
    from exudyn_rotor.linear.stability.stability_map import StabilityMap as StabilityMap
    from exudyn_rotor.linear.stability.stability_map import stability_map as stability_map
    from exudyn_rotor.linear.stability.thresholds import (
        StabilityThresholds as StabilityThresholds,
    )
    from exudyn_rotor.linear.stability.thresholds import stability_threshold as stability_threshold
    from exudyn_rotor.linear.stability.thresholds import unstable_ranges as unstable_ranges
    from exudyn_rotor.linear.static.bearing_loads import bearing_loads as bearing_loads
    from exudyn_rotor.linear.static.static_response import static_response as static_response
    from exudyn_rotor.linear.static.static_result import StaticResponse as StaticResponse
    from exudyn_rotor.multibody.add_rotor import add_rotor as add_rotor
    from exudyn_rotor.multibody.drives.add_drive import add_drive as add_drive
    from exudyn_rotor.multibody.drives.connect_rotors import connect_rotors as connect_rotors
    from exudyn_rotor.multibody.full.full_body import FullRotorBody as FullRotorBody
    from exudyn_rotor.multibody.rotor.connections import ConnectionWarning as ConnectionWarning
    from exudyn_rotor.multibody.rotor.rotor_body import RotorBody as RotorBody
    from exudyn_rotor.multibody.rotor.start_state import StartState as StartState
    from exudyn_rotor.multibody.solver_settings import recommended_settings as recommended_settings
    from exudyn_rotor.multibody.supports.add_supports import add_supports as add_supports
    from exudyn_rotor.multibody.supports.base_motion import add_base_motion as add_base_motion
    from exudyn_rotor.multibody.supports.foundation_body import SceneFoundation as SceneFoundation
    from exudyn_rotor.multibody.supports.foundation_body import add_foundation as add_foundation
    from exudyn_rotor.multibody.twins.exudyn_call import (
        MainSystemCreateFixedAxisFFRFReducedOrderObject as MainSystemCreateFixedAxisFFRFReducedOrderObject,  # noqa: E501
    )
    from exudyn_rotor.multibody.twins.exudyn_interface import (
        ObjectFixedAxisFFRFreducedOrderInterface as ObjectFixedAxisFFRFreducedOrderInterface,
    )
    from exudyn_rotor.nonlinear.limit_cycles import limit_cycles as limit_cycles
    from exudyn_rotor.nonlinear.periodic_response import periodic_response as periodic_response
    from exudyn_rotor.nonlinear.periodic_result import PeriodicResponse as PeriodicResponse
    from exudyn_rotor.pictures.motion_shapes import MotionShapes as MotionShapes
    from exudyn_rotor.pictures.shapes import mode_shapes as mode_shapes
    from exudyn_rotor.pictures.shapes import response_shapes as response_shapes
    from exudyn_rotor.pictures.spectra import Spectra as Spectra
    from exudyn_rotor.pictures.spectra import plot_orbit as plot_orbit
    from exudyn_rotor.pictures.spectra import spectra as spectra
    from exudyn_rotor.reduction.component import ModeBasis as ModeBasis
    from exudyn_rotor.reduction.component import free_modes as free_modes
    from exudyn_rotor.reduction.craig_bampton import craig_bampton_modes as craig_bampton_modes
    from exudyn_rotor.reduction.mean_axis import use_mean_axis_modes as use_mean_axis_modes
    from exudyn_rotor.reduction.reduced_rotor import ReducedRotor as ReducedRotor
    from exudyn_rotor.reduction.selection import keep_modes as keep_modes
    from exudyn_rotor.reduction.selection import select_modes as select_modes
    from exudyn_rotor.results import Result as Result
    from exudyn_rotor.results import load_result as load_result
    from exudyn_rotor.ross import from_ross as from_ross
    from exudyn_rotor.solid.carried_prestress import Prestress as Prestress
    from exudyn_rotor.solid.interface import Interface as Interface
    from exudyn_rotor.solid.point_mass import PointMass as PointMass
    from exudyn_rotor.solid.rigid_disc import RigidDisc as RigidDisc
    from exudyn_rotor.solid_rotor import SolidRotor as SolidRotor
    from exudyn_rotor.strength.field import StressField as StressField
    from exudyn_rotor.strength.history import StressHistory as StressHistory
    from exudyn_rotor.strength.history import stress_history as stress_history
    from exudyn_rotor.theory.axis import SpinAxis as SpinAxis
    from exudyn_rotor.theory.formulation import ConstantSpeed as ConstantSpeed
    from exudyn_rotor.theory.formulation import Formulation as Formulation
    from exudyn_rotor.theory.formulation import PrescribedMotion as PrescribedMotion
    from exudyn_rotor.theory.invariants import Invariants as Invariants
    from exudyn_rotor.theory.motion import Motion as Motion
    from exudyn_rotor.theory.stiffening import Stiffening as Stiffening

__version__ = "0.2.0"

# public names by their module, which is imported where one of them is first used
_NAMES = {
    "advice.check_result": "RunCheck",
    "advice.energy_balance": "EnergyBalance energy_balance",
    "advice.proposal": "Proposal propose",
    "advice.run_check": "check_run",
    "advice.warning": "AssumptionWarning",
    "bearings.actuator": "LinearActuator SaturatingActuator",
    "bearings.annular_seal": "AnnularSeal",
    "bearings.clearance_stop": "ClearanceStop",
    "bearings.film.film": "OilFilm",
    "bearings.film.pads": "Pad grooved_pads",
    "bearings.film.picture": "plot_pressure",
    "bearings.journal_bearing": "JournalBearing",
    "bearings.magnetic": "MagneticBearing",
    "bearings.pid_controller": "PIDController",
    "bearings.rolling": "RollingBearing",
    "bearings.series": "FloatingRingBearing SeriesSupport",
    "bearings.short_journal": "ShortJournalBearing",
    "bearings.squeeze_film": "SqueezeFilmDamper",
    "bearings.support": "Support",
    "bearings.tilting_pad": "TiltingPadBearing",
    "drives.cardan": "CardanJoint",
    "drives.coupling": "FlexibleCoupling",
    "drives.drive": "Drag TorqueCurve",
    "drives.gear_mesh": "GearMesh",
    "drives.motors": "DirectCurrentMotor InductionMotor LimitedPower",
    "evaluation.level_one": "StabilityLevelOne anticipated_cross_coupling stability_level_one",
    "evaluation.placement": "bearing_masses standard_unbalances",
    "evaluation.separation": "SeparationMargins separation_margins",
    "foundations.foundation": "Foundation",
    "foundations.mount": "Mount",
    "foundations.record": "BaseRecord",
    "html_report": "report",
    "linear.modal.campbell": "Campbell campbell",
    "linear.modal.critical_speed_map": "CriticalSpeedMap critical_speed_map",
    "linear.modal.critical_speeds": "CriticalSpeeds critical_speeds",
    "linear.model.build": "linear_model",
    "linear.model.linear_model": "LinearModel",
    "linear.model.rotor_train": "Link RotorTrain",
    "linear.response.base_response": "BaseResponse base_response",
    "linear.response.loads": "BaseAcceleration HarmonicForce Unbalance permissible_unbalance",
    "linear.response.response": "HarmonicResponse UnbalanceResponse",
    "linear.response.steady_response": "harmonic_response unbalance_response",
    "linear.response.steady_state": "SteadyState steady_state",
    "linear.stability.sensitivity": "Sensitivity sensitivity",
    "linear.stability.stability": "Stability stability",
    "linear.stability.stability_map": "StabilityMap stability_map",
    "linear.stability.thresholds": "StabilityThresholds stability_threshold unstable_ranges",
    "linear.static.bearing_loads": "bearing_loads",
    "linear.static.static_response": "static_response",
    "linear.static.static_result": "StaticResponse",
    "multibody.add_rotor": "add_rotor",
    "multibody.drives.add_drive": "add_drive",
    "multibody.drives.connect_rotors": "connect_rotors",
    "multibody.full.full_body": "FullRotorBody",
    "multibody.rotor.connections": "ConnectionWarning",
    "multibody.rotor.rotor_body": "RotorBody",
    "multibody.rotor.start_state": "StartState",
    "multibody.solver_settings": "recommended_settings",
    "multibody.supports.add_supports": "add_supports",
    "multibody.supports.base_motion": "add_base_motion",
    "multibody.supports.foundation_body": "SceneFoundation add_foundation",
    "multibody.twins.exudyn_call": "MainSystemCreateFixedAxisFFRFReducedOrderObject",
    "multibody.twins.exudyn_interface": "ObjectFixedAxisFFRFreducedOrderInterface",
    "nonlinear.limit_cycles": "limit_cycles",
    "nonlinear.periodic_response": "periodic_response",
    "nonlinear.periodic_result": "PeriodicResponse",
    "pictures.motion_shapes": "MotionShapes",
    "pictures.shapes": "mode_shapes response_shapes",
    "pictures.spectra": "Spectra plot_orbit spectra",
    "reduction.component": "ModeBasis free_modes",
    "reduction.craig_bampton": "craig_bampton_modes",
    "reduction.mean_axis": "use_mean_axis_modes",
    "reduction.reduced_rotor": "ReducedRotor",
    "reduction.selection": "keep_modes select_modes",
    "results": "Result load_result",
    "solid.carried_prestress": "Prestress",
    "solid.interface": "Interface",
    "solid.point_mass": "PointMass",
    "solid.rigid_disc": "RigidDisc",
    "ross": "from_ross",
    "solid_rotor": "SolidRotor",
    "strength.field": "StressField",
    "strength.history": "StressHistory stress_history",
    "theory.axis": "SpinAxis",
    "theory.formulation": "ConstantSpeed Formulation PrescribedMotion",
    "theory.invariants": "Invariants",
    "theory.motion": "Motion",
    "theory.stiffening": "Stiffening",
}
_MODULES = {name: module for module, names in _NAMES.items() for name in names.split()}

__all__ = sorted(_MODULES)


def __getattr__(name: str) -> Any:
    """Return a public name or a module of the package; they are imported here."""
    if name in _MODULES:
        value = getattr(import_module(f"{__name__}.{_MODULES[name]}"), name)
    elif name.isidentifier() and name[0] != "_" and find_spec(f"{__name__}.{name}") is not None:
        value = import_module(f"{__name__}.{name}")
    else:
        raise AttributeError(f"module {__name__!r} has no attribute {name!r}")
    globals()[name] = value
    return value


def __dir__() -> list[str]:
    return sorted({*globals(), *__all__})
