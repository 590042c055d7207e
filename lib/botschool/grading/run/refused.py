"""Refuse libraries' answers to a task: hide their files, and replace what is in memory.

A task names what it refuses in one of three forms.

- "package.module": a module, or a package with all that it holds. A process for the task never
  imports it anew: a stand-in takes its place. Where it is loaded already, because another library
  needs it, all its functions are refused.
- "package.module:function", "package.module:Class.method" or "package.module:Class": a part of a
  module whose other parts are needed.
- "torch.ops.aten:operator": one of torch's operators, whatever name or language calls it.

The files of all these modules are closed to the process (hidden_files), so their text cannot run
under another name. Nothing of the submission runs before its process is prepared (refuse).
"""

from __future__ import annotations

import sys
from collections.abc import Iterable
from importlib.machinery import PathFinder
from pathlib import Path

from botschool.sandbox.paths import IMPORT_ROOT


def hidden_modules(refused: Iterable[str]) -> list[str]:
    """Return the modules and packages that are refused as a whole."""
    return [name for name in refused if ":" not in name]


def hidden_files(refused: Iterable[str]) -> list[Path]:
    """Return the files and folders of the refused modules, with Python's copies of them."""
    found: list[Path] = []
    for name in {name.partition(":")[0] for name in refused}:
        for place in _places(name):
            found.append(place)
            if place.suffix == ".py":
                found += place.parent.glob(f"__pycache__/{place.stem}.*")
    return found


def _places(name: str) -> list[Path]:
    """Return where a module's text lies: its file, or its package's folders.

    No package is imported to find that out.
    """
    search: list[str] | None = [str(IMPORT_ROOT), *filter(None, sys.path)]
    parts = name.split(".")
    for at in range(1, len(parts) + 1):
        spec = PathFinder.find_spec(".".join(parts[:at]), search)
        if spec is None:
            return []
        search = [*spec.submodule_search_locations] if spec.submodule_search_locations else None
        if search is None:
            is_text = at == len(parts) and str(spec.origin).endswith(".py")
            return [Path(str(spec.origin)).resolve()] if is_text else []
    return [Path(folder).resolve() for folder in search or []]


