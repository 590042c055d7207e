"""Refuse library functions that students must write themselves."""

from __future__ import annotations


def refuse(module, names):
    """Make functions of these names raise a sentence, from wherever they were imported.

    names: as "package.module:function" or "package.module:Class.method". Functions of a module that
    is imported later are refused at its import, and whenever its file is executed again: by an
    import, by one after sys.modules was emptied, or by a loader that the submission makes. A Python
    function keeps its identity and gets other code, so a name bound earlier is refused, too. A
    function that is not written in Python has no code: another one replaces it in its module and in
    the submission. The function runs in the child and is sent there as source (Student.run), so it
    does its own imports.
    """
    import contextlib
    import functools
    import sys
    from importlib.machinery import PathFinder, SourceFileLoader

    def close(place, attributes):
        for path in attributes:
            *owners, last = path.split(".")
            owner = functools.reduce(lambda at, name: getattr(at, name, None), owners, place)
            function = getattr(owner, last, None)
            while hasattr(function, "__wrapped__"):
                function = function.__wrapped__
            if function is None:
                continue
            sentence = f"write it yourself: {place.__name__}.{path} is not to be used here"
            if not hasattr(function, "__code__"):
                replace(owner, last, function, sentence)
                continue
            free = [f"free_{i}" for i in range(len(function.__code__.co_freevars))]
            names = {}
            lines = ["def make():", *(f"    {name} = None" for name in free)]
            lines += ["    def refused(*arguments, **options):"]
            lines += [f"        raise RuntimeError({sentence!r})"]
            lines += [f"        {name}" for name in free]
            exec("\n".join([*lines, "    return refused"]), names)
            function.__defaults__ = function.__kwdefaults__ = None
            function.__code__ = names["make"]().__code__

    def replace(owner, last, function, sentence):
        """Replace a function that is not written in Python."""

        def refused(*arguments, **options):
            raise RuntimeError(sentence)

        with contextlib.suppress(TypeError, AttributeError):  # a type in C cannot change
            setattr(owner, last, refused)
        for name, value in list(vars(module).items()):
            if value is function:
                setattr(module, name, refused)

    def file_of(name):
        """Return a module's file, without importing its package; None if there is none."""
        where = None
        for at in range(1, name.count(".") + 2):
            spec = PathFinder.find_spec(".".join(name.split(".")[:at]), where)
            if spec is None:
                return None
            where = spec.submodule_search_locations
        return spec.origin

    wanted, files = {}, {}
    for name in names:
        place, _, attribute = name.partition(":")
        wanted.setdefault(place, []).append(attribute)
    for place, attributes in wanted.items():
        files[file_of(place)] = attributes
        if place in sys.modules:
            close(sys.modules[place], attributes)
    files.pop(None, None)

    def exec_module(self, place):
        execute(self, place)
        if attributes := files.get(getattr(self, "path", None)):
            close(place, attributes)

    execute = SourceFileLoader.exec_module
    SourceFileLoader.exec_module = exec_module
