"""Sphinx: how the pages of this folder become the documentation site.

pip install -e '.[docs]' && sphinx-build -W -b html docs build/site
"""

import sys
from pathlib import Path

sys.path[:0] = [str(Path(__file__).parent), str(Path(__file__).parents[1] / "plugins")]

from mpmkit.version import __version__  # noqa: E402

project = "mpmkit"
author = "The mpmkit developers"
copyright = author
version = release = __version__

extensions = [
    "myst_parser",
    "sphinx.ext.autodoc",
    "sphinx.ext.autosummary",
    "sphinx.ext.napoleon",
    "site_parts",
]
exclude_patterns = ["figures", "data", "validation_report", "**/*.template.md"]
nitpicky = False

myst_heading_anchors = 4

autodoc_member_order = "bysource"
autodoc_typehints = "description"
autodoc_typehints_description_target = "documented"
napoleon_google_docstring = True
napoleon_use_rtype = False

html_theme = "furo"
html_title = f"mpmkit {release}"
html_static_path: list[str] = []
html_show_copyright = False
templates_path: list[str] = []
