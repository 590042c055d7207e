"""Read options and make folders: the part of the walkthroughs that has nothing to
do with learning.
"""

from __future__ import annotations

import argparse
import sys
from dataclasses import fields
from pathlib import Path
from typing import Any, TypeVar

from botschool.errors import BotschoolError

Settings = TypeVar("Settings")


def read_hyperparameters(settings: type[Settings], text: str) -> Settings:
    """Return the dataclass `settings` with the options of the command line; --help shows `text`.

    Every field, made by botschool.config.hyper, becomes an option --name.
    """
    parser = argparse.ArgumentParser(
        description=text, formatter_class=argparse.RawDescriptionHelpFormatter
    )
    for field in fields(settings):
        kind = type(field.default)
        parser.add_argument(
            f"--{field.name}",
            default=field.default,
            type=kind,
            choices=field.metadata.get("choices"),
            metavar=kind.__name__.upper(),
            help=f"{_with_choices(field)} (default: {field.default})",
        )
    values = vars(parser.parse_args())
    for field in fields(settings):
        _check(parser, field, values[field.name])
    return settings(**values)


def _with_choices(field) -> str:
    choices = field.metadata.get("choices")
    more = f": {', '.join(map(str, choices))}" if choices else ""
    return field.metadata["help"].replace("%", "%%") + more


def _check(parser: argparse.ArgumentParser, field, value: Any) -> None:
    limits = field.metadata
    for key, allowed, words in (
        ("low", lambda limit: value >= limit, "at least"),
        ("high", lambda limit: value <= limit, "at most"),
        ("above", lambda limit: value > limit, "more than"),
    ):
        if key in limits and not allowed(limits[key]):
            parser.error(f"--{field.name} {value} must be {words} {limits[key]}.")


def new_folder(name: str) -> Path:
    """Make and return the folder results/walkthroughs/NAME_1, or one with the next free number."""
    for number in range(1, sys.maxsize):
        folder = Path("results", "walkthroughs", f"{name}_{number}")
        try:
            folder.mkdir(parents=True)
            return folder
        except FileExistsError:
            continue
        except OSError as error:
            raise BotschoolError(
                f"{folder} cannot be made ({error.strerror}): start in a folder that you may "
                "write to."
            ) from None
    raise AssertionError


def run(main) -> None:
    """Call main; an error that the user can correct is one sentence and exit code 2."""
    try:
        main()
    except BotschoolError as error:
        print(f"error: {error}", file=sys.stderr)
        sys.exit(2)
    except KeyboardInterrupt:
        sys.exit(130)
