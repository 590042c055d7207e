"""Define the one exception that users see, and quote the messages of others."""

MOST = 300
"""Characters to show of another exception's message."""


class BotschoolError(Exception):
    """An error that the user can mend: one sentence that says what, where and what to do.

    The command prints the sentence and exits with code 2, without a traceback. The sentence takes
    one line, even if it names a file whose name has line breaks.
    """

    def __str__(self) -> str:
        """Return the sentence."""
        return super().__str__().replace("\r", " ").replace("\n", " ")


class BotschoolErrors(BotschoolError):
    """Several errors at once: a sentence in each line."""

    def __init__(self, sentences: list[str]) -> None:
        """Store the sentences, at least one."""
        super().__init__(*sentences)

    def __str__(self) -> str:
        """Return the sentences."""
        return "\n".join(str(BotschoolError(each)) for each in self.args)


def listed(words: list[str]) -> str:
    """Return "a, b and c"."""
    return " and ".join(filter(None, [", ".join(words[:-1]), words[-1]])) if words else ""


def said(error: BaseException) -> str:
    """Return an exception's message on one line without a full stop; without a message its type."""
    text = " ".join(str(error).split()).rstrip(".") or type(error).__name__
    return text if len(text) <= MOST else f"{text[:MOST]}..."
