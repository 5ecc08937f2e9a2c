"""A report of rotor and results: one HTML file that holds tables, pictures and all."""

from __future__ import annotations

import base64
import inspect
import io
import sys
from collections.abc import Callable, Iterable, Mapping
from datetime import date
from html import escape
from os import PathLike
from typing import Any
from warnings import WarningMessage

import exudyn
import numpy as np
from matplotlib import pyplot, rc_context, rcParamsDefault
from matplotlib.axes import Axes
from matplotlib.figure import Figure

from exudyn_rotor import checks, plotting
from exudyn_rotor.descriptions import DESCRIBED, SUPPORTS, described, described_supports
from exudyn_rotor.export import csv_text
from exudyn_rotor.foundations.foundation import Foundation
from exudyn_rotor.linear.model.linear_model import LinearModel
from exudyn_rotor.linear.model.rotor_train import RotorTrain
from exudyn_rotor.reduction.reduced_rotor import ReducedRotor
from exudyn_rotor.solid_rotor import SolidRotor
from exudyn_rotor.storage import write_text
from exudyn_rotor.units import Units

_SHARPNESS = 110  # dots per inch
_KNOWN = (str, Axes, Figure, *SUPPORTS, *DESCRIBED)
_HOW = (
    "a rotor, a train of them, supports, a linear model, a result with table(), axes or a figure, "
    "or text"
)

_PAGE = """<!DOCTYPE html>
<html lang="en">
<head>
<meta charset="utf-8">
<meta name="viewport" content="width=device-width, initial-scale=1">
<title>{title}</title>
<style>
body {{ font: 15px/1.5 system-ui, sans-serif; color: #222; max-width: 62em; margin: 2em auto;
  padding: 0 1em; }}
h1 {{ font-size: 1.7em; margin-bottom: 0; }}
h2 {{ font-size: 1.25em; border-bottom: 1px solid #bbb; margin-top: 2em; }}
.date {{ color: #666; margin-top: 0; }}
pre {{ font: 13px/1.4 ui-monospace, "DejaVu Sans Mono", monospace; background: #f6f7f8;
  padding: 0.8em; overflow: auto; max-height: 32em; }}
img {{ max-width: 100%; height: auto; display: block; margin: 1em 0; }}
nav li {{ line-height: 1.4; }}
.warning {{ border-left: 4px solid #d55e00; background: #fdf3ec; padding: 0.4em 0.8em;
  margin: 0.5em 0; }}
@media print {{ pre {{ max-height: none; white-space: pre-wrap; }} nav {{ display: none; }} }}
</style>
</head>
<body>
<h1>{title}</h1>
<p class="date">{day}, {made_by}</p>
{body}
</body>
</html>
"""


