"""Read the experiment file that a command names."""

from __future__ import annotations

import sys
from pathlib import Path
from typing import TYPE_CHECKING

from botschool.paths import own_file

if TYPE_CHECKING:
    from botschool.config import Experiment


def experiment_of(file: Path) -> Experiment:
    """Return the experiment of a file, the user's or botschool's own.

    Print on stderr what of the file means something else here. Raises BotschoolError.
    """
    from botschool.config import load

    experiment = load(own_file(file, "experiments"))
    for note in experiment.notes:
        print(f"note: {file}: {note}", file=sys.stderr)
    return experiment


def robots_lie_in(experiment: Path | None, folder: Path, genotype: Path | None) -> None:
    """Let robots of one's own lie beside the experiment file, and their tables beside the run."""
    from botschool.problems.finding import look_in

    look_in(*filter(None, [experiment and experiment.parent, folder, genotype and genotype.parent]))
