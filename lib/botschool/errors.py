"""The one exception that users see."""


class BotschoolError(Exception):
    """Something the user can mend: one sentence that says what, where and what to do.

    The command prints the sentence and exits with code 2; it never shows a traceback.
    """
