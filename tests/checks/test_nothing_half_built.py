"""Whatever is refused, the system keeps the items that it had: every argument, every method."""

import exudyn as exu
import numpy as np
import pytest
from exudyn.FEM import FEMinterface
from models import STEEL, block_beam
from point_rotors import ring_rotor

from exudyn_rotor import PrescribedMotion, add_rotor

KINDS = exu.OutputVariableType
NAN, INFINITE = float("nan"), float("inf")


class Unprintable:
    """A foreign object whose every use raises."""

    def __repr__(self):
        raise RuntimeError

    __bool__ = __len__ = __iter__ = __array__ = __repr__


def masked(size):
    return np.ma.masked_array(np.ones(size), mask=[True] + [False] * (size - 1))


def motion(value, rate=None, acceleration=None):
    parts = (value, value if rate is None else rate, value if acceleration is None else 0.0)
    return PrescribedMotion(*(part if callable(part) else lambda t, p=part: p for part in parts))


ANYTHING = [Unprintable(), object(), exu, lambda: 1.0, {"a": 1}, {1, 2}, b"no", 1 + 2j]
FLAG = [*ANYTHING, None, "no", "", 0, 1, 0.5, [], [True], np.array([True, False]), np.ones(3)]
NUMBER = [*ANYTHING, "1", "", [], [1.0], np.ones(3), masked(3), True, NAN, INFINITE, 10**400]
VECTOR = [
    *(*ANYTHING, "123", "", [], [1.0], 3.0, np.ones((3, 1)), masked(3), [True, False, True]),
    *([NAN, 0.0, 0.0], [INFINITE, 0, 0], [10**400, 0, 0], [1, 2, [3]], ["1", "2", "3"]),
    [1.0, 2.0, 3.0j],
]
WORD = [*ANYTHING, None, "", "unknown", 3, True, [], ["free"], np.ones(3)]
SPIN = [*ANYTHING, None, "", "unknown", True, [], ["free"], np.ones(3), NAN, 10**400]
NAME = [*ANYTHING, "", "  ", 3, True, [], ["rotor"], np.ones(3), "\ud800", "taken"]
ROTATION = [*VECTOR, np.eye(2), 2.0 * np.eye(3), np.diag([1.0, 1.0, -1.0]), "x"]
COLOR = [*VECTOR, None, [0, 0, 0], [2.0, 0, 0, 1], [-0.1, 0, 0, 1], ["a"] * 4]
DAMPING = [*NUMBER, None, -1.0]
WRONG_SPIN = [motion(NAN), motion("1"), motion([1.0]), motion(lambda: 1.0), motion(1.0, [0.0])]
WRONG_TRANSLATION = [motion(0.0), motion(np.full(3, NAN)), motion("abc"), motion(np.ones((3, 1)))]

ROTOR = {
    "mbs": [*ANYTHING, None, exu.SystemContainer()],
    "rotor": [*ANYTHING, None, "rotor.npz"],
    "name": NAME,
    "translation": [*WORD, *WRONG_TRANSLATION],
    "spin": [*SPIN, *WRONG_SPIN],
    "drive": WORD,
    "stiffening": [*WORD, "full"],
    "position": [*VECTOR, None],
    "rotation": ROTATION,
    "initial_velocity": [*VECTOR, None],
    "initial_angle": NUMBER,
    "initial_speed": NUMBER,
    "modal_coordinates": VECTOR,
    "modal_velocities": VECTOR,
    "gravity": [*VECTOR, None],
    "mass_damping": DAMPING,
    "stiffness_damping": DAMPING,
    "markers": [*ANYTHING, "", "unknown", 3, [], ["rigid"], {"all": "ring"}, {"all": 3}, {3: "a"}],
    "marker_offsets": [*ANYTHING, "", 3, [], {"none": [0, 0, 0]}, *({"all": v} for v in VECTOR)],
    "show_markers": FLAG,
    "locking": WORD,
    "marker_body": FLAG,
    "negligible": [*NUMBER, None, -1.0, 1.0],
    "color": COLOR,
}
TWIN = {
    "name": NAME,
    "femInterface": [*ANYTHING, None, "rotor.npz", ring_rotor(0.1, 0.1, 2.0)],
    "referencePosition": [*VECTOR, None],
    "initialVelocity": [*VECTOR, None],
    "referenceRotationMatrix": [*ROTATION, None],
    "initialAngularVelocity": [*VECTOR, None, [1.0, 0.0, 0.0]],
    "massProportionalDamping": DAMPING,
    "stiffnessProportionalDamping": DAMPING,
    "gravity": [*VECTOR, None],
    "color": COLOR,
    "superElementRigidMarkersOffsets": [*VECTOR, np.ones((3, 3)), masked(3)],
    "showMarkers": FLAG,
    "verbose": FLAG,
    "axis": [*ANYTHING, "", "w", 3.0, [], [0, 0, 0], [NAN, 0, 0], masked(3), "zz"],
    "translation": [*WORD, *WRONG_TRANSLATION],
    "spin": [*SPIN, *WRONG_SPIN],
    "stiffening": [*WORD, "full"],
    "locking": WORD,
    "markers": ROTOR["markers"],
    "prestress": [*ANYTHING, True, "full", 3, np.ones(3)],
}
OPTIONS = {
    "name": NAME,
    "storeInternal": FLAG,
    "writeToFile": FLAG,
    "fileName": [*ANYTHING, None, "", 3, [], "\0"],
    "sensorType": ["Node"],
    "outputVariableType": [3],
}
SHOWN = OPTIONS | {"visualization": [*ANYTHING, None, 3, "no", {"show": "no"}, {"size": 1}]}
OUTPUT = [*ANYTHING, None, 3, "Displacement", KINDS._None, KINDS.Force, KINDS.StressLocal]
METHODS = {
    "add_node_sensor": (
        {"node": 0, "output": KINDS.Position},
        SHOWN | {"node": [*NUMBER, None, 1.5, 1.0, -1, 10], "output": OUTPUT},
    ),
    "add_interface_sensor": (
        {"interface": "all", "output": KINDS.Position},
        SHOWN | {"interface": [*WORD, "none"], "output": OUTPUT},
    ),
    "add_spin_sensor": ({}, OPTIONS | {"visualization": [{"show": True}]}),
    "add_drive_torque_sensor": ({}, OPTIONS | {"visualization": [{"show": True}]}),
}


