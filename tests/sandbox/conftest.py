"""Untrusted files in confined children, without anything of grading."""

import contextlib

import pytest

from botschool.sandbox import Allowance, Child, ForkServer, Limits, Scratch, paths

SECONDS = 20


class Sandboxed:
    """A file's text in a child of its own."""

    def __init__(self, server, folder, text, seconds):
        self.file = folder / "untrusted.py"
        self.file.parent.mkdir(parents=True)
        self.file.write_text(text)
        self.scratch = Scratch(self.file)
        readable = paths.without([*paths.interpreter_paths(), *paths.system_paths()], [folder])
        self.child = Child(server, self.scratch, self.file.name, Limits(seconds), readable)

    def ask(self, name, *arguments, seconds=SECONDS):
        """The answer to a call: {"value"} or {"error", "text", "line"}; None when it has ended."""
        return self.child.ask(
            {"name": name, "arguments": arguments, "options": {}}, Allowance(seconds)
        )

    def close(self):
        self.child.kill()
        self.scratch.remove()


@pytest.fixture(scope="session")
def server():
    with ForkServer() as one:
        yield one


@pytest.fixture
def sandboxed(server, tmp_path):
    """Gives a function that runs a text in a child."""
    with contextlib.ExitStack() as stack:
        made = []

        def make(text, seconds=SECONDS):
            made.append(Sandboxed(server, tmp_path / f"untrusted{len(made)}", text, seconds))
            stack.callback(made[-1].close)
            return made[-1]

        yield make


@pytest.fixture
def confined(sandboxed):
    """The same, skipped on a system that cannot confine."""

    def make(text, seconds=SECONDS):
        one = sandboxed(text, seconds)
        if one.child.missing:
            pytest.skip(f"this system cannot confine {', '.join(one.child.missing)}")
        return one

    return make
