"""A file of which a part fails, or is not Python: only what uses that part loses points."""

import sys

import pytest

from botschool.grading.judge.submission import Submission
from botschool.grading.run.cells import definitions
from botschool.sandbox.parts import LEFT_OUT, run_parts
from tiny_course import FILE, submit

USED = "def double(x):\n    return 2 * x\n\n\n"
FAILING = {
    "a decorator of a library that is missing": "import numbba as nb\n@nb.njit\ndef fast(x): pass",
    "a profiler's decorator": "@profile\ndef fast(x): pass",
    "a base class that is missing": "class fast(tf.keras.Model): pass",
    "a default argument": "def fast(x, size=SIZE): pass",
    "an annotation": "class fast:\n    pass\ndef slow(x: Tensor) -> Tensor: pass",
    "a decorator that raises": "def exits(f):\n    raise SystemExit(3)\n@exits\ndef fast(x): pass",
    "a class that computes": "class fast:\n    rate = 1 / 0",
    "a wrapped function": "def slow(x): pass\nfast = jit(slow)\ndef user(x): return fast(x)",
}


@pytest.mark.parametrize("kind", FAILING)
@pytest.mark.parametrize("first", [True, False])
def test_a_definition_that_fails_costs_nothing_else(kind, first):
    text = FAILING[kind] + "\n\n" + USED if first else USED + FAILING[kind] + "\n"
    script, names = definitions([text]), {}
    run_parts(script.text, "here.py", names)
    assert not script.left_out and names["double"](4) == 8
    left_out = {name: (line, said) for name, line, said in names[LEFT_OUT]}
    assert ("fast" in left_out) is ("fast" not in names) is (kind != "an annotation")
    if kind == "a decorator of a library that is missing":  # as its import has failed
        assert left_out["fast"][1] == "ModuleNotFoundError: No module named 'numbba'"
    if kind == "a profiler's decorator":
        at = text.split("\n").index("@profile") + 1
        assert left_out["fast"] == (at, "NameError: name 'profile' is not defined")


def test_a_definition_that_fails_takes_the_name_from_one_above_and_a_value_does_not():
    names = {}
    run_parts("def f(): pass\nA = 1\n@profile\ndef f(): pass\nA = 1 / 0\n", "here.py", names)
    assert names["A"] == 1 and [name for name, *_ in names[LEFT_OUT]] == ["f"]


@pytest.mark.slow
@pytest.mark.parametrize("cells", [False, True])
def test_the_user_of_what_is_left_out_fails_with_its_line(server, tmp_path, tiny, cells):
    text = f"@profile\ndef two(): return 2\n\n\ndef double(x):\n    return two() * x\n\n\n{TOTAL}"
    file = submit(tmp_path, text)
    with Submission(file, server, [text] if cells else None, FILE, exercise=tiny) as submission:
        double, total = map(submission.grade, tiny.tasks)
    assert (double.points, total.points) == (0, total.max_points)
    assert submission.banner.endswith("Left out: two.")
    place = "line 1 of the cell '@profile'" if cells else f"{FILE}:1"
    assert f"two cannot be read: {place} raised NameError: name 'profile'" in double.message


TOTAL = "def total(x):\n    return float(sum(x))\n"


@pytest.fixture
def tiny(tmp_path, monkeypatch):
    from botschool.grading.declare.exercise import load_exercise
    from tiny_course import make_course

    root = make_course(tmp_path / "course")
    monkeypatch.setenv("BOTSCHOOL_COURSE", str(root))
    return load_exercise(3, root)


# --- what is not Python, by its cause

OURS, BASE, THEIRS, END = "<<<<<<< HEAD\n", "||||||| 12ab\n", "=======\n", ">>>>>>> main\n"
MARKED = {
    "two versions of a line": f"{OURS}    x = 1\n{THEIRS}    x = 2\n{END}    return x\n",
    "three versions": f"{OURS}    x = 1\n{BASE}    x = 0\n{THEIRS}    x = 2\n{END}    return x\n",
    "a line or none": f"{OURS}{THEIRS}    x = 2\n{END}    return x\n",
    "the end of a function": f"{OURS}    return 1\n{THEIRS}    return 2\n{END}",
}


