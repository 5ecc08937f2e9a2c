"""Rotors of ROSS as solid rotors with supports; its objects are read, the package is not needed."""

from __future__ import annotations

import warnings
from collections.abc import Callable
from functools import partial
from itertools import pairwise
from typing import Any

import numpy as np

from exudyn_rotor import checks
from exudyn_rotor.bearings.support import Support
from exudyn_rotor.calls import user_level
from exudyn_rotor.solid_rotor import SolidRotor

_WIDTHS = (0.1, 0.2, 0.4, 0.8, 1.6)  # of bands over the diameter, tried one after the other
_SIZE = 0.5  # of elements over the usual diameter
_BETWEEN = 8  # steps between two speeds of a table, which ROSS interpolates by splines


def from_ross(rotor: Any, *, element_size: float | None = None) -> tuple[SolidRotor, list[Support]]:
    """Return the solid rotor and the supports of a rotor of ROSS (2.x).

    Shaft elements, tapered and in layers too, become bodies of revolution about z; disc elements
    rigid discs on a narrow band about their node
    (:meth:`SolidRotor.add_disc`), a mass alone with the inertia of a thick disc of the shaft's
    diameter; bearing and seal elements supports at interfaces on such a
    band, which have their tag as name. Shear, rotatory inertia and gyroscopic terms are
    always there.

    Parameters
    ----------
    rotor : ross.Rotor
    element_size : float, optional
        Largest size of the tetrahedra [m]; half of the median diameter by default.

    Returns
    -------
    rotor : SolidRotor
        Axis z, and the places of the nodes along it as in ROSS.
    supports : list of Support
        Coefficients over the speed follow ROSS's interpolation; beyond the table there are none.

    Raises
    ------
    TypeError, ValueError
        If `rotor` is no rotor of ROSS, or holds couplings, point masses, or bearings between two
        nodes (``n_link``).

    Warns
    -----
    UserWarning
        Where damping (α, β), axial force or torque of shaft elements are left out.

    Examples
    --------
    >>> import ross  # doctest: +SKIP
    >>> from exudyn_rotor import campbell, craig_bampton_modes, from_ross
    >>> rotor, supports = from_ross(ross.rotor_example())  # doctest: +SKIP
    >>> names = [support.interface for support in supports]  # doctest: +SKIP
    >>> modes = craig_bampton_modes(rotor, 14, names, coupling="RBE3")  # doctest: +SKIP
    >>> campbell(rotor.reduce(modes), [0.0, 300.0], supports=supports).plot()  # doctest: +SKIP
    """
    for name in ("shaft_elements", "disk_elements", "bearing_elements", "nodes_pos"):
        if not hasattr(rotor, name):
            raise TypeError(f"rotor: needs a ross.Rotor, got {type(rotor).__name__}")
    _check_held(rotor)
    places = {int(n): float(z) for n, z in zip(rotor.nodes, rotor.nodes_pos, strict=True)}
    solid = _shaft(rotor.shaft_elements, places, element_size)
    for node in sorted({disc.n for disc in rotor.disk_elements}):
        discs = [disc for disc in rotor.disk_elements if disc.n == node]
        mass, diameter = sum(disc.m for disc in discs), _diameter(rotor, node)
        inertia = [sum(getattr(disc, name) for disc in discs) for name in ("Ip", "Id")]
        if not any(inertia):
            inertia = [mass * diameter**2 / 8.0, mass * diameter**2 / 10.0]
        solid = _on_a_band(partial(solid.add_disc, places[node], mass, inertia), diameter)
    supports = []
    for i, bearing in enumerate(rotor.bearing_elements):
        name = bearing.tag or f"bearing {i}"
        seat = partial(solid.interface_at, name, places[bearing.n])
        solid = _on_a_band(seat, _diameter(rotor, bearing.n))
        supports.append(_support(name, bearing))
    return solid, supports


def _check_held(rotor: Any) -> None:
    """Refuse what has no counterpart, and warn of what is left out."""
    others = [e for e in rotor.shaft_elements if type(e).__name__ != "ShaftElement"]
    others += list(getattr(rotor, "point_mass_elements", ()))
    if others:
        raise ValueError(
            f"rotor: holds a {type(others[0]).__name__} at node {others[0].n}, which is not read; "
            "see RotorTrain for couplings, Foundation for masses below bearings"
        )
    linked = [b for b in rotor.bearing_elements if getattr(b, "n_link", None) is not None]
    if linked:
        raise ValueError(
            f"rotor: the bearing at node {linked[0].n} stands on node {linked[0].n_link}; leave "
            "its link out, and pass a foundation to the analyses"
        )
    names = ("alpha", "beta", "axial_force", "torque")
    found = [n for n in names if any(getattr(e, n, 0) for e in rotor.shaft_elements)]
    if found:
        warnings.warn(
            f"rotor: {', '.join(found)} of shaft elements are left out; see docs, Coming from ROSS",
            UserWarning,
            stacklevel=user_level(),
        )


