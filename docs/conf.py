"""Settings of the documentation; CONTRIBUTING.md says how to build it."""

import sys
from pathlib import Path

sys.path.insert(0, str(Path(__file__).parent / "extensions"))

import exudyn_rotor

project = "exudyn_rotor"
author = "the exudyn_rotor developers"
release = exudyn_rotor.__version__

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.napoleon",
    "code_lines",
    "examples",
    "sphinx-mathjax-offline",
]
exclude_patterns = ["_build", "extensions", "*.txt"]
myst_enable_extensions = ["deflist", "dollarmath"]
myst_heading_anchors = 3
suppress_warnings = ["ref.python"]  # attributes of one name in two classes
templates_path = ["_templates"]

autosummary_generate = True
autosummary_filename_map = {  # where the case of letters does not tell campbell from Campbell
    f"{project}.{name}": f"{project}.function-{name}"
    for name in exudyn_rotor.__all__
    if name.islower() and name.title() in exudyn_rotor.__all__
}
autodoc_typehints = "none"
autodoc_member_order = "bysource"
napoleon_google_docstring = True  # of what Exudyn installs
napoleon_use_ivar = True
napoleon_use_rtype = False
napoleon_preprocess_types = False

smartquotes = False  # the search compares letter by letter

html_theme = "pydata_sphinx_theme"
html_title = f"exudyn_rotor {release}"
html_search_scorer = str(Path(__file__).with_name("scorer.js"))
html_static_path = ["_static"]
html_css_files = ["pages.css"]
html_show_sourcelink = False
html_copy_source = False
html_theme_options = {
    "navigation_with_keys": False,
    "secondary_sidebar_items": ["page-toc"],
    "show_prev_next": False,
    "footer_start": [],
    "footer_end": [],
    "pygments_light_style": "default",
}
