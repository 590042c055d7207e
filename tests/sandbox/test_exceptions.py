"""What a child tells of exceptions, and where it is when its time is up."""

import pytest

from botschool.sandbox import Allowance
from botschool.sandbox.exceptions import nearest


@pytest.mark.parametrize(
    ("name", "names", "found"),
    [
        ("rank", ["ranks", "tank"], "ranks"),
        ("next_population", ["NextPopulation", "next_popul"], "NextPopulation"),
        ("evolve", ["evolve_population", "x"], "evolve_population"),
        ("rank", ["train", "evolve"], None),
        ("rank", ["rank"], None),
        ("x" * 100, ["x" * 99], None),
    ],
)
def test_nearest(name, names, found):
    assert nearest(name, names) == found


def test_places(sandboxed):
    one = sandboxed("def f():\n    return g()\ndef g():\n    return [][1]\ndef h(a): pass\n")
    assert one.ask("f") == {
        "error": "IndexError", "text": "list index out of range", "file": "untrusted.py",
        "line": 4, "column": None, "near": None, "call": None,
    }  # fmt: skip
    assert one.ask("ff")["error"] == "Missing"
    told = one.ask("h")
    assert (told["error"], told["call"]) == ("Signature", "h(a)")


def test_where_it_is(sandboxed):
    one = sandboxed("def f():\n    while True:\n        g()\ndef g():\n    sum(range(10**4))\n")
    with pytest.raises(TimeoutError):
        one.ask("f", seconds=0.3)
    places = one.child.where()
    assert places[-1] == ("untrusted.py", 3) and set(places[:-1]) <= {("untrusted.py", 5)}
    one.child.kill()
    assert one.child.where() == []


def test_where_of_one_that_does_not_tell(sandboxed):
    text = "from signal import *\ndef f():\n    signal(SIGUSR1, SIG_IGN)\n    while True: pass\n"
    one = sandboxed(text)
    with pytest.raises(TimeoutError):
        one.ask("f", seconds=0.3)
    assert one.child.where() == []


def test_twice(sandboxed):
    one = sandboxed("n = 0\ndef f(x):\n    global n\n    n += 1\n    x.append(n)\n    return n\n")
    request = {"name": "f", "arguments": [[7]], "options": {}, "twice": True}
    assert one.child.ask(request, Allowance(5))["value"] == {
        "answers": [1, 2], "arguments": [[7, 1]],
    }  # fmt: skip
