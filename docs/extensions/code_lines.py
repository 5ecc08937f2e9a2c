"""The role ``code-line``: a link to the one line of the package that holds a text.

``{code-line}`theory/motion.py: by_v["f", "r"] =``` leads to that line on a page with the whole
file. A text that is gone, or stands in several lines, is a warning, which ends the build.
"""

from collections.abc import Iterator
from pathlib import Path

from docutils import nodes
from pygments import highlight
from pygments.formatters import HtmlFormatter
from pygments.lexers import PythonLexer
from sphinx.application import Sphinx
from sphinx.util import logging
from sphinx.util.docutils import SphinxRole

import exudyn_rotor

PACKAGE = Path(exudyn_rotor.__file__).parent
LOG = logging.getLogger(__name__)


class CodeLine(SphinxRole):
    """Link to a line, shown as its file and number."""

    def run(self) -> tuple[list[nodes.Node], list[nodes.system_message]]:
        """Find the line; without a text, link to the file."""
        path, _, text = self.text.partition(": ")
        file = PACKAGE / path
        lines = file.read_text(encoding="utf-8").splitlines() if file.exists() else []
        found = [number for number, line in enumerate(lines, 1) if text in line] if text else [1]
        if not lines or len(found) != 1:
            LOG.warning(
                "code-line %r: %d lines have it",
                self.text,
                len(found) if lines else 0,
                location=self.get_location(),
            )
            return [nodes.literal(text=self.text)], []
        self.env.code_files = {*getattr(self.env, "code_files", ()), path}
        up = "../" * self.env.docname.count("/")
        shown = f"{path}:{found[0]}" if text else path
        target = f"{up}_code/{path.removesuffix('.py')}.html#line-{found[0]}"
        link = nodes.reference(internal=True, refuri=target, classes=["code-line"])
        link += nodes.literal(text=shown)
        return [link], []


def pages(app: Sphinx) -> Iterator[tuple[str, dict, str]]:
    """Yield a page for every file that is linked."""
    formatter = HtmlFormatter(linenos="inline", lineanchors="line", anchorlinenos=True)
    linked = getattr(app.env, "code_files", ())  # of earlier builds, too: some may be gone
    for path in sorted(path for path in linked if (PACKAGE / path).is_file()):
        source = (PACKAGE / path).read_text(encoding="utf-8")
        body = f"<h1>{path}</h1>{highlight(source, PythonLexer(), formatter)}"
        yield f"_code/{path.removesuffix('.py')}", {"title": path, "body": body}, "page.html"


def setup(app: Sphinx) -> dict:
    """Register the role and its pages."""
    app.add_role("code-line", CodeLine())
    app.connect("html-collect-pages", pages)
    return {"parallel_read_safe": False, "parallel_write_safe": True}
