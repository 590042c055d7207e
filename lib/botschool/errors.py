"""Define the one exception that users see, and quote the messages of others."""

from dataclasses import dataclass

MOST = 300
"""Characters to show of another exception's message."""


@dataclass(frozen=True)
class Option:
    """A part of a sentence: an option of the command, and what a program writes in its place."""

    command: str
    python: str

    def __str__(self) -> str:
        """Return the command's option."""
        return self.command


RESUME, FORCE = Option("--resume", "resume=True"), Option("--force", "force=True")
SEED, FOLDER = Option(" (-s)", ""), Option(" (-o)", "")
ANEW = (", or use ", FORCE, " to start anew.")
"""The end of a sentence about a run that cannot go on."""


class BotschoolError(Exception):
    """An error that the user can mend: one sentence that says what, where and what to do.

    Its arguments are the parts of the sentence, texts and `Option`. The command prints the sentence
    and exits with code 2, without a traceback. The sentence takes one line, even if it names a file
    whose name has line breaks.
    """

    def __str__(self) -> str:
        """Return the sentence."""
        return _in_one_line("".join(map(str, self.args)))

    @property
    def in_python(self) -> str:
        """Return the sentence with what programs write."""
        parts = (part.python if isinstance(part, Option) else str(part) for part in self.args)
        return _in_one_line("".join(parts))


class BotschoolErrors(BotschoolError):
    """Several errors at once: a sentence in each line."""

    def __init__(self, sentences: list[str]) -> None:
        """Store the sentences, at least one."""
        super().__init__(*sentences)

    def __str__(self) -> str:
        """Return the sentences."""
        return "\n".join(str(BotschoolError(each)) for each in self.args)


def _in_one_line(text: str) -> str:
    return text.replace("\r", " ").replace("\n", " ")


def listed(words: list[str]) -> str:
    """Return "a, b and c"."""
    return " and ".join(filter(None, [", ".join(words[:-1]), words[-1]])) if words else ""


def said(error: BaseException) -> str:
    """Return an exception's message on one line without a full stop; without a message its type."""
    text = " ".join(str(error).split()).rstrip(".") or type(error).__name__
    return text if len(text) <= MOST else f"{text[:MOST]}..."
