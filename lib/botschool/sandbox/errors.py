"""The exceptions of this package; their messages are sentences."""


class SandboxError(Exception):
    """A confined process cannot be had on this machine, which is no fault of the untrusted code."""


class Refused(Exception):
    """Files that are not copied into a sandbox: too many, too large, links, or unreadable."""


class CannotRead(Refused):
    """The caller may not read the files, or cannot at this time."""