def _diameter(rotor: Any, node: int) -> float:
    """Return the smallest outer diameter of the shaft beside a node [m]."""
    diameters = [e.odl for e in rotor.shaft_elements if e.n == node]
    return min(diameters + [e.odr for e in rotor.shaft_elements if e.n + 1 == node])


def _on_a_band(add: Callable[..., SolidRotor], diameter: float) -> SolidRotor:
    """Return what `add(width=…)` gives on the narrowest band that has nodes enough."""
    for share in _WIDTHS:
        try:
            return add(width=share * diameter)
        except ValueError as error:
            if share == _WIDTHS[-1] or not str(error).startswith("width:"):
                raise


def _shaft(elements: list[Any], places: dict[int, float], element_size: float | None) -> SolidRotor:
    """Return the body of revolution, in as many regions as materials."""
    import ngsolve
    from netgen import occ

    profiles: dict[str, list] = {}
    materials = {}
    for element in elements:
        low, high = places[element.n], places[element.n] + element.L
        corners = [(element.idl, low), (element.odl, low), (element.odr, high), (element.idr, high)]
        points = [occ.Pnt(0.5 * diameter, 0, z) for diameter, z in dict.fromkeys(corners)]
        ends = zip(points, points[1:] + points[:1], strict=True)
        face = occ.Face(occ.Wire([occ.Segment(a, b) for a, b in ends]))
        name = element.material.name
        profiles.setdefault(name, []).append(face)
        materials[name] = {
            "youngsModulus": float(element.material.E),
            "poissonsRatio": float(0.5 * element.material.E / element.material.G_s - 1.0),
            "density": float(element.material.rho),
        }
    if element_size is None:
        element_size = _SIZE * float(np.median([e.odl for e in elements]))
    size = checks.number(element_size, "element_size", "m", above=0.0)
    bodies = []
    for name, faces in profiles.items():
        profile = faces[0] if len(faces) == 1 else occ.Fuse(faces).UnifySameDomain()
        body = profile.Revolve(occ.Axis((0, 0, 0), occ.Z), 360)
        body.mat(name)
        bodies.append(body)
    shape = bodies[0] if len(bodies) == 1 else occ.Glue(bodies)
    try:
        mesh = ngsolve.Mesh(occ.OCCGeometry(shape).GenerateMesh(maxh=size, curvaturesafety=1.0))
    except Exception as error:  # of Netgen's own type
        raise ValueError(
            "rotor: Netgen cannot mesh its sections (thin layers, or neighbours that do not touch, "
            "as in models fitted to a stiffness?); try another element_size, or mesh the drawing"
        ) from error
    return SolidRotor.from_ngsolve(mesh, materials, "z")


def _support(name: str, bearing: Any) -> Support:
    """Return the support of a bearing element, with tables over the speed if it has them."""
    speeds = None if bearing.frequency is None else np.atleast_1d(bearing.frequency).astype(float)
    if speeds is not None:
        parts = [np.linspace(a, b, _BETWEEN, endpoint=False) for a, b in pairwise(speeds)]
        speeds = np.append(np.concatenate([*parts, []]), speeds[-1])
    size = 3 if np.any(bearing.kzz) or np.any(bearing.czz) else 2

    def coefficient(letter: str) -> Any:
        if speeds is None or len(speeds) == 1:
            return _matrix(letter, size, lambda key: np.ravel(getattr(bearing, key))[0])
        values = [
            _matrix(letter, size, lambda key, s=s: getattr(bearing, f"{key}_interpolated")(s))
            for s in speeds
        ]
        return speeds, np.array(values)

    mass = coefficient("m") if np.any(bearing.mxx) else 0.0
    if isinstance(mass, tuple):
        mass = (speeds, mass[1][:, 0, 0])
    elif np.ndim(mass):
        mass = float(mass[0, 0])
    return Support(name, coefficient("k"), coefficient("c"), mass=mass)


def _matrix(letter: str, size: int, value: Callable[[str], Any]) -> np.ndarray:
    matrix = np.zeros((size, size))
    for i, first in enumerate("xy"):
        for j, second in enumerate("xy"):
            matrix[i, j] = value(f"{letter}{first}{second}")
    if size == 3:
        matrix[2, 2] = value(f"{letter}zz")
    return matrix
