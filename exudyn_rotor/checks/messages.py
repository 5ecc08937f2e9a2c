"""How a refusal shows a value and says what is expected."""

from __future__ import annotations

import numpy as np
import scipy.sparse as sp

_LONGEST = 80  # characters of a value in a message


def shown(value: object) -> str:
    """Return a value as a message shows it: arrays by shape and kind, long texts cut."""
    if isinstance(value, np.ndarray) and value.size > 6:
        return f"an array of shape {value.shape}, {value.dtype}"
    if sp.issparse(value):
        return f"a sparse matrix of shape {value.shape}"
    try:
        text = repr(value)
    # repr of a foreign object, or of an integer beyond Python's limit of digits
    except Exception:
        return f"a value of type {type(value).__name__}"
    text = " ".join(text.split())
    text = text[: _LONGEST - 1] + "…" if len(text) > _LONGEST else text
    return text if isinstance(value, _PLAIN) else f"{text} ({type(value).__name__})"


_PLAIN = (str, bool, int, float, complex, type(None), list, tuple, np.ndarray, np.number)


def told(name: str, needed: str, value: object) -> str:
    """Return the message of a refusal: which argument, what it needs, and what it got."""
    return f"{name}: needs {needed}, got {shown(value)}"


def of_unit(unit: str) -> str:
    """Return a unit in brackets, after a blank; nothing for none."""
    return f" [{unit}]" if unit else ""
