"""The rotor as a finite-element model: matrices, interfaces, checks, sources of models."""

from exudyn_rotor.solid.interface import Interface
from exudyn_rotor.solid.point_mass import PointMass
from exudyn_rotor.solid.prestress import Prestress
from exudyn_rotor.solid.rotor import SolidRotor

__all__ = ["Interface", "PointMass", "Prestress", "SolidRotor"]
