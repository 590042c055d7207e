"""Define the exceptions of this package; their messages are sentences."""


class SandboxError(Exception):
    """This machine cannot run confined processes; the untrusted code is not at fault."""


class Refused(Exception):
    """The sandbox copies no files that are too many, too large, links, or unreadable."""


class CannotRead(Refused):
    """The caller may not read the files, or cannot read them now."""