def counts(mbs):
    data = mbs.systemData
    return [
        getattr(data, f"NumberOf{kind}")()
        for kind in ("Nodes", "Objects", "Markers", "Loads", "Sensors")
    ]


@pytest.fixture(scope="module")
def reduced():
    return ring_rotor(0.1, 0.1, 2.0).with_interface("all", list(range(10))).reduce(0)


@pytest.fixture(scope="module")
def fem():
    model = FEMinterface()
    model.ImportMeshFromNGsolve(
        block_beam(0.1),
        materials={"steel": STEEL},
        boundaryNamesList=["left", "right"],
        meshOrder=1,
    )
    model.ComputeEigenmodes(1, excludeRigidBodyModes=6)
    return model


def refused(mbs, call, arguments, name, value):
    """Make the call; return what is wrong about how it was refused, empty where nothing is."""
    before = counts(mbs)
    try:
        call(**(arguments | {name: value}))
    except (TypeError, ValueError) as error:
        message = str(error)
        complaint = "" if name in message else f"does not name it: {message}"
    except Exception as error:
        complaint = f"{type(error).__name__}: {error}"
    else:
        complaint = "accepted"
    if counts(mbs) != before:
        complaint += ", half-built"
    if not complaint:
        return ""
    text = "unprintable" if isinstance(value, Unprintable) else f"{value!r}"
    return f"{name}={text[:60]}: {complaint[:200]}"


def all_refused(mbs, call, arguments, bad):
    found = [refused(mbs, call, arguments, name, value) for name in bad for value in bad[name]]
    assert not any(found), "\n".join(filter(None, found))


@pytest.mark.parametrize("argument", ROTOR)
def test_add_rotor(reduced, argument):
    mbs = exu.SystemContainer().AddSystem()
    add_rotor(mbs, reduced, name="taken")
    fixed = {"spin": 10.0} if argument == "drive" else {}
    arguments = {"mbs": mbs, "rotor": reduced, "name": "rotor"} | fixed
    all_refused(mbs, add_rotor, arguments, {argument: ROTOR[argument]})


@pytest.mark.parametrize("argument", TWIN)
def test_twin_of_exudyns_call(fem, argument):
    mbs = exu.SystemContainer().AddSystem()
    mbs.CreateFixedAxisFFRFReducedOrderObject("taken", fem, axis="z")
    arguments = {"name": "rotor", "femInterface": fem, "axis": "z"}
    call = mbs.CreateFixedAxisFFRFReducedOrderObject
    all_refused(mbs, call, arguments, {argument: TWIN[argument]})


@pytest.mark.parametrize("method", METHODS)
def test_sensors(reduced, method):
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(mbs, reduced, spin=10.0, translation="none")
    body.add_spin_sensor(name="taken")
    arguments, bad = METHODS[method]
    all_refused(mbs, getattr(body, method), arguments, bad)


def test_recording_of_an_assembled_system(reduced):
    mbs = exu.SystemContainer().AddSystem()
    body = add_rotor(mbs, reduced)
    mbs.Assemble()
    before = counts(mbs)
    with pytest.raises(ValueError, match=r"before mbs\.Assemble"):
        body.start_recording()
    assert counts(mbs) == before
