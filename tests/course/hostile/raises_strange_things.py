"""Exceptions that raise when they are looked at, or that pose as others."""


class Strange(BaseException):
    def __str__(self):
        raise KeyboardInterrupt

    __repr__ = __getattribute__ = __str__


def hostile(*arguments, **options):
    Strange.__name__ = "NotDone" * 1000
    raise Strange
