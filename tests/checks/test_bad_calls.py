"""Wrong arguments of every public call are refused by their names, and nothing is half built.

Each argument of a valid call (`valid_calls.py`) in turn gets wrong values that follow from its
annotation. A run makes a sample of these calls; with EXUDYN_ROTOR_BAD_CALLS=all in the environment
it makes all.
"""

import inspect
import math
import os
import random
import re
from collections.abc import Mapping
from dataclasses import fields, is_dataclass

import matplotlib
import numpy as np
import pytest
import scipy.sparse as sp
from matplotlib import pyplot
from valid_calls import CALLS, MADE, RETURNED, SCENES, SHARED, USUAL

import exudyn_rotor as er

pytestmark = pytest.mark.filterwarnings("ignore")

ALL = os.environ.get("EXUDYN_ROTOR_BAD_CALLS") == "all"
SAMPLE = {"valid": 20, "wrong": 250}  # of some hundreds, and some thousands


NUMBERS = {"float", "int"}
ARRAY = re.compile(r"ArrayLike|np\.ndarray|Sequence\[(float|int)\]|tuple\[float|csr_array|Matrix")
SEVERAL = re.compile(r"Sequence|Iterable|tuple|ArrayLike|np\.ndarray")

# ------------------------------------------------------------------ valid calls

# what has no arguments of its own to refuse
LEFT_OUT = {
    "AssumptionWarning": "a warning takes any text, as every exception of Python",
    "ConnectionWarning": "a warning takes any text, as every exception of Python",
    "LinearModel": "a protocol; linear_model makes what follows it",
    "Result": "the base of classes that are called",
}

# methods that scenes call in every step, with the numbers of the equations
OF_SCENES = (
    *("law", "law_with_torque", "law_along", "slopes", "clearance_along", "film_edge", "coupling"),
    *("solved", "beside", "reach_along", "coefficients_at", "body_acceleration", "unbalance"),
    *("springs", "forces", "tangent", "transmitted", "energy", "loss", "check_places"),
)


def public_calls():
    """Return the names of all that can be called: 'function', 'Class', 'Class.method'."""
    found = []
    for name in set(er.__all__) - set(LEFT_OUT):
        owner = getattr(er, name)
        methods = dir(owner) if inspect.isclass(owner) else []
        found += [name, *(f"{name}.{m}" for m in methods if m[0] != "_" and _is_method(owner, m))]
    return sorted(found)


def _is_method(owner, name):
    if name in OF_SCENES:
        return False
    static = inspect.getattr_static(owner, name)
    return isinstance(static, staticmethod | classmethod) or inspect.isfunction(static)


class World:
    """Objects of the calls, each made when it is first asked for."""

    def __init__(self, folder):
        self.folder = folder
        self.table = folder / "record.csv"
        self.table.write_text("time,x,y,z\n0.0,1,0,0\n0.1,0,1,0\n", encoding="utf-8")

    def __getattr__(self, name):
        if name in MADE:
            made = MADE[name](self)
        else:
            function, given = called(RETURNED.get(name, name), self)
            made = function(**given)
        setattr(self, name, made)
        return made

    def stored(self, name):
        """Return the path of a file that holds the instance of a class."""
        path = self.folder / f"{name}.npz"
        if not path.exists():
            getattr(self, name).save(path)
        return path

    def renew(self):
        """Forget all scenes, after a call that changed one."""
        for name in SCENES:
            self.__dict__.pop(name, None)

    def items(self):
        """Return how many items each scene has."""
        kinds = ("Nodes", "Objects", "Markers", "Loads", "Sensors")
        made = [self.__dict__[name] for name in SCENES if name in self.__dict__]
        scenes = [getattr(scene, "mbs", scene) for scene in made]
        return [getattr(mbs.systemData, f"NumberOf{kind}")() for mbs in scenes for kind in kinds]


def function_of(name):
    """Return the function or class, and whether it needs an instance."""
    owner, _, method = name.partition(".")
    found = getattr(er, owner)
    if not method:
        return found, False
    return getattr(found, method), inspect.isfunction(inspect.getattr_static(found, method))


def parameters(name):
    """Return the parameters of a call, without that of its own instance."""
    found = dict(inspect.signature(function_of(name)[0]).parameters)
    found.pop("self", None)
    return found


def is_required(parameter):
    """Return whether a call cannot go without this parameter."""
    return parameter.default is parameter.empty and parameter.kind is not parameter.VAR_KEYWORD


def arguments(name, w):
    """Return the arguments of a valid call.

    Raises
    ------
    KeyError
        If no table has a required one.
    """
    own = CALLS.get(name, {})
    own = own(w) if callable(own) else dict(own)
    if not own and (name in MADE or name in RETURNED) and is_dataclass(getattr(er, name)):
        made = getattr(w, name)
        return {field.name: getattr(made, field.name) for field in fields(made) if field.init}
    for argument, parameter in parameters(name).items():
        wanted = is_required(parameter) or argument in ("supports", "interface")
        if wanted and argument not in own:
            own[argument] = _usual(name, argument, w)
    return own


