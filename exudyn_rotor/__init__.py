"""Flexible solid rotors about one fixed axis, for Exudyn multibody scenes.

Importing the package adds ``mbs.CreateFixedAxisFFRFReducedOrderObject`` to Exudyn.
"""

from exudyn_rotor.advice.checks import RunCheck, check_run
from exudyn_rotor.advice.proposal import Proposal, propose
from exudyn_rotor.advice.warning import AssumptionWarning
from exudyn_rotor.axis import SpinAxis
from exudyn_rotor.body.adding import add_rotor
from exudyn_rotor.body.rotor_body import RotorBody
from exudyn_rotor.body.settings import recommended_settings
from exudyn_rotor.body.twin import MainSystemCreateFixedAxisFFRFReducedOrderObject
from exudyn_rotor.formulation import ConstantSpeed, Formulation, PrescribedMotion
from exudyn_rotor.invariants import Invariants
from exudyn_rotor.linear.equations.supports import Support
from exudyn_rotor.linear.modal.campbell import Campbell, campbell
from exudyn_rotor.linear.modal.critical import (
    CriticalSpeedMap,
    CriticalSpeeds,
    critical_speed_map,
    critical_speeds,
)
from exudyn_rotor.linear.response.analysis import harmonic_response, unbalance_response
from exudyn_rotor.linear.response.balance import Unbalance, permissible_unbalance
from exudyn_rotor.linear.response.loads import BaseAcceleration, HarmonicForce
from exudyn_rotor.linear.response.results import HarmonicResponse, UnbalanceResponse
from exudyn_rotor.linear.results import load_result
from exudyn_rotor.linear.stability.analysis import (
    Stability,
    stability,
    stability_threshold,
    unstable_ranges,
)
from exudyn_rotor.linear.stability.maps import StabilityMap, stability_map
from exudyn_rotor.modes import ModeBasis, craig_bampton_modes, free_modes, spinning_modes
from exudyn_rotor.modes.selection import select_modes
from exudyn_rotor.motion import Motion
from exudyn_rotor.reduced import ReducedRotor
from exudyn_rotor.solid import Interface, PointMass, Prestress, SolidRotor
from exudyn_rotor.stiffening import Stiffening
from exudyn_rotor.strength.field import StressField
from exudyn_rotor.strength.history import StressHistory, stress_history
from exudyn_rotor.truncation import keep_modes

__all__ = [
    "AssumptionWarning",
    "BaseAcceleration",
    "Campbell",
    "ConstantSpeed",
    "CriticalSpeedMap",
    "CriticalSpeeds",
    "Formulation",
    "HarmonicForce",
    "HarmonicResponse",
    "Interface",
    "Invariants",
    "MainSystemCreateFixedAxisFFRFReducedOrderObject",
    "ModeBasis",
    "Motion",
    "PointMass",
    "PrescribedMotion",
    "Prestress",
    "Proposal",
    "ReducedRotor",
    "RotorBody",
    "RunCheck",
    "SolidRotor",
    "SpinAxis",
    "Stability",
    "StabilityMap",
    "Stiffening",
    "StressField",
    "StressHistory",
    "Support",
    "Unbalance",
    "UnbalanceResponse",
    "add_rotor",
    "campbell",
    "check_run",
    "craig_bampton_modes",
    "critical_speed_map",
    "critical_speeds",
    "free_modes",
    "harmonic_response",
    "keep_modes",
    "load_result",
    "permissible_unbalance",
    "propose",
    "recommended_settings",
    "select_modes",
    "spinning_modes",
    "stability",
    "stability_map",
    "stability_threshold",
    "stress_history",
    "unbalance_response",
    "unstable_ranges",
]
