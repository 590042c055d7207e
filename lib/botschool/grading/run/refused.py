"""Functions of libraries that a task refuses, since they are what students are to write."""

from __future__ import annotations


def refuse(module, names):
    """In the child: a function of this name raises a sentence, from wherever it was imported.

    names: as "package.module:function" or "package.module:Class.method", of functions written in
    Python. Those of modules that are not imported yet follow as soon as they are. Functions keep
    their identity and get other code, so that a name bound before is refused, too. Sent to the
    child as source (Student.run), so it imports what it needs itself.
    """
    import functools
    import importlib.util
    import sys

    def close(place, attributes):
        for path in attributes:
            *owners, last = path.split(".")
            owner = functools.reduce(lambda at, name: getattr(at, name, None), owners, place)
            function = getattr(owner, last, None)
            while hasattr(function, "__wrapped__"):
                function = function.__wrapped__
            if not hasattr(function, "__code__"):
                continue
            sentence = f"write it yourself: {place.__name__}.{path} is not to be used here"
            free = [f"free_{i}" for i in range(len(function.__code__.co_freevars))]
            names = {}
            lines = ["def make():", *(f"    {name} = None" for name in free)]
            lines += ["    def refused(*arguments, **options):"]
            lines += [f"        raise RuntimeError({sentence!r})"]
            lines += [f"        {name}" for name in free]
            exec("\n".join([*lines, "    return refused"]), names)
            function.__defaults__ = function.__kwdefaults__ = None
            function.__code__ = names["make"]().__code__

    class Finder:
        """Closes functions of modules that are imported later."""

        @staticmethod
        def find_spec(name, path=None, target=None):
            attributes = waiting.pop(name, None)
            spec = importlib.util.find_spec(name) if attributes else None
            if spec is None or spec.loader is None:
                return None
            execute = spec.loader.exec_module

            def exec_module(place):
                execute(place)
                close(place, attributes)

            spec.loader.exec_module = exec_module
            return spec

    waiting = {}
    for name in names:
        place, _, attribute = name.partition(":")
        waiting.setdefault(place, []).append(attribute)
    for place in [place for place in waiting if place in sys.modules]:
        close(sys.modules[place], waiting.pop(place))
    sys.meta_path.insert(0, Finder)
