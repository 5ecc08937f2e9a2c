"""One valid call of every public function, constructor and method."""

from __future__ import annotations

import inspect
from collections.abc import Callable, Iterator
from typing import Any

import exudyn_rotor as er
from validation.bad_calls.function_arguments import OF_FUNCTIONS
from validation.bad_calls.instances import INSTANCES
from validation.bad_calls.method_arguments import OF_METHODS
from validation.bad_calls.world import World, arguments

Call = tuple[Callable, dict[str, Any]]
ARGUMENTS = OF_FUNCTIONS | OF_METHODS

# what has no arguments of its own to refuse
LEFT_OUT = {
    "AssumptionWarning": "a warning takes any text, as every exception of Python",
    "ConnectionWarning": "a warning takes any text, as every exception of Python",
    "LinearModel": "a protocol; linear_model makes what follows it",
    "Result": "the base of classes that are called",
}


def _sensor_options(*, storeInternal: bool = True, writeToFile: bool = False) -> None: ...


# whose keyword arguments ``**options`` are; beside them every call gets one that does not exist
OPTIONS: dict[str, Callable] = {
    "stability_threshold": er.stability,
    "unstable_ranges": er.stability,
    "*.add_drive_torque_sensor": _sensor_options,
    "*.add_energy_sensor": _sensor_options,
    "*.add_interface_sensor": _sensor_options,
    "*.add_node_sensor": _sensor_options,
    "*.add_spin_sensor": _sensor_options,
}


def public_calls() -> Iterator[str]:
    """Yield the names of all that can be called: 'function', 'Class', 'Class.method'."""
    for name in sorted(er.__all__):
        if name in LEFT_OUT:
            continue
        yield name
        owner = getattr(er, name)
        if inspect.isclass(owner):
            for method in sorted(dir(owner)):
                static = inspect.getattr_static(owner, method)
                if not method.startswith("_") and _is_method(static):
                    yield f"{name}.{method}"


def _is_method(static: object) -> bool:
    return isinstance(static, staticmethod | classmethod) or inspect.isfunction(static)


def function_of(name: str) -> Callable:
    """Return the function or class behind a name of :func:`public_calls`, as its signature says."""
    owner, _, method = name.partition(".")
    found = getattr(er, owner)
    return getattr(found, method) if method else found


def parameters(name: str) -> dict[str, inspect.Parameter]:
    """Return the parameters of a call without that of its own instance; options one by one."""
    found = dict(inspect.signature(function_of(name)).parameters)
    found.pop("self", None)
    rest = [p.name for p in found.values() if p.kind is p.VAR_KEYWORD]
    if rest:
        del found[rest[0]]
        source = OPTIONS.get(name) or OPTIONS[f"*.{name.partition('.')[2]}"]
        every = inspect.signature(source).parameters.values()
        found |= {p.name: p for p in every if p.kind is p.KEYWORD_ONLY}
        found["nonsense"] = inspect.Parameter("nonsense", inspect.Parameter.KEYWORD_ONLY)
    return found


def valid(name: str, world: World) -> Call:
    """Return a function and the arguments of a valid call, made anew.

    Raises
    ------
    KeyError
        If the call has no entry in the tables above.
    """
    owner, _, method = name.partition(".")
    if method == "load":
        return function_of(name), {"path": world.stored(INSTANCES[owner](world))}
    make = ARGUMENTS.get(name) or ARGUMENTS.get(f"*.{method}")
    function = getattr(er, owner)
    if method:
        static = inspect.getattr_static(function, method)
        bound = isinstance(static, staticmethod | classmethod)
        instance = INSTANCES.get(name, INSTANCES[owner])
        function = getattr(function if bound else instance(world), method)
        required = [
            p
            for p in inspect.signature(function).parameters.values()
            if p.default is p.empty and p.kind is not p.VAR_KEYWORD
        ]
        if make is None and required:
            raise KeyError(f"{name}: no arguments of a valid call in the table")
        return function, make(world) if make else {}
    if make is None:
        return function, arguments(INSTANCES[name](world))
    return function, make(world)