@pytest.mark.parametrize("kind", MARKED)
def test_marks_of_git_are_named_and_cost_the_function_around_them(kind):
    text = f"{USED}def half(x):\n    x = 0\n{MARKED[kind]}\n\n{TOTAL}"
    script, names = definitions([text]), {}
    ((_, line, _, why, lost),) = script.left_out
    assert line in (7, 9) and lost == ["half"] and why.startswith("git left conflict markers")
    run_parts(script.text, "here.py", names)
    assert names["total"]([1, 2]) == 3 and names["double"](1) == 2 and "half" not in names


def test_marks_of_git_around_a_function_do_not_cost_the_one_above():
    text = f"{USED}{OURS}def half(x):\n    return x / 2\n{THEIRS}{END}{TOTAL}"
    script, names = definitions([text]), {}
    run_parts(script.text, "here.py", names)
    assert {"double", "total"} <= {*names}
    assert script.left_out[0][3].startswith("git left conflict markers")


NEWER = {
    "3.12": [
        "def f[T](x: T) -> T:\n    return x\n",
        "class Pair[A, B]:\n    pass\n",
        "type Row = list[float]\n",
        'def f(x):\n    print(f"{x["a"]}")\n',
        "def f(x):\n    print(f'{'; '.join(x)}')\n",
        "def f(x):\n    return f\"{'\\n'.join(x)}\"\n",
    ],
    "3.14": [
        "def f(x):\n    try:\n        pass\n    except ValueError, TypeError:\n        pass\n",
        "def f(x):\n    try:\n        pass\n    except* np.A, np.B:\n        pass\n",
        "def f(x):\n    return t'{x}'\n",
    ],
}


@pytest.mark.parametrize("version, text", [(v, text) for v in NEWER for text in NEWER[v]])
def test_a_line_of_a_newer_python_is_told_as_that(version, text):
    script, this = definitions([text]), ".".join(map(str, sys.version_info[:2]))
    wanted = [f"it needs Python {version}; this is {this}"]
    newer = tuple(map(int, version.split("."))) > sys.version_info[:2]
    assert [why for _, _, _, why, _ in script.left_out] == wanted * newer


OLD_FAULTS = ("def f(x) return x\n", 'print(f"{x y}")\n', "def f(x):\n  if x = 1:\n    pass\n",
              "except ValueError, e:\n    pass\n", "def f(x]:\n    pass\n")  # fmt: skip


@pytest.mark.parametrize("text", OLD_FAULTS)
def test_a_fault_in_every_python_is_told_by_what_python_says(text):
    ((_, _, _, why, _),) = definitions([text]).left_out
    assert "Error: " in why


# --- a file that a notebook runs


@pytest.mark.slow
@pytest.mark.parametrize("line", ["%run helpers.py", "%run helpers", "%run -i ./helpers.py"])
def test_a_notebook_runs_a_file_beside_it(server, tmp_path, tiny, line):
    file = submit(tmp_path, "")
    (file.parent / "helpers.py").write_text(USED)
    with Submission(file, server, [line, TOTAL], FILE, exercise=tiny) as submission:
        assert [submission.grade(task).points for task in tiny.tasks] == [60, 40]


@pytest.mark.slow
def test_a_run_that_cannot_be_followed_is_named(server, tmp_path, tiny):
    file = submit(tmp_path, "")
    with Submission(file, server, ["%run helpers.ipynb", TOTAL], FILE, exercise=tiny) as submission:
        said = submission.grade(tiny.tasks[0]).message
    assert "%run helpers.ipynb" in said and "This line is left out" in said


@pytest.mark.slow
def test_a_function_that_is_defined_twice_is_named(server, tmp_path, tiny):
    twice = "def double(x):\n    raise NotImplementedError\n"
    file = submit(tmp_path, f"{USED}{twice}\n\n{TOTAL}")
    with Submission(file, server, None, FILE, exercise=tiny) as submission:
        result = submission.grade(tiny.tasks[0]).complete()
    assert result.message.endswith(
        f"double is defined more than once: {FILE}:5 counts, not {FILE}:1."
    )


@pytest.mark.slow
def test_what_is_printed_names_the_students_own_lines(server, tmp_path, tiny):
    text = (
        f"import warnings\n\n\ndef double(x):\n    warnings.warn('overflow')\n    return 0\n{TOTAL}"
    )
    file = submit(tmp_path, text)
    with Submission(file, server, [text], FILE, exercise=tiny) as submission:
        printed = submission.grade(tiny.tasks[0]).printed
    assert "line 5 of the cell 'import warnings': UserWarning: overflow" in printed
    assert "/scratch/" not in printed and str(file.parent) not in printed
