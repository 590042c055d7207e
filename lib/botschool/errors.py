"""The one exception that users see, and what others say."""

MOST = 300
"""Letters of what a foreign exception says that are shown."""


class BotschoolError(Exception):
    """Something the user can mend: one sentence that says what, where and what to do.

    The command prints the sentence and exits with code 2; it never shows a traceback. The sentence
    is one line, even if it names a file whose name has line breaks.
    """

    def __str__(self) -> str:
        """Return the sentence."""
        return super().__str__().replace("\r", " ").replace("\n", " ")


def listed(words: list[str]) -> str:
    """Return "a, b and c"."""
    return " and ".join(filter(None, [", ".join(words[:-1]), words[-1]])) if words else ""


def said(error: BaseException) -> str:
    """What an exception says, on one line without a full stop; its type if it says nothing."""
    text = " ".join(str(error).split()).rstrip(".") or type(error).__name__
    return text if len(text) <= MOST else f"{text[:MOST]}..."
