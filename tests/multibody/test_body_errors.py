"""Bad input to the Exudyn layer: a clear message, and nothing added."""

import exudyn as exu
import numpy as np
import pytest
from exudyn.itemInterface import MarkerNodeCoordinate
from models import disc_rotor

from exudyn_rotor import PrescribedMotion, add_rotor

NAN = float("nan")
RUN_UP = PrescribedMotion.run_up(0.0, 100.0, 1.0)


@pytest.fixture(scope="module")
def solid():
    return disc_rotor(1)


@pytest.fixture(scope="module")
def reduced(solid):
    return solid.reduce(2, prestress=False)


def counts(mbs):
    data = mbs.systemData
    return [
        getattr(data, f"NumberOf{kind}")()
        for kind in ("Nodes", "Objects", "Markers", "Loads", "Sensors")
    ]


def motion(value):
    return PrescribedMotion(lambda t: value, lambda t: value, lambda t: value)


CASES = {
    "same name": ({"name": "taken"}, "already has an item 'taken.*another name"),
    "empty name": ({"name": ""}, "name: needs a name that is not empty, got ''"),
    "number as name": ({"name": 3}, r"name: needs a name \(text\), got 3"),
    "speed twice": ({"spin": 10.0, "initial_speed": 10.0}, "given twice: initial_speed"),
    "angle twice": ({"spin": RUN_UP, "initial_angle": 0.0}, "given twice: initial_angle"),
    "unknown interface": (
        {"markers": {"middle": "rigid"}},
        "markers: 'middle' is unknown; there are: 'left', 'right'",
    ),
    "unknown offset": (
        {"marker_offsets": {"middle": [0, 0, 0]}},
        "marker_offsets: 'middle' is unknown; there are: 'left', 'right'",
    ),
    "offset of no marker": (
        {"markers": {"left": "rigid"}, "marker_offsets": {"right": [0, 0, 0.1]}},
        "'right' gets no marker",
    ),
    "marker kind": (
        {"markers": {"left": "ring"}},
        "kind of 'left': 'ring' is .*; use one of 'rigid', 'position'",
    ),
    "offset shape": ({"marker_offsets": {"left": [0, 0]}}, "marker_offsets: 'left': needs"),
    "markers without marker body": (
        {"marker_body": False, "markers": {"left": "rigid"}},
        "need the marker body",
    ),
    "translation": ({"translation": "axial"}, "'axial' is unknown.*'free', 'in-plane', 'none'"),
    "spin": ({"spin": "fast"}, "'fast' is unknown"),
    "stiffening": ({"stiffening": "full"}, "'full'"),
    "locking": ({"locking": "glue"}, "'glue' is unknown; use one of 'auto', 'mass', 'constraints'"),
    "drive": ({"spin": 1.0, "drive": "belt"}, "'belt' is unknown"),
    "held, moving": (
        {"translation": "none", "initial_velocity": [1.0, 0, 0]},
        "translation='none' holds the rotor",
    ),
    "velocity twice": (
        {
            "translation": motion(np.zeros(3)),
            "initial_velocity": [1.0, 0, 0],
        },
        "velocity given twice",
    ),
    "axial velocity": (
        {"translation": "in-plane", "initial_velocity": [1.0, 0, 0.5]},
        "0.5 m/s along the spin axis",
    ),
    "skew plane by mass": (
        {
            "translation": "in-plane",
            "locking": "mass",
            "rotation": [[0.8, 0, 0.6], [0, 1, 0], [-0.6, 0, 0.8]],
        },
        "skew to the inertial axes",
    ),
    "reflection": ({"rotation": np.diag([1.0, 1.0, -1.0])}, "rotation: needs a rotation matrix"),
    "stretch": ({"rotation": 1.1 * np.eye(3)}, "rotation: needs a rotation matrix"),
    "words as rotation": ({"rotation": "RotX"}, r"rotation: needs .* shape \(3, 3\), got 'RotX'"),
    "modal count": (
        {"modal_coordinates": [0.0, 0.0]},
        r"modal_coordinates \(one per mode: tilt 1, tilt 2, mode 1.*needs finite .* shape \(4,\)",
    ),
    "modal rates": ({"modal_velocities": [NAN] * 4}, "modal_velocities"),
    "color": ({"color": (1.0, 0.0, 0.0)}, r"color: needs .* shape \(4,\)"),
    "negative damping": ({"stiffness_damping": -1.0}, r"stiffness_damping: .* \[s\] ≥ 0"),
    "words as damping": ({"mass_damping": "low"}, "mass_damping: needs a finite number"),
    "nan position": ({"position": [0, 0, NAN]}, "position"),
    "nan rotation": ({"rotation": np.full((3, 3), NAN)}, "rotation"),
    "nan velocity": ({"initial_velocity": [NAN, 0, 0]}, "initial_velocity"),
    "nan speed": ({"initial_speed": NAN}, "initial_speed"),
    "nan angle": ({"initial_angle": NAN}, "initial_angle"),
    "nan gravity": ({"gravity": [0, NAN, 0]}, "gravity"),
    "nan damping": ({"mass_damping": NAN}, "mass_damping"),
    "nan offset": ({"marker_offsets": {"left": [NAN, 0, 0]}}, "marker_offsets: 'left'"),
    "nan colour": ({"color": (NAN, 0, 0, 1)}, "color"),
    "nan spin": ({"spin": NAN}, "spin: .* got nan"),
    "nan θ(t)": ({"spin": motion(NAN)}, "spin: its value at t = 0"),
    "flat τ(t)": (
        {"translation": motion(0.0)},
        r"translation: its value at t = 0: needs .*shape \(3,\)",
    ),
}


