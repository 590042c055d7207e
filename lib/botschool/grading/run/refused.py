"""Functions of libraries that a task refuses, since they are what students are to write."""

from __future__ import annotations


def refuse(module, names):
    """In the child: a function of this name raises a sentence, from wherever it was imported.

    names: as "package.module:function" or "package.module:Class.method". Those of modules that are
    not imported yet follow as soon as they are, and each time that the file of such a module is
    executed: by an import, by one after sys.modules was emptied, or by a loader that the submission
    makes itself. Functions keep their identity and get other code, so that a name bound before is
    refused, too; one that is not written in Python has no code, so another takes its place there
    and among the names of the submission. Sent to the child as source (Student.run), so it imports
    what it needs itself.
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
        """Put another function in the place of one that is not written in Python."""

        def refused(*arguments, **options):
            raise RuntimeError(sentence)

        with contextlib.suppress(TypeError, AttributeError):  # a type that is not either
            setattr(owner, last, refused)
        for name, value in list(vars(module).items()):
            if value is function:
                setattr(module, name, refused)

    def file_of(name):
        """The file of a module, found without importing what it is in; None if there is none."""
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
