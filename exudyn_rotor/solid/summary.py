"""A short readable table of a rotor."""

from __future__ import annotations

import numpy as np

from exudyn_rotor.solid.interface import Interface
from exudyn_rotor.solid.point_mass import PointMass
from exudyn_rotor.solid.rigid import described_parts, loose_parts
from exudyn_rotor.solid.rigid_disc import RigidDisc
from exudyn_rotor.solid.rotor import FiniteElementRotor
from exudyn_rotor.theory.axis import SpinAxis


def summary(rotor: FiniteElementRotor) -> str:
    """Return what `rotor` consists of and is held by, as lines of text."""
    axis = rotor.axis
    support = "grounded" if rotor.grounded else "not supported"
    lines = [
        f"nodes            {rotor.node_count}",
        f"mass             {rotor.total_mass:.6g} kg ({rotor.mass_kind} mass matrix)",
        f"centre of mass   {_vector(rotor.center_of_mass)} m",
        f"spin axis        direction {_vector(axis.direction)}, point {_vector(axis.point)} m",
        f"across the axis  {directions(axis)}",
        f"rigid motions    {rotor.rigid_motions} of 6 free ({support})",
    ]
    lines += _part_lines(rotor)
    if rotor.elements is not None:
        lines += [_material_line(*region) for region in rotor.elements.described()]
    lines += [_interface_line(rotor, interface) for interface in rotor.interfaces.values()]
    lines += [_point_mass_line(point_mass) for point_mass in rotor.point_masses]
    lines += [_disc_line(rotor, disc) for disc in rotor.discs]
    return "\n".join(lines)


def _part_lines(rotor: FiniteElementRotor) -> list[str]:
    """Return a line for each connected part, with its materials, and one for loose ones."""
    loose = loose_parts(rotor.nodes, rotor.stiffness)
    parts = loose or [np.arange(rotor.node_count)]
    described = described_parts(parts, rotor.nodes, rotor.mass, rotor.elements)
    lines = [f"part             {number}: {text}" for number, text in enumerate(described, 1)]
    told = [f"loose parts      {len(loose)}: nothing connects them"] if loose else []
    return told + lines


def _interface_line(rotor: FiniteElementRotor, interface: Interface) -> str:
    offset = np.linalg.norm(rotor.axis.radial(interface.center))
    left = np.linalg.norm(rotor.axis.radial(interface.reference))
    rounding = 1e-12 * np.abs(interface.positions).max()
    if offset <= rounding:
        place = "on the axis"
    else:
        place = f"{offset:.3g} m off the axis ({'removed' if left <= rounding else 'kept'})"
    return (
        f"interface        {interface.name}: {interface.nodes.size} nodes, centre "
        f"{_vector(interface.center)} m, {place}"
    )


def _point_mass_line(point_mass: PointMass) -> str:
    return (
        f"point mass       {point_mass.mass:.6g} kg at {_vector(point_mass.position)} m, "
        f"on node {point_mass.node}, {point_mass.distance:.3g} m away"
    )


def _material_line(name: str, mass: float, young: float, ratio: float, density: float) -> str:
    return (
        f"material         {name}: {mass:.6g} kg, E {young:.5g} Pa, ν {ratio:.4g}, "
        f"ρ {density:.5g} kg/m³"
    )


def _disc_line(rotor: FiniteElementRotor, disc: RigidDisc) -> str:
    e = rotor.axis.direction
    polar = e @ disc.inertia @ e
    across = 0.5 * (np.trace(disc.inertia) - polar)
    return (
        f"rigid disc       {disc.mass:.6g} kg at {_vector(disc.center)} m, polar {polar:.5g}, "
        f"transverse {across:.5g} kg m², on {disc.nodes.size} nodes"
    )


def directions(axis: SpinAxis) -> str:
    """Return n1 and n2, in which supports and motions across the axis are given, as text."""
    return ", ".join(f"n{i} {_vector(column + 0.0)}" for i, column in enumerate(axis.plane.T, 1))


def _vector(values: np.ndarray) -> str:
    return "[" + ", ".join(f"{value:.5g}" for value in values) + "]"
