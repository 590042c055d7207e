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
html_static_path = ["static"]
html_css_files = ["print.css"]
autodoc_typehints = "description"

LIVE = {
    "cartpole": "cartpole.npy",
    "acrobot": "acrobot.npy",
    "pendulum": "pendulum.npy",
    "discrim": "discrim.npy",
    "planarhopper": "planarhopper.npy",
    "predprey": "predprey/S12G300.npy",
}
"""Experiments that are pages in the book, and the robots that they begin with, if they exist."""

TRAINED = {"cartpole_ppo": "CartPole-v1"}
"""Trainings that are pages in the book."""

LIVING = {
    "ex01_episodes": ("cartpole", "evolve a controller for the cart and push the pole"),
    "ex02_network": ("cartpole", "see the neurons at work, blind a sensor, cut a neuron"),
    "ex04_robot": ("acrobot", "evolve the acrobot and push its elbow"),
    "ex06_sensors": ("discrim", "drag the cylinder, freeze the robot's memory"),
    "ex07_reading": ("pendulum", "evolve a controller, drag and push the pendulum"),
    "ex09_robots": ("planarhopper", "evolve the hopper, push it, cut its neurons"),
    "ex13_own_training": ("cartpole_ppo", "train the cart by PPO"),
    "ex15_robots": ("predprey", "watch predator and prey, and a row of the tournament"),
}
"""Pictures of something that moves: the page below each, and what it lets a reader do."""


def lead_to_page(app, name, source):
    """Make the pointer of an exercise's text to its page a link."""
    import re

    from botschool.page.exercise import POINTER

    if found := re.match(r"exercises/(ex\d\d)_", name):
        link = f'<a href="../../docs/book/live/{found[1]}.html">this text as a page</a>'
        text = f"**See and touch it:** {link} with figures that you can drag.\n\n"
        source[0] = POINTER.sub(text, source[0])


def write_page(path, write, *arguments):
    """Write a page of the book, or one that says why there is none."""
    from botschool.errors import BotschoolError

    try:
        write(*arguments)
    except BotschoolError as error:
        path.write_text(f"<!DOCTYPE html><title>{path.stem}</title><p>{error}")


def add_exercise_pages(app, exception):
    """Write the page of each exercise beside the book's own."""
    from functools import partial
    from pathlib import Path

    from botschool.page.exercise import has_page, write_exercise_page

    def there(target, folder):
        """Return the link of a page for one of a text: both lie three folders deep."""
        return f"../../../exercises/{folder.name}/{target}".replace(".md", ".html")

    for folder in sorted(Path(app.srcdir).glob("exercises/ex[0-9][0-9]_*")):
        if has_page(folder) and not exception:
            path = Path(app.outdir) / f"docs/book/live/{folder.name[:4]}.html"
            write_page(path, write_exercise_page, folder, path, partial(there, folder=folder))


def add_live_pages(app, exception):
    """Write the living pages beside the book's own, or say why there are none."""
    from pathlib import Path

    from botschool import config, page
    from botschool.page.training import write_training_page
    from botschool.render.watch import read_genotype

    if exception:
        return
    folder = Path(app.outdir) / "docs/book/live"
    folder.mkdir(exist_ok=True)
    for name in (*LIVE, *TRAINED):
        path = folder / f"{name}.html"
        if name in TRAINED:
            write_page(path, write_training_page, path, TRAINED[name])
            continue
        robot = Path(app.srcdir, "data/genotypes", LIVE[name])
        saved = read_genotype(robot) if robot.exists() else None
        experiment = config.load(Path(app.srcdir, f"data/experiments/{name}.ini"))
        begins = robot.stem if robot.exists() else ""
        write_page(path, page.write_page, path, experiment, 1, saved, begins)


def add_living_figures(app, doctree, name):
    """Put a living figure below each picture of something that moves; it opens on a click."""
    from pathlib import PurePosixPath

    from docutils import nodes

    for image in list(doctree.findall(nodes.image)):
        living, text = LIVING.get(PurePosixPath(image["uri"]).stem, ("", ""))
        if not living:
            continue
        up = "../" * name.count("/")
        html = (
            f"<details class='living'><summary>Try it here: {text}</summary>"
            f'<iframe src="{up}docs/book/live/{living}.html" title="{text}" loading="lazy" '
            f'width="100%" height="900"></iframe></details>'
        )
        place = image
        while not isinstance(place.parent, nodes.section):
            place = place.parent
        place.parent.insert(place.parent.index(place) + 1, nodes.raw("", html, format="html"))


def unlink_folders(app, doctree, name):
    """Make links to folders plain words."""
    from docutils import nodes

    for link in list(doctree.findall(nodes.reference)):
        if link.get("refuri", "").startswith("#.") or link.get("refid", "").startswith("."):
            link.replace_self(link.children)


def setup(app):
    """Called by Sphinx."""
    app.connect("doctree-resolved", unlink_folders)
    app.connect("doctree-resolved", add_living_figures)
    app.connect("source-read", lead_to_page)
    app.connect("build-finished", add_live_pages)
    app.connect("build-finished", add_exercise_pages)
