"""The book: `make book` builds it from the exercises' texts and the documents, to results/book."""

project = "botschool"
author = "The botschool authors"
copyright = "The botschool authors, MIT licence"
extensions = ["myst_parser", "sphinx.ext.autodoc", "sphinx.ext.napoleon", "sphinx-mathjax-offline"]
root_doc = "docs/book/index"
include_patterns = ["docs/**", "exercises/README.md", "exercises/ex*/README.md"]
include_patterns += ["CONTRIBUTING.md", "lib/botschool/sandbox/README.md"]
# Links to files come along; those to folders are words, as there is nothing to show.
suppress_warnings = ["myst.xref_missing", "misc.highlighting_failure", "ref.python"]
myst_enable_extensions = ["dollarmath", "deflist"]
myst_heading_anchors = 4
html_theme = "furo"
html_title = "botschool"
html_show_sourcelink = False
html_copy_source = False
autodoc_typehints = "description"

LIVE = ("cartpole", "acrobot", "discrim", "planarhopper")
"""Experiments that are pages in the book, where the core for pages is built."""


def add_live_pages(app, exception):
    """Write a page for each of LIVE beside the book's own, or say why there is none."""
    from pathlib import Path

    from botschool import config, page
    from botschool.errors import BotschoolError
    from botschool.render.watch import read_genotype

    if exception:
        return
    folder = Path(app.outdir) / "docs/book/live"
    folder.mkdir(exist_ok=True)
    for name in LIVE:
        robot = Path(app.srcdir, f"data/genotypes/{name}.npy")
        saved = read_genotype(robot) if robot.exists() else None
        experiment = config.load(Path(app.srcdir, f"data/experiments/{name}.ini"))
        try:
            page.write_page(
                folder / f"{name}.html", experiment, 1, saved, robot.stem if robot.exists() else ""
            )
        except BotschoolError as error:
            (folder / f"{name}.html").write_text(f"<!DOCTYPE html><title>{name}</title><p>{error}")


def unlink_folders(app, doctree, name):
    """Make links to folders plain words."""
    from docutils import nodes

    for link in list(doctree.findall(nodes.reference)):
        if link.get("refuri", "").startswith("#.") or link.get("refid", "").startswith("."):
            link.replace_self(link.children)


def setup(app):
    """Called by Sphinx."""
    app.connect("doctree-resolved", unlink_folders)
    app.connect("build-finished", add_live_pages)