@pytest.mark.parametrize("case", CASES)
def test_bad_input_adds_nothing(reduced, case):
    arguments, message = CASES[case]
    mbs = exu.SystemContainer().AddSystem()
    add_rotor(mbs, reduced, name="taken")
    before = counts(mbs)
    with pytest.raises((ValueError, TypeError), match=message):
        add_rotor(mbs, reduced, **arguments)
    assert counts(mbs) == before


KINDS = [
    ({"markers": ["rigid"]}, TypeError, "markers: needs 'rigid', 'position' or a mapping"),
    ({"markers": 3}, TypeError, "markers: needs 'rigid', 'position' or a mapping"),
    ({"negligible": "a"}, TypeError, "negligible: .* got 'a'"),
    ({"negligible": NAN}, ValueError, "negligible: .* got nan"),
    ({"initial_speed": "1"}, TypeError, "initial_speed: needs a finite number .* got '1'"),
]


@pytest.mark.parametrize(("arguments", "kind", "message"), KINDS)
def test_wrong_kinds_add_nothing(reduced, arguments, kind, message):
    mbs = exu.SystemContainer().AddSystem()
    with pytest.raises(kind, match=message):
        add_rotor(mbs, reduced, **arguments)
    assert counts(mbs) == [0] * 5


def test_sensors_of_what_is_not_there(solid, reduced):
    mbs = exu.SystemContainer().AddSystem()
    free = add_rotor(mbs, reduced, name="free", markers={"left": "rigid"})
    plain = add_rotor(mbs, reduced.without_shapes(), name="plain", spin=1.0)
    bare = add_rotor(mbs, reduced, name="bare", marker_body=False, spin=1.0)
    before = counts(mbs)
    kind = exu.OutputVariableType.Position
    last = solid.node_count - 1
    for node in (-1, last + 1):
        with pytest.raises(ValueError, match=f"mesh nodes 0 … {last}, not {node}"):
            free.add_node_sensor(node, kind)
    with pytest.raises(ValueError, match="without shapes"):
        plain.add_node_sensor(0, kind)
    with pytest.raises(ValueError, match="'right'; markers: left"):
        free.add_interface_sensor("right", kind)
    with pytest.raises(ValueError, match="spins freely"):
        free.add_drive_torque_sensor()
    with pytest.raises(ValueError, match="this sensor needs one"):
        bare.add_drive_torque_sensor()
    with pytest.raises(ValueError, match="prescribed spin has no node"):
        bare.add_spin_sensor()
    assert counts(mbs) == before
    mbs.AddMarker(MarkerNodeCoordinate(nodeNumber=bare.nodes["coordinates"], coordinate=0))
