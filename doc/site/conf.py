"""How Sphinx makes the site out of the pages in doc/; see CMakeLists.txt here."""

project = "impm_dealii"
author = "The impm_dealii authors"
copyright = "The impm_dealii authors"

extensions = ["myst_parser"]
source_suffix = {".md": "markdown"}
root_doc = "index"
exclude_patterns = ["doc/site"]
# As GitHub names them.
myst_heading_anchors = 4
# Pages begin where their folder's listing on a forge would show them.
suppress_warnings = ["myst.header"]
nitpicky = True

html_theme = "sphinx_rtd_theme"
html_title = project
html_show_sourcelink = False
html_show_sphinx = False
html_static_path = ["static"]
html_css_files = ["site.css"]
html_theme_options = {"navigation_depth": 2, "collapse_navigation": False}
