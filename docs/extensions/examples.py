"""The directive ``example``: a script of ``examples/`` by name, what it says, its code folded."""

import ast
from pathlib import Path

from docutils import nodes
from sphinx.application import Sphinx
from sphinx.util.docutils import SphinxDirective

EXAMPLES = Path(__file__).parents[2] / "examples"


class Example(SphinxDirective):
    """The docstring of a script as text, then its code."""

    required_arguments = 1

    def run(self) -> list[nodes.Node]:
        """Read the script."""
        path = EXAMPLES / f"{self.arguments[0]}.py"
        source = path.read_text(encoding="utf-8")
        self.env.note_dependency(str(path))
        tree = ast.parse(source)
        text = ast.get_docstring(tree).replace("``", "").split("\n\n")
        code = "\n".join(source.splitlines()[tree.body[0].end_lineno :]).strip()
        said = [nodes.paragraph(text=" ".join(part.split())) for part in text]
        opened = f"<details><summary><code>python examples/{path.name}</code></summary>"
        return [
            *said,
            nodes.raw("", opened, format="html"),
            nodes.literal_block(code, code, language="python"),
            nodes.raw("", "</details>", format="html"),
        ]


def setup(app: Sphinx) -> dict:
    """Register the directive."""
    app.add_directive("example", Example)
    return {"parallel_read_safe": True, "parallel_write_safe": True}
