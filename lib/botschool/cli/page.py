"""Define `botschool page`, which writes a page that evolves robots in the browser."""

from __future__ import annotations

from pathlib import Path
from typing import Annotated

import typer

app = typer.Typer()


@app.command(epilog="Example: botschool page data/experiments/acrobot.ini -o acrobot.html")
def page(
    file: Annotated[
        Path,
        typer.Argument(
            help="Experiment file (.ini); or the Gymnasium id of a native problem, such as "
            "CartPole-v1, to train on it by PPO.",
            metavar="FILE.ini|ID",
        ),
    ],
    genotype: Annotated[
        Path | None,
        typer.Option(
            "-g",
            "--genotype",
            help="Begin with this saved robot; for PPO a best_model.npz.",
            metavar="FILE",
        ),
    ] = None,
    seed: Annotated[int, typer.Option("-s", "--seed", min=0, max=2**53 - 1, help="Seed.")] = 1,
    output: Annotated[
        Path, typer.Option("-o", "--output", help="Page to write (.html).", metavar="FILE")
    ] = Path("page.html"),
) -> None:
    """Write a page that evolves robots in any browser and takes them apart.

    The page is one file: open it from a folder, a USB stick or a website.
    """
    from botschool.cli.experiments import experiment_of
    from botschool.page import write_page
    from botschool.page.training import write_training_page
    from botschool.paths import own_file
    from botschool.render.watch import read_genotype

    if file.suffix != ".ini" and not own_file(file, "experiments").is_file():
        write_training_page(output, str(file), seed, genotype)
    else:
        robot = None if genotype is None else own_file(genotype, "genotypes")
        saved = None if robot is None else read_genotype(robot)
        write_page(output, experiment_of(file), seed, saved, robot.name if robot else "")
    print(f"Wrote {output} ({output.stat().st_size / 1000:.0f} KB): open it in a browser.")