def refuse(names, opened=None):
    """Prepare this process for a task that refuses these names, before the submission is loaded.

    opened: the only modules of botschool that exist; None for all.

    Return a function to call once it is loaded: until then, what a file computes with a stand-in
    on the side is a stand-in, too, and afterwards it is an error. The function is sent to the
    process as source, so it does its own imports.
    """
    import contextlib
    import gc
    import importlib
    import importlib.abc
    import importlib.machinery
    import sys
    import types

    loaded, codes = [], {}

    def sentence(name):
        return f"write it yourself: {name} is not to be used here"

    class Kind(type):
        """The type of stand-ins; a stand-in is a class, so that classes can build on it."""

        def __getattr__(cls, name):
            if name.startswith("__") and name.endswith("__"):
                raise AttributeError(name)
            return stand_in(f"{cls.__module__}.{name}" if cls.__module__ else name)

        def __call__(cls, *arguments, **options):
            if loaded:
                raise RuntimeError(sentence(cls.__module__))
            if len(arguments) == 1 and not options and callable(arguments[0]):
                return arguments[0]  # as a decorator does
            return stand_in(cls.__module__)

        def __enter__(cls):
            return cls

        def __exit__(cls, *error):
            return None

    def stand_in(name):
        return Kind(name.rpartition(".")[2], (), {"__module__": name})

    class StandIn(types.ModuleType):
        def __getattr__(self, name):
            if name.startswith("__") and name != "__version__":
                raise AttributeError(name)
            return stand_in(f"{self.__name__}.{name}")

    class Finder(importlib.abc.MetaPathFinder, importlib.abc.Loader):
        def find_spec(self, name, path=None, target=None):
            if not is_hidden(name) and not is_closed(name):
                return None
            return importlib.machinery.ModuleSpec(name, self, is_package=True)

        def create_module(self, spec):
            return StandIn(spec.name)

        def exec_module(self, module):
            pass

    def is_hidden(name):
        return any(name == each or name.startswith(f"{each}.") for each in hidden)

    def is_closed(name):
        if name.startswith("botschool.sandbox.") or opened is None:
            return False
        return name.startswith("botschool.") and name not in opened

    def code_for(function, name):
        """Return code that raises, with as many free names as the function's own code."""
        many = len(function.__code__.co_freevars)
        if many not in codes:
            free = [f"free_{i}" for i in range(many)]
            lines = ["def make():", *(f"    {each} = None" for each in free)]
            lines += ["    def refused(*arguments, **options):"]
            lines += ["        raise RuntimeError('SENTENCE')"]
            lines += [f"        {each}" for each in free]
            made = {}
            exec("\n".join([*lines, "    return refused"]), made)
            codes[many] = made["make"]().__code__
        code = codes[many]
        said = (sentence(name) if each == "SENTENCE" else each for each in code.co_consts)
        return code.replace(co_consts=tuple(said))

    def close(function, name):
        """Give a function written in Python other code: all who hold it call that."""
        function.__defaults__ = function.__kwdefaults__ = None
        function.__code__ = code_for(function, name)

    def raising(name):
        def refused(*arguments, **options):
            raise RuntimeError(sentence(name))

        return refused

    def close_part(owner, last, name):
        """Refuse a function, or all functions of a class."""
        part = vars(owner).get(last)
        if isinstance(part, (staticmethod, classmethod)):
            part = part.__func__
        if isinstance(part, type):
            for each, value in list(vars(part).items()):
                if callable(value) and each not in ("__new__", "__class__", "__doc__"):
                    close_part(part, each, name)
            return
        while hasattr(part, "__wrapped__"):
            part = part.__wrapped__
        if isinstance(part, types.FunctionType):
            close(part, name)
        elif part is not None:
            with contextlib.suppress(TypeError):  # a type in C cannot change
                setattr(owner, last, raising(name))
            for module in list(sys.modules.values()):  # another one may have its name, too
                if getattr(module, "__dict__", {}).get(last) is part:
                    setattr(module, last, raising(name))

    def close_loaded():
        """Refuse every function of hidden modules that are loaded, wherever it is kept."""
        files = {
            module.__file__
            for name, module in list(sys.modules.items())
            if is_hidden(name) and getattr(module, "__file__", None)
        }
        if files:
            gc.unfreeze()  # the server froze what it imported, and frozen objects are not listed
        for each in gc.get_objects() if files else ():
            if type(each) is types.FunctionType and each.__code__.co_filename in files:
                close(each, f"{each.__module__}.{each.__qualname__}")
        gc.freeze()

    def close_operators(operators):
        """Refuse torch's operators on the processor, for good."""
        import ctypes
        import warnings

        import torch

        library = torch._C._dispatch_library("IMPL", "aten", "", __name__, 1)
        with warnings.catch_warnings():
            warnings.simplefilter("ignore")  # that they had another meaning
            for each in operators:
                for key in ("CPU", "SparseCPU", "CompositeImplicitAutograd"):
                    library.impl(each, key, raising(f"torch's {each}"))
        # whoever could end the library would get the operators back: nobody holds it now
        ctypes.pythonapi.Py_IncRef(ctypes.py_object(library))

    hidden = [name for name in names if ":" not in name]
    close_loaded()
    sys.meta_path.insert(0, Finder())
    operators = []
    for name in names:
        place, _, attribute = name.partition(":")
        if place == "torch.ops.aten":
            operators.append(attribute)
        elif attribute:
            *owners, last = attribute.split(".")
            with contextlib.suppress(ImportError, AttributeError):  # it is not installed here
                owner = importlib.import_module(place)
                for each in owners:
                    owner = getattr(owner, each)
                close_part(owner, last, f"{place}.{attribute}")
    if operators:
        close_operators(operators)
    return lambda: loaded.append(True)
