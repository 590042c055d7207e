"""An object that equals, contains and is everything."""


class Everything(float):
    __array_priority__ = 1e9

    def _yes(self, *arguments, **options):
        return True

    __eq__ = __ge__ = __le__ = __gt__ = __lt__ = __contains__ = __bool__ = _yes
    __hash__ = None

    def _me(self, *arguments, **options):
        return self

    __getattr__ = __getitem__ = __call__ = __abs__ = __sub__ = __rsub__ = __neg__ = _me

    def __len__(self):
        return 1

    def __iter__(self):
        return iter([self] * 3)


def hostile(*arguments, **options):
    return Everything()
