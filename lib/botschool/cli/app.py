"""Put the groups of subcommands together, and turn errors into sentences and exit codes.

Each module of this package holds a group of subcommands, one short function each. Functions import
heavy modules when they need them.
"""

from __future__ import annotations

import os
import re
import signal
import sys
from contextlib import suppress
from types import ModuleType
from typing import Annotated, Any, NoReturn

import typer

from botschool import __version__
from botschool.cli import course, es, examples, labs, page, plots, rl, tournament, tune
from botschool.errors import BotschoolError
from botschool.screen import guarded_terminal

UsageError: Any = typer.BadParameter.__base__

GROUPS = {
    es: None,
    tune: None,
    examples: None,
    plots: None,
    page: None,
    tournament: None,
    course: None,
    labs: None,
    rl: "rl",
}
"""Module with commands -> the word before its commands; in the order of --help."""

# numpy's BLAS would start threads that only wait: no command multiplies large matrices
os.environ.setdefault("OPENBLAS_NUM_THREADS", "1")


def commands(asked: str | None = None) -> typer.Typer:
    """Return the command with one subcommand, or with all of them if there is no such one.

    Making all subcommands takes longer than many runs do.
    """
    app = typer.Typer(
        help="Train robots in simulation by evolution and by reinforcement learning.",
        no_args_is_help=True,
        add_completion=False,
        rich_markup_mode="markdown",
        pretty_exceptions_enable=False,
    )
    app.callback()(_options)
    for module in [m for m in GROUPS if asked in _names(m)] or GROUPS:
        app.add_typer(module.app, name=GROUPS[module])
    return app


def _names(module: ModuleType) -> list[str]:
    """Return the words after `botschool` that select a module's commands."""
    if GROUPS[module]:
        return [GROUPS[module]]
    return [c.name or c.callback.__name__ for c in module.app.registered_commands]


def _tell_version(asked: bool) -> None:
    if asked:
        print(f"botschool {__version__}")
        raise typer.Exit


def _options(
    version: Annotated[
        bool,
        typer.Option("--version", help="Print it.", is_eager=True, callback=_tell_version),
    ] = False,
) -> None:
    """Define the options of `botschool` itself."""


def run() -> NoReturn:
    """Run the command and exit; an error that users can mend is one sentence and exit code 2."""
    code, stopped = 130, False
    _mend_surroundings()

    def stop(number: int, frame: object) -> None:
        nonlocal stopped
        stopped = True
        raise KeyboardInterrupt

    try:
        if signal.getsignal(signal.SIGINT) is not signal.SIG_IGN:
            signal.signal(signal.SIGINT, stop)
        with guarded_terminal():
            code = _run()
    except KeyboardInterrupt:
        pass
    finally:
        signal.signal(signal.SIGINT, signal.SIG_IGN)  # all work is done: another Ctrl-C is no error
    if stopped and code == 130:
        print("Stopped.", file=sys.stderr)
    sys.exit(code)


def _mend_surroundings() -> None:
    """Replace closed streams, and a terminal of no width, by what programs can write to."""
    for name, mode in (("stdin", "r"), ("stdout", "w"), ("stderr", "w")):
        if getattr(sys, name) is None:  # the next file to be opened would take its number
            setattr(sys, name, os.fdopen(os.open(os.devnull, os.O_RDWR), mode))
    for name in ("COLUMNS", "LINES"):
        if os.environ.get(name, "").strip("0 ") == "":
            os.environ.pop(name, None)


def _run() -> int:
    """Run the command; return the exit code."""
    with suppress(AttributeError):  # in a notebook
        screen: Any = sys.stdout
        screen.reconfigure(errors="backslashreplace")  # names that the terminal cannot show
    try:
        code = commands(*sys.argv[1:2])(standalone_mode=False) or 0
        sys.stdout.flush()
    except BotschoolError as error:
        code = _refuse(str(error))
    except UsageError as error:
        message = _once(" ".join(error.format_message().split()).rstrip("."))
        command = error.ctx.command_path.removeprefix("python -m ") if error.ctx else "botschool"
        see = " See" if message.endswith("?") else ": see"
        code = _refuse(f"{message}{see} {command} --help.") if message else 2
    except MemoryError:
        code = _refuse(
            "Not enough memory: lower samplesize, popsize, nhiddens or the number of workers (-w)."
        )
    except (KeyboardInterrupt, typer.Abort):
        code = 130
    except BrokenPipeError:
        code = _silence(1)
    except OSError as error:
        place = error.filename or "standard output"
        code = _refuse(
            f"Cannot read or write {place} ({error.strerror or error}): free some space or "
            "choose another place."
        )
        code = _silence(code)
    return code


def _once(message: str) -> str:
    """Return the message with one suggestion; Typer and Click each add one."""
    suggestion = r"\.? \(?Did you mean(?: one of:)? ([^?]*)\?.*"
    return re.sub(suggestion, r"; did you mean \1?", message)


def _refuse(sentence: str) -> int:
    print(f"error: {sentence}", file=sys.stderr)
    return 2


def _silence(code: int) -> int:
    """Discard what Python would still print to a broken standard output; return the code."""
    with suppress(OSError):
        sys.stdout.flush()
    os.dup2(os.open(os.devnull, os.O_WRONLY), sys.stdout.fileno())
    return code
