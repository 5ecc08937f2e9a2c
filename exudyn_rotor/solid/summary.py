"""A short readable table of a rotor."""

from __future__ import annotations

import numpy as np

from exudyn_rotor.solid.model import box
from exudyn_rotor.solid.rotor import FiniteElementRotor, Interface
from exudyn_rotor.theory.axis import SpinAxis


def summary(self: FiniteElementRotor) -> str:
    """Return size, mass, supports, materials, interfaces, masses and discs as text."""
    axis, e = self.axis, self.axis.direction
    kind = "lumped" if self.mass.nnz == np.count_nonzero(self.mass.diagonal()) else "consistent"
    support = "grounded" if self.grounded else "not supported"
    lines = [
        f"nodes            {self.node_count}",
        f"mass             {self.total_mass:.6g} kg ({kind} mass matrix)",
        f"size             {box(self.nodes)}",
        f"centre of mass   {_vector(self.center_of_mass)} m",
        f"spin axis        direction {_vector(e)}, point {_vector(axis.point)} m",
        f"across the axis  {directions(axis)}",
        f"rigid motions    {self.rigid_motions} of 6 free ({support})",
    ]
    regions = () if self.elements is None else self.elements.described()
    lines += [
        f"material         {name}: {mass:.6g} kg, E {young:.5g} Pa, ν {ratio:.4g}, "
        f"ρ {density:.5g} kg/m³"
        for name, mass, young, ratio, density in regions
    ]
    lines += [_interface_line(self, interface) for interface in self.interfaces.values()]
    lines += [
        f"point mass       {one.mass:.6g} kg at {_vector(one.position)} m, on node {one.node}, "
        f"{one.distance:.3g} m away"
        for one in self.point_masses
    ]
    for disc in self.discs:
        polar = e @ disc.inertia @ e
        lines.append(
            f"rigid disc       {disc.mass:.6g} kg at {_vector(disc.center)} m, polar {polar:.5g}, "
            f"transverse {0.5 * (np.trace(disc.inertia) - polar):.5g} kg m², on "
            f"{disc.nodes.size} nodes"
        )
    return "\n".join(lines)


def _interface_line(rotor: FiniteElementRotor, interface: Interface) -> str:
    offset = np.linalg.norm(rotor.axis.radial(interface.center))
    left = np.linalg.norm(rotor.axis.radial(interface.reference))
    rounding = 1e-12 * np.abs(interface.positions).max()
    place = "on the axis"
    if offset > rounding:
        place = f"{offset:.3g} m off the axis ({'removed' if left <= rounding else 'kept'})"
    return (
        f"interface        {interface.name}: {interface.nodes.size} nodes, centre "
        f"{_vector(interface.center)} m, {place}"
    )


def directions(axis: SpinAxis) -> str:
    """Return n1 and n2, in which supports and motions across the axis are given, as text."""
    return ", ".join(f"n{i} {_vector(column + 0.0)}" for i, column in enumerate(axis.plane.T, 1))


def _vector(values: np.ndarray) -> str:
    return "[" + ", ".join(f"{value:.5g}" for value in values) + "]"
