"""What every parameter takes: by its name, and by call where a name means different things."""

from __future__ import annotations

from validation.bad_calls.by_call import BY_CALL
from validation.bad_calls.by_name import BY_NAME
from validation.bad_calls.values import Kind


def kind_of(name: str, parameter: str) -> Kind:
    """Return what a parameter of a call takes.

    Raises
    ------
    KeyError
        If no table above says so.
    """
    method = name.partition(".")[2]
    for key in ((name, parameter), (f"*.{method}", parameter)):
        if key in BY_CALL:
            return BY_CALL[key]
    if parameter not in BY_NAME:
        raise KeyError(f"{name}: no table says what its argument {parameter!r} takes")
    return BY_NAME[parameter]
