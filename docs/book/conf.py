"""The book: `make book` builds it from the exercises' texts and the documents, to results/book."""

project = "botschool"
author = "The botschool authors"
copyright = "The botschool authors, MIT licence"
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx-mathjax-offline"]
root_doc = "docs/book/index"
include_patterns = ["docs/**", "exercises/README.md", "exercises/ex*/README.md"]
include_patterns += ["CONTRIBUTING.md", "lib/botschool/sandbox/README.md"]
# Links to files come along; those to folders are words, as there is nothing to show.
suppress_warnings = ["myst.xref_missing", "misc.highlighting_failure"]
myst_enable_extensions = ["dollarmath", "deflist"]
myst_heading_anchors = 4
html_theme = "furo"
html_title = "botschool"
html_show_sourcelink = False
html_copy_source = False
autodoc_typehints = "description"
