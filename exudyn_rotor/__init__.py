"""Flexible solid rotors about one fixed axis, for Exudyn multibody scenes.

Importing the package adds ``mbs.CreateFixedAxisFFRFReducedOrderObject`` to Exudyn, and lets
``mbs.Assemble()`` make the markers of a script on this package's rotors cheap.
"""

from exudyn_rotor.advice.check_result import RunCheck
from exudyn_rotor.advice.energy_balance import EnergyBalance, energy_balance
from exudyn_rotor.advice.proposal import Proposal, propose
from exudyn_rotor.advice.run_check import check_run
from exudyn_rotor.advice.warning import AssumptionWarning
from exudyn_rotor.bearings.actuator import LinearActuator, SaturatingActuator
from exudyn_rotor.bearings.annular_seal import AnnularSeal
from exudyn_rotor.bearings.clearance_stop import ClearanceStop
from exudyn_rotor.bearings.film.film import OilFilm
from exudyn_rotor.bearings.film.pads import Pad, grooved_pads
from exudyn_rotor.bearings.film.picture import plot_pressure
from exudyn_rotor.bearings.journal_bearing import JournalBearing
from exudyn_rotor.bearings.magnetic import MagneticBearing
from exudyn_rotor.bearings.pid_controller import PIDController
from exudyn_rotor.bearings.rolling import RollingBearing
from exudyn_rotor.bearings.short_journal import ShortJournalBearing
from exudyn_rotor.bearings.squeeze_film import SqueezeFilmDamper
from exudyn_rotor.bearings.support import Support
from exudyn_rotor.bearings.tilting_pad import TiltingPadBearing
from exudyn_rotor.drives.cardan import CardanJoint
from exudyn_rotor.drives.coupling import FlexibleCoupling
from exudyn_rotor.drives.drive import Drag, TorqueCurve
from exudyn_rotor.drives.gear_mesh import GearMesh
from exudyn_rotor.drives.motors import DirectCurrentMotor, InductionMotor, LimitedPower
from exudyn_rotor.evaluation.level_one import (
    StabilityLevelOne,
    anticipated_cross_coupling,
    stability_level_one,
)
from exudyn_rotor.evaluation.placement import bearing_loads, bearing_masses, standard_unbalances
from exudyn_rotor.evaluation.separation import SeparationMargins, separation_margins
from exudyn_rotor.foundations.foundation import Foundation
from exudyn_rotor.foundations.mount import Mount
from exudyn_rotor.foundations.record import BaseRecord
from exudyn_rotor.html_report import report
from exudyn_rotor.linear.modal.campbell import Campbell, campbell
from exudyn_rotor.linear.modal.critical_speed_map import CriticalSpeedMap, critical_speed_map
from exudyn_rotor.linear.modal.critical_speeds import CriticalSpeeds, critical_speeds
from exudyn_rotor.linear.model.build import linear_model
from exudyn_rotor.linear.model.linear_model import LinearModel
from exudyn_rotor.linear.model.links import Link
from exudyn_rotor.linear.model.rotor_train import RotorTrain
from exudyn_rotor.linear.response.base_response import BaseResponse, base_response
from exudyn_rotor.linear.response.harmonic_loads import BaseAcceleration, HarmonicForce
from exudyn_rotor.linear.response.responses import HarmonicResponse, UnbalanceResponse
from exudyn_rotor.linear.response.rolling_response import rolling_bearing_response
from exudyn_rotor.linear.response.rolling_result import RollingBearingResponse
from exudyn_rotor.linear.response.steady_response import harmonic_response, unbalance_response
from exudyn_rotor.linear.response.steady_state import SteadyState, steady_state
from exudyn_rotor.linear.response.unbalance import Unbalance, permissible_unbalance
from exudyn_rotor.linear.stability.sensitivity import sensitivity
from exudyn_rotor.linear.stability.sensitivity_result import Sensitivity
from exudyn_rotor.linear.stability.stability import stability
from exudyn_rotor.linear.stability.stability_map import StabilityMap, stability_map
from exudyn_rotor.linear.stability.stability_result import Stability
from exudyn_rotor.linear.stability.threshold_result import StabilityThresholds
from exudyn_rotor.linear.stability.thresholds import stability_threshold, unstable_ranges
from exudyn_rotor.multibody.add_rotor import add_rotor
from exudyn_rotor.multibody.drives.add_drive import add_drive
from exudyn_rotor.multibody.drives.connect_rotors import connect_rotors
from exudyn_rotor.multibody.full.full_body import FullRotorBody
from exudyn_rotor.multibody.rotor.connections import ConnectionWarning
from exudyn_rotor.multibody.rotor.rotor_body import RotorBody
from exudyn_rotor.multibody.rotor.start_state import StartState
from exudyn_rotor.multibody.solver_settings import recommended_settings
from exudyn_rotor.multibody.supports.add_supports import add_supports
from exudyn_rotor.multibody.supports.base_motion import add_base_motion
from exudyn_rotor.multibody.supports.foundation_body import SceneFoundation, add_foundation
from exudyn_rotor.multibody.twins.exudyn_call import MainSystemCreateFixedAxisFFRFReducedOrderObject
from exudyn_rotor.multibody.twins.exudyn_interface import ObjectFixedAxisFFRFreducedOrderInterface
from exudyn_rotor.pictures.motion_shapes import MotionShapes
from exudyn_rotor.pictures.shapes import mode_shapes, response_shapes
from exudyn_rotor.pictures.spectra import Spectra, plot_orbit, spectra
from exudyn_rotor.reduction.component import ModeBasis, free_modes
from exudyn_rotor.reduction.craig_bampton import craig_bampton_modes
from exudyn_rotor.reduction.mean_axis import use_mean_axis_modes
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.reduction.selection import select_modes
from exudyn_rotor.reduction.spinning import spinning_modes
from exudyn_rotor.reduction.truncation import keep_modes
from exudyn_rotor.results import Result, load_result
from exudyn_rotor.solid.carried_prestress import Prestress
from exudyn_rotor.solid.interface import Interface
from exudyn_rotor.solid.point_mass import PointMass
from exudyn_rotor.solid.rigid_disc import RigidDisc
from exudyn_rotor.solid_rotor import SolidRotor
from exudyn_rotor.strength.field import StressField
from exudyn_rotor.strength.history import StressHistory, stress_history
from exudyn_rotor.theory.axis import SpinAxis
from exudyn_rotor.theory.formulation import ConstantSpeed, Formulation, PrescribedMotion
from exudyn_rotor.theory.invariants import Invariants
from exudyn_rotor.theory.motion import Motion
from exudyn_rotor.theory.stiffening import Stiffening

