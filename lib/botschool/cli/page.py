"""Define `botschool page`, which writes a page that evolves robots in the browser."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

app = typer.Typer()


@app.command(epilog="Example: botschool page data/experiments/acrobot.ini -o acrobot.html")
def page(
    file: Annotated[Path, typer.Argument(help="Experiment file (.ini).", metavar="FILE.ini")],
    genotype: Annotated[
        Path | None,
        typer.Option("-g", "--genotype", help="Begin with this saved robot.", metavar="FILE"),
    ] = None,
    seed: Annotated[int, typer.Option("-s", "--seed", min=0, max=2**53 - 1, help="Seed.")] = 1,
    output: Annotated[
        Path, typer.Option("-o", "--output", help="Page to write (.html).", metavar="FILE")
    ] = Path("page.html"),
) -> None:
    """Write a page that evolves robots in any browser and takes them apart.

    The page is one file: open it from a folder, a USB stick or a website.
    """
    from botschool.config import load
    from botschool.page import write_page
    from botschool.render.watch import read_genotype

    experiment = load(file)
    saved = None if genotype is None else read_genotype(genotype)
    write_page(output, experiment, seed, saved, genotype.name if genotype else "")
    print(f"Wrote {output} ({output.stat().st_size / 1000:.0f} KB): open it in a browser.")