def _usual(name, argument, w):
    owner, _, method = name.partition(".")
    if argument == "path":
        return w.stored(owner) if method == "load" else w.folder / f"saved.{method[-3:]}"
    if argument in ("q", "q_t"):
        return np.zeros(w.Motion.size)
    if argument in SHARED:
        return getattr(w, SHARED[argument])
    if argument not in USUAL:
        raise KeyError(f"{name}: no table has a valid value of its argument {argument!r}")
    return USUAL[argument]


def called(name, w):
    """Return a function and the arguments of a valid call, made anew."""
    function, needs_instance = function_of(name)
    given = arguments(name, w)
    if needs_instance:
        instance = given.pop("self", None) or getattr(w, name.partition(".")[0])
        function = getattr(instance, name.partition(".")[2])
    return function, given


# ------------------------------------------------------------------ wrong values


def spoiled(good, entry):
    """Return a copy of a good array or sequence whose last entry is another one."""
    if sp.issparse(good):
        copy = good.astype(float)
        copy.data[-1] = entry
        return copy
    if good is None or isinstance(good, str) or callable(good) or np.size(good) == 0:
        good = np.zeros(3)
    array = np.array(good, dtype=complex if np.iscomplexobj(good) else float)
    array.flat[-1] = entry
    return array


def mapping(good):
    """Return a good mapping; an empty one where the valid call has none."""
    return dict(good) if isinstance(good, Mapping) else {}


def wrong_values(annotation):
    """Return functions that make wrong values from the good one, by label, for an annotation."""
    kinds = set(re.split(r" \| (?![^\[]*\])", annotation))
    found = {"an object": lambda good: object()}
    if not kinds & {"None", "Any"}:
        found["None"] = lambda good: None
    if kinds & NUMBERS:
        found["nan"] = lambda good: math.nan
        found["inf"] = lambda good: math.inf
        found["negative"] = lambda good: -1.0 if "float" in kinds else -1
        found["text"] = lambda good: "nonsense"
        found["flag"] = lambda good: True
        if not SEVERAL.search(annotation):
            found["list"] = lambda good: [1.0, 2.0]
        if "float" not in kinds:
            found["fraction"] = lambda good: 1.5
    if "bool" in kinds:
        found["text"] = lambda good: "no"
        found["number"] = lambda good: 2
    if "str" in kinds:
        if "PathLike" not in annotation:
            found["unknown"] = lambda good: "nonsense"
            found["blank"] = lambda good: "  "
        if not kinds & NUMBERS:
            found["number"] = lambda good: 3.25
        if not SEVERAL.search(annotation):
            found["list"] = lambda good: ["left"]
    if ARRAY.search(annotation) and "Mapping" not in annotation:
        found["text"] = lambda good: "nonsense"
        found["empty"] = lambda good: np.zeros(0)
        found["nan"] = lambda good: spoiled(good, math.nan)
        found["inf"] = lambda good: spoiled(good, math.inf)
        found["texts"] = lambda good: ["a", "b", "c"]
        found["shape"] = lambda good: np.zeros((2, 3, 4, 5))
    if "Mapping" in annotation:
        found["list"] = lambda good: ["left"]
        found["key"] = lambda good: {**mapping(good), 3: 1.0}
        found["entry"] = lambda good: {**mapping(good), "left": object()}
    elif not kinds & {"float", "int", "bool", "str"} and not ARRAY.search(annotation):
        found["text"] = lambda good: "nonsense"
        found["number"] = lambda good: 3.25
    if SEVERAL.search(annotation):
        found["entry"] = lambda good: [object()]
    return found


# ------------------------------------------------------------------ what is taken