__version__ = "0.2.0.dev0"

__all__ = [
    "AnnularSeal",
    "AssumptionWarning",
    "BaseAcceleration",
    "BaseRecord",
    "BaseResponse",
    "Campbell",
    "CardanJoint",
    "ClearanceStop",
    "ConnectionWarning",
    "ConstantSpeed",
    "CriticalSpeedMap",
    "CriticalSpeeds",
    "DirectCurrentMotor",
    "Drag",
    "EnergyBalance",
    "FlexibleCoupling",
    "Formulation",
    "Foundation",
    "FullRotorBody",
    "GearMesh",
    "HarmonicForce",
    "HarmonicResponse",
    "InductionMotor",
    "Interface",
    "Invariants",
    "JournalBearing",
    "LimitedPower",
    "LinearActuator",
    "LinearModel",
    "Link",
    "MagneticBearing",
    "MainSystemCreateFixedAxisFFRFReducedOrderObject",
    "ModeBasis",
    "Motion",
    "MotionShapes",
    "Mount",
    "ObjectFixedAxisFFRFreducedOrderInterface",
    "OilFilm",
    "PIDController",
    "Pad",
    "PointMass",
    "PrescribedMotion",
    "Prestress",
    "Proposal",
    "ReducedRotor",
    "Result",
    "RigidDisc",
    "RollingBearing",
    "RollingBearingResponse",
    "RotorBody",
    "RotorTrain",
    "RunCheck",
    "SaturatingActuator",
    "SceneFoundation",
    "Sensitivity",
    "SeparationMargins",
    "ShortJournalBearing",
    "SolidRotor",
    "Spectra",
    "SpinAxis",
    "SqueezeFilmDamper",
    "Stability",
    "StabilityLevelOne",
    "StabilityMap",
    "StabilityThresholds",
    "StartState",
    "SteadyState",
    "Stiffening",
    "StressField",
    "StressHistory",
    "Support",
    "TiltingPadBearing",
    "TorqueCurve",
    "Unbalance",
    "UnbalanceResponse",
    "add_base_motion",
    "add_drive",
    "add_foundation",
    "add_rotor",
    "add_supports",
    "anticipated_cross_coupling",
    "base_response",
    "bearing_loads",
    "bearing_masses",
    "campbell",
    "check_run",
    "connect_rotors",
    "craig_bampton_modes",
    "critical_speed_map",
    "critical_speeds",
    "energy_balance",
    "free_modes",
    "grooved_pads",
    "harmonic_response",
    "keep_modes",
    "linear_model",
    "load_result",
    "mode_shapes",
    "permissible_unbalance",
    "plot_orbit",
    "plot_pressure",
    "propose",
    "recommended_settings",
    "report",
    "response_shapes",
    "rolling_bearing_response",
    "select_modes",
    "sensitivity",
    "separation_margins",
    "spectra",
    "spinning_modes",
    "stability",
    "stability_level_one",
    "stability_map",
    "stability_threshold",
    "standard_unbalances",
    "steady_state",
    "stress_history",
    "unbalance_response",
    "unstable_ranges",
    "use_mean_axis_modes",
]