def report(
    path: str | PathLike,
    contents: Any,
    *,
    title: str = "Rotordynamics report",
    units: str = "rpm",
    raised: Iterable[WarningMessage | Warning | str] = (),
) -> None:
    """Write rotor and results to one HTML file, which needs nothing beside it.

    Every result is shown by its table, its picture where ``plot()`` needs no arguments, and a link
    that saves its columns as CSV.

    Parameters
    ----------
    path : str or path-like
        Ends with '.html'; a file of that name is replaced only by a complete one.
    contents : sequence of objects, mapping of heading to object or objects, or sequence of both
        In the order of the report. An object is a SolidRotor (its summary), a ReducedRotor (mass,
        inertia, modes, interfaces), a RotorTrain, a support, a bearing or a sequence of them, a
        Foundation, a linear model (supports, links, stiffening, free motions; of a scene its rotor
        and supports), a result or anything else with ``table()``, matplotlib Axes or a Figure, or
        text, a paragraph. A mapping gives headings; a result beside Axes under one heading is shown
        with these in place of its own picture.
    title : str, optional
    units : {'rpm', 'Hz', 'SI'}, optional
        Of speeds in tables and pictures; see :meth:`exudyn_rotor.units.Units.of`.
    raised : iterable, optional
        Warnings to list, as ``warnings.catch_warnings(record=True)`` collects them.

    Raises
    ------
    TypeError
        If a content is none of these, or `path` is no path.
    ValueError
        If `units` is unknown, the path ends otherwise, or there is no content.
    OSError
        If the file cannot be written.

    Examples
    --------
    >>> import tempfile
    >>> from pathlib import Path
    >>> from exudyn_rotor import CriticalSpeeds, report
    >>> found = CriticalSpeeds(1.0, [100.0], [0.0], ("forward",), [1], [[1.0]])
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     report(Path(folder, "rotor.html"), [found, "The rotor runs at 300 rpm."], title="Pump")
    ...     text = Path(folder, "rotor.html").read_text(encoding="utf-8")
    >>> "<h1>Pump</h1>" in text, "954.93" in text
    (True, True)
    """
    if checks.path(path).suffix not in (".html", ".htm"):
        raise ValueError(f"path: needs the ending .html, got {str(path)!r}")
    checks.label(title, "title")
    Units.of(units)
    messages = [_message(one) for one in checks.items(raised, "raised", "warnings in a sequence")]
    if isinstance(contents, str) and not contents.strip():
        raise ValueError(f"contents: is empty text; give {_HOW}")
    sections = _sections(contents)
    if not sections:
        raise ValueError(f"contents: there are none; give {_HOW}")
    with rc_context({"font.size": rcParamsDefault["font.size"]}):  # plots of Exudyn change it
        written = [(heading, _html(items, heading, units)) for heading, items in sections]
    if messages:
        boxes = (f'<p class="warning">{escape(text)}</p>' for text in dict.fromkeys(messages))
        written.append(("Warnings", "\n".join(boxes)))
    links, parts = [], []
    for number, (heading, html) in enumerate(written):
        links.append(f'<li><a href="#s{number}">{escape(heading)}</a></li>')
        parts.append(f'<section id="s{number}">\n<h2>{escape(heading)}</h2>\n{html}\n</section>')
    body = "\n".join(["<nav><ol>", *links, "</ol></nav>", *parts])
    day = date.today().isoformat()
    made_by = f"exudyn_rotor {sys.modules[__package__].__version__}, Exudyn {exudyn.__version__}"
    write_text(path, _PAGE.format(title=escape(title), day=day, made_by=made_by, body=body))


# ------------------------------------------------------------------ what is given


def _sections(contents: Any) -> list[tuple[str, list[Any]]]:
    """Return headings with the objects under them, all checked."""
    sections = []
    for number, content in enumerate(contents if _several(contents) else [contents]):
        named = content if isinstance(content, Mapping) else {_heading(content): content}
        for heading, given in named.items():
            checks.label(heading, "contents: heading")
            where = f"contents[{number}]"
            if isinstance(content, Mapping):
                where += f"[{heading!r}]"
            sections.append((heading, _items(given, where)))
    return sections


def _several(given: Any) -> bool:
    return isinstance(given, list | tuple) or (isinstance(given, np.ndarray) and given.ndim > 0)


def _items(given: Any, where: str) -> list[Any]:
    """Return the objects of a sequence, and of sequences and arrays of axes in it."""
    if _several(given):
        if not len(given):
            raise ValueError(f"{where}: there are none; give {_HOW}")
        return [item for one in list(given) for item in _items(one, where)]
    _check(given, where)
    return [given]


def _check(content: Any, where: str) -> None:
    table = None if isinstance(content, type) else getattr(content, "table", None)
    if isinstance(content, exudyn.MainSystem):
        raise TypeError(f"{where}: give a scene as linear_model(mbs, body=…), got a MainSystem")
    if not isinstance(content, _KNOWN) and not callable(table):
        raise TypeError(f"{where}: needs {_HOW}, got {checks.shown(content)}")