# by label: arguments of which such a value is right, by name or by call
RIGHT = {
    "negative": """
        angle current end_speed flank force frequency helix_angle initial_angle
        initial_speed line_angle load no_load_speed place ring_speed speed spin start_speed
        synchronous_speed
        t time value HarmonicResponse.rates.order
        Pad.start PointMass.mass UnbalanceResponse.rates.order""",
    "unknown": "at interface label name sensor title Support.from_columns.source",
    "blank": "Support.from_columns.source",
    "number": "Support.stiffness Support.damping Support.mass tilt_stiffness tilt_damping",
    "empty": """
        eulerParametersRef rotationMatrixRef triangles variation
        BaseRecord.integrals.times Motion.mass_matrix.q_t
        PeriodicResponse.displacement.time
        Spectra.plot.orders Support.matrices.speed Support.mass_matrix.speed
        grooved_pads.grooves
        keep_modes.indices""",
    "nan": "Motion.mass_matrix.q_t ModeBasis.frequencies",
    "inf": "Motion.mass_matrix.q_t ModeBasis.frequencies",
    "shape": "Motion.mass_matrix.q_t",
    "texts": "Motion.mass_matrix.q_t",
    "text": """
        Motion.mass_matrix.q_t at Proposal.reasons ReducedRotor.dropped
        SolidRotor.from_mesh.leave_out""",
    "entry": "SolidRotor.from_ngsolve.materials report.raised report.contents",
    "an object": "Motion.mass_matrix.q_t",
    "None": "UFforce UFmassMatrix BaseResponse.displacement.place BaseResponse.peak.place",
}
# functions and methods where it is wrong all the same
WRONG = {
    "negative": """
        anticipated_cross_coupling.speed from_grade.speed permissible_unbalance.speed
        sensitivity.speed stability_level_one.speed stability_threshold.speed
        standard_unbalances.speed""",
    "unknown": """
        add_drive.at add_interface_sensor.interface add_sensor.name
        connect_rotors.at interface_motion.interface marker.interface marker.name motion.name
        stability_level_one.at""",
    "text": """
        base_response.at harmonic_response.at periodic_response.at
        standard_unbalances.at unbalance_response.at""",
}
# well-formed by themselves: any argument that they do not fit is named
FORMED = {"empty", "shape", "text", "negative"}


def is_right(call, argument, label):
    """Return whether a value that is wrong elsewhere is right for an argument of a call."""
    if f"{call.split('.')[-1]}.{argument}" in WRONG.get(label, "").split():
        return False
    return not {argument, f"{call}.{argument}"}.isdisjoint(RIGHT.get(label, "").split())


# ------------------------------------------------------------------ the property


def is_result(call):
    """Return whether a call constructs a result or a body: analyses, `add_rotor` do."""
    owner = getattr(er, call, None)
    made = (er.Result, er.RotorBody, er.FullRotorBody, er.SceneFoundation)
    return inspect.isclass(owner) and issubclass(owner, made)


def cases():
    """Return all wrong calls: name, argument, label of the wrong value, function that makes it."""
    found = []
    for call in public_calls():
        if is_result(call):
            continue
        for argument, parameter in parameters(call).items():
            if parameter.kind is parameter.VAR_KEYWORD:
                found.append((call, "nonsense", "an object", lambda good: object()))
                continue
            made = wrong_values(str(parameter.annotation))
            found += [
                (call, argument, label, make)
                for label, make in made.items()
                if not is_right(call, argument, label)
            ]
    return found


def complaint(case, world):
    """Return what is wrong with the answer to a wrong call, or None."""
    call, argument, label, make = case
    function, given = called(call, world)
    default = parameters(call).get(argument)
    good = given.get(argument, None if default is None else default.default)
    given[argument] = make(None if good is inspect.Parameter.empty else good)
    before = world.items()
    try:
        function(**given)
    except (TypeError, ValueError) as error:
        said = str(error)
    except Exception as error:
        return f"raised {type(error).__name__}: {error}"
    else:
        world.renew()
        return "taken"
    finally:
        pyplot.close("all")
    if world.items() != before:
        world.renew()
        return f"half built: {said}"
    names = [argument, *(parameters(call) if label in FORMED else ())]
    if not re.search(rf"\b({'|'.join(names)})\b", said):
        return f"names no {argument}: {said}"
    return None


def drawn(everything, kind):
    """Return all, or a sample that is the same in each run."""
    return everything if ALL else random.Random(0).sample(everything, SAMPLE[kind])


@pytest.fixture(scope="module")
def world(tmp_path_factory):
    matplotlib.use("Agg")
    return World(tmp_path_factory.mktemp("bad_calls"))


def test_every_public_call_has_a_valid_one():
    """A new name needs a line in `valid_calls.py` where its arguments have no usual names."""
    names = public_calls()
    known = {"path", "q", "q_t", *USUAL, *SHARED}
    missing = {
        name: unknown
        for name in names
        if not callable(own := CALLS.get(name, {})) and not (name in MADE or name in RETURNED)
        if (unknown := {a for a, p in parameters(name).items() if is_required(p)} - {*known, *own})
    }
    assert not missing
    assert set(CALLS) | set(RETURNED.values()) <= set(names), "calls that are gone"


def test_valid_calls_pass(world, monkeypatch):
    monkeypatch.chdir(world.folder)
    for name in drawn(public_calls(), "valid"):
        function, given = called(name, world)
        function(**given)
        pyplot.close("all")
        world.renew()


def test_wrong_arguments_are_refused_by_name(world, monkeypatch):
    monkeypatch.chdir(world.folder)
    made = drawn(cases(), "wrong")
    answers = {case[:3]: complaint(case, world) for case in made}
    wrong = [
        f"{call}({argument}={label}): {said}"
        for (call, argument, label), said in answers.items()
        if said
    ]
    assert not wrong, "\n".join(wrong)
