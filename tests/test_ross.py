"""Rotors of ROSS as solid rotors."""

from types import SimpleNamespace

import numpy as np
import pytest
from ross_models import EXAMPLE, bearing, example

from exudyn_rotor import campbell, craig_bampton_modes, from_ross


def test_frequencies_are_those_of_ross():
    """Discs hold the shaft rigid on their bands, and RBE3 modes are few: within 6e-3."""
    rotor, supports = from_ross(example())
    names = [support.interface for support in supports]
    reduced = rotor.reduce(craig_bampton_modes(rotor, 14, names, coupling="RBE3"))
    result = campbell(reduced, list(EXAMPLE), supports=supports, accuracy=None)
    for i, expected in enumerate(EXAMPLE.values()):
        near = [np.abs(result.frequencies_inertial[i] / f - 1.0).min() for f in expected]
        assert max(near) < 6e-3


def test_tables_tapers_layers_and_discs_without_inertia():
    given = example()
    given.shaft_elements[0].odl = 0.04
    sleeve = vars(given.shaft_elements[2]) | {"idl": 0.05, "idr": 0.05, "odl": 0.07, "odr": 0.07}
    sleeve["material"] = SimpleNamespace(name="Alu", E=7e10, G_s=2.6e10, rho=2700.0)
    given.shaft_elements.append(type(given.shaft_elements[0])(**sleeve))
    given.disk_elements = [SimpleNamespace(n=3, m=2.0, Ip=0.0, Id=0.0)]
    table = {"kxx": [1e6, 3e6], "kyy": 2e6, "kxy": 1e5, "kyx": -1e5, "kzz": 5e5, "mxx": 3.0}
    given.bearing_elements[0] = bearing(0, frequency=[0.0, 100.0], **table)
    given.bearing_elements[1] = bearing(6, kxx=1e6, mxx=4.0)
    rotor, supports = from_ross(given)
    assert supports[1].mass == 4.0
    cone = np.pi / 12 * 0.25 * (0.04**2 + 0.04 * 0.05 + 0.05**2)
    steel = 7810.0 * (np.pi / 4 * 0.05**2 * 1.25 + cone)
    sleeve = 2700.0 * np.pi / 4 * (0.07**2 - 0.05**2) * 0.25
    # the mesh is a polygon round the axis with mid nodes on the circle
    assert rotor.total_mass == pytest.approx(steel + sleeve + 2.0, rel=2e-3)
    stiffness, _ = supports[0].matrices(50.0)
    np.testing.assert_allclose(
        stiffness[:3, :3], [[2e6, 1e5, 0.0], [-1e5, 2e6, 0.0], [0.0, 0.0, 5e5]]
    )
    assert [support.interface for support in supports] == ["Bearing 0", "Bearing 6"]


def test_what_has_no_counterpart_is_refused_or_told():
    with pytest.raises(TypeError, match=r"rotor: needs a ross\.Rotor, got list"):
        from_ross([])
    linked = example()
    linked.bearing_elements[0].n_link = 9
    with pytest.raises(ValueError, match="the bearing at node 0 stands on node 9"):
        from_ross(linked)
    coupled = example()
    coupled.shaft_elements[1] = SimpleNamespace(n=1)
    with pytest.raises(ValueError, match="holds a SimpleNamespace at node 1"):
        from_ross(coupled)
    damped = example()
    damped.shaft_elements[0].beta = 1e-5
    damped.disk_elements[0].m = -1.0
    with (
        pytest.warns(UserWarning, match="beta of shaft elements are left out"),
        pytest.raises(ValueError, match="mass: needs a finite number"),
    ):
        from_ross(damped)
    thin = example(2)
    thin.shaft_elements[1].idl = thin.shaft_elements[1].idr = 0.05 * (1.0 - 1e-5)
    with pytest.raises(ValueError, match="rotor: Netgen cannot mesh its sections"):
        from_ross(thin, element_size=0.05)