def _heading(content: Any) -> str:
    """Return a heading for an object that is given without one."""
    first = content[0] if isinstance(content, list | tuple) and content else content
    for kinds, heading in _HEADINGS.items():
        if isinstance(first, kinds):
            return heading
    if isinstance(first, str):
        return "Remarks"
    if isinstance(first, Axes | Figure | np.ndarray):
        return "Picture"
    words = "".join(f" {c.lower()}" if c.isupper() else c for c in type(first).__name__)
    return words.strip().capitalize()


_HEADINGS = {
    SUPPORTS: "Supports",
    (SolidRotor, ReducedRotor): "Rotor",
    RotorTrain: "Rotors",
    Foundation: "Foundation",
    LinearModel: "Linear model",
}


def _message(warning: Any) -> str:
    """Return the text of a warning."""
    if isinstance(warning, WarningMessage):
        warning = warning.message
    if not isinstance(warning, str | Warning):
        raise TypeError(f"raised: needs warnings or texts, got {checks.shown(warning)}")
    return str(warning)


# ------------------------------------------------------------------ what is written


def _html(items: list[Any], heading: str, units: str) -> str:
    """Return the objects under a heading as HTML."""
    pictured = any(isinstance(item, Axes | Figure) for item in items)
    supports = [item for item in items if isinstance(item, SUPPORTS)]
    parts, figures = [], []
    for item in items:
        if isinstance(item, str):
            parts.append(f"<p>{escape(item)}</p>")
        elif isinstance(item, Axes | Figure):
            made = plotting.whole_figure(item)
            if made not in figures:  # a Bode diagram has two axes
                figures.append(made)
                parts.append(_picture(made, heading))
        elif isinstance(item, SUPPORTS):
            if item is supports[0]:
                parts.append(_pre(described_supports(supports)))
        elif isinstance(item, DESCRIBED):
            parts.append(_pre(described(item)))
        else:
            parts.append(_result(item, heading, units, not pictured))
    return "\n".join(parts)


def _result(result: Any, heading: str, units: str, pictured: bool) -> str:
    """Return table, picture and columns of a result."""
    parts = [_pre(_with_units(result.table, units)())]
    plot = getattr(result, "plot", None)
    if pictured and callable(plot) and not _required(plot):
        drawn = _with_units(plot, units)()
        made = np.ravel(drawn)[0].figure
        parts.insert(0, _picture(made, heading))
        pyplot.close(made)
    columns = getattr(result, "columns", None)
    if callable(columns):
        parts.append(_download(_with_units(columns, units)(), heading))
    return "\n".join(parts)


def _with_units(method: Callable, units: str) -> Callable:
    """Return a method with the units of the report, where it knows units."""
    if "units" not in inspect.signature(method).parameters:
        return method
    return lambda: method(units=units)


def _required(method: Callable) -> bool:
    """Return whether a method cannot be called without arguments."""
    kinds = (inspect.Parameter.VAR_POSITIONAL, inspect.Parameter.VAR_KEYWORD)
    given = inspect.signature(method).parameters.values()
    return any(p.default is p.empty and p.kind not in kinds for p in given)


def _pre(text: str) -> str:
    return f"<pre>{escape(text)}</pre>"


def _picture(made: Figure, heading: str) -> str:
    content = io.BytesIO()
    made.savefig(content, format="png", dpi=_SHARPNESS)
    data = base64.b64encode(content.getvalue()).decode("ascii")
    return f'<img alt="{escape(heading)}" src="data:image/png;base64,{data}">'


def _download(columns: Mapping[str, np.ndarray], heading: str) -> str:
    """Return a link that saves columns as a CSV file."""
    data = base64.b64encode(csv_text(columns).encode("utf-8")).decode("ascii")
    name = escape("_".join(heading.lower().split()) + ".csv")
    return f'<p><a download="{name}" href="data:text/csv;base64,{data}">{name}</a></p>'
