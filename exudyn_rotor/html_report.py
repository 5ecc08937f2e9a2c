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
from exudyn_rotor.linear.model.linear_model import LinearModel
from exudyn_rotor.storage import write_bytes
from exudyn_rotor.units import Units

_SHARPNESS = 110  # dots per inch

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
    contents: Mapping[str, Any],
    *,
    title: str = "Rotordynamics report",
    units: str = "rpm",
    raised: Iterable[WarningMessage | Warning | str] = (),
) -> None:
    """Write rotor and results to one HTML file, which needs nothing beside it.

    Every result is shown by its table, and its picture where ``plot()`` needs no arguments.

    Parameters
    ----------
    path : str or path-like
        Ends with '.html'; a file of that name is replaced only by a complete one.
    contents : mapping of heading to object, or to a sequence of objects
        In the order of the report. An object is a result or anything else with ``table()``,
        matplotlib Axes or a Figure, text, a paragraph, or a rotor, a train of rotors, a support, a
        foundation or a linear model, shown by its lines of text. A result beside Axes under one
        heading is shown with these in place of its own picture.
    title : str, optional
    units : {'rpm', 'Hz', 'SI'}, optional
        Of speeds in tables and pictures; see :meth:`exudyn_rotor.units.Units.of`.
    raised : iterable, optional
        Warnings to list, as ``warnings.catch_warnings(record=True)`` collects them.

    Raises
    ------
    TypeError
        If `path` is no path.
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
    >>> contents = {"Critical speeds": [found, "The rotor runs at 300 rpm."]}
    >>> with tempfile.TemporaryDirectory() as folder:
    ...     report(Path(folder, "rotor.html"), contents, title="Pump")
    ...     text = Path(folder, "rotor.html").read_text(encoding="utf-8")
    >>> "<h1>Pump</h1>" in text, "954.93" in text
    (True, True)
    """
    if checks.path(path).suffix not in (".html", ".htm"):
        raise ValueError(f"path: needs the ending .html, got {str(path)!r}")
    checks.label(title, "title")
    Units.of(units)
    listed = checks.items(raised, "raised", "warnings in a sequence")
    messages = [str(getattr(one, "message", one)) for one in listed]
    checks.mapping(contents, "contents", "object or objects")
    sections = {heading: _listed(given) for heading, given in contents.items()}
    if not sections or not all(sections.values()):
        raise ValueError("contents: there are none; give results, pictures, rotors or text")
    with rc_context({"font.size": rcParamsDefault["font.size"]}):  # plots of Exudyn change it
        written = {heading: _html(given, heading, units) for heading, given in sections.items()}
    if messages:
        boxes = (f'<p class="warning">{escape(text)}</p>' for text in dict.fromkeys(messages))
        written["Warnings"] = "\n".join(boxes)
    links, parts = [], []
    for number, (heading, html) in enumerate(written.items()):
        links.append(f'<li><a href="#s{number}">{escape(heading)}</a></li>')
        parts.append(f'<section id="s{number}">\n<h2>{escape(heading)}</h2>\n{html}\n</section>')
    body = "\n".join(["<nav><ol>", *links, "</ol></nav>", *parts])
    day = date.today().isoformat()
    made_by = f"exudyn_rotor {sys.modules[__package__].__version__}, Exudyn {exudyn.__version__}"
    page = _PAGE.format(title=escape(title), day=day, made_by=made_by, body=body)
    write_bytes(path, page.encode())


def _listed(given: Any) -> list[Any]:
    """Return the objects of a sequence, or of an array of axes."""
    if isinstance(given, list | tuple | np.ndarray):
        return [one for each in given for one in _listed(each)]
    return [given]


def _html(items: list[Any], heading: str, units: str) -> str:
    """Return the objects under a heading as HTML."""
    pictured = any(isinstance(item, Axes | Figure) for item in items)
    parts, figures = [], []
    for item in items:
        if isinstance(item, str):
            parts.append(f"<p>{escape(item)}</p>")
        elif isinstance(item, Axes | Figure):
            made = plotting.whole_figure(item)
            if made not in figures:  # a Bode diagram has two axes
                figures.append(made)
                parts.append(_picture(made, heading))
        elif callable(getattr(item, "table", None)):
            if not pictured and _draws_alone(item):
                made = np.ravel(_called(item.plot, units))[0].figure
                parts.append(_picture(made, heading))
                pyplot.close(made)
            parts.append(f"<pre>{escape(_called(item.table, units))}</pre>")
        else:
            parts.append(f"<pre>{escape(_described(item))}</pre>")
    return "\n".join(parts)


def _described(item: Any) -> str:
    """Return what a rotor, a support or a model is, as lines of text."""
    if isinstance(item, LinearModel):
        supports = [repr(one) for each in item.supports.values() for one in each]
        return "\n".join([repr(item), *supports])
    return item.summary() if hasattr(item, "summary") else repr(item)


def _draws_alone(result: Any) -> bool:
    """True where a result has a method ``plot()`` that needs no arguments."""
    plot = getattr(result, "plot", None)
    given = inspect.signature(plot).parameters.values() if plot else ()
    return plot is not None and all(p.default is not p.empty for p in given)


def _called(method: Callable, units: str) -> Any:
    """Call a method with the units of the report, where it knows units."""
    knows = "units" in inspect.signature(method).parameters
    return method(units=units) if knows else method()


def _picture(made: Figure, heading: str) -> str:
    content = io.BytesIO()
    made.savefig(content, format="png", dpi=_SHARPNESS)
    data = base64.b64encode(content.getvalue()).decode("ascii")
    return f'<img alt="{escape(heading)}" src="data:image/png;base64,{data}">'
