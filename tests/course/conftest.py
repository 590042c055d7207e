"""Many submissions are graded one after another here: the fork server is kept between them."""

import contextlib
import importlib
import warnings

import pytest

import building
from botschool.grading.judge import submission
from botschool.grading.judge.points import TaskResult
from botschool.grading.run.confined import fork_server
from botschool.grading.run.ours import ours_of
from direct import DirectOurs


def pytest_addoption(parser):
    parser.addoption("--secrets", type=int, default=0, help="grade cases under so many secrets")


def pytest_ignore_collect(collection_path, config):
    asked = config.getoption("secrets", 0)
    return True if collection_path.name == "test_secrets.py" and not asked else None


@pytest.fixture
def secrets(request):
    """The secrets that --secrets asks for."""
    many = request.config.getoption("secrets")
    return [f"secret of number {number:04}" for number in range(1, many + 1)]


@pytest.fixture(scope="session")
def here():
    """Loads an exercise whose answers are ours in this process; the last one is kept."""
    with contextlib.ExitStack() as stack:
        kept = {}

        def load(number):
            if number not in kept:
                kept.clear()
                stack.pop_all().close()
                exercise = kept[number] = building.exercise(number)
                for name in exercise.imports:  # an alarm must not cut an import short
                    importlib.import_module(name)
                exercise.ours = stack.enter_context(DirectOurs(exercise.known.solution))
            return kept[number]

        yield load


@pytest.fixture
def elsewhere(monkeypatch, tmp_path):
    """Let drivers write their files in a folder of their own."""
    monkeypatch.setenv("BOTSCHOOL_COURSE", str(building.ROOT))
    monkeypatch.chdir(tmp_path)
    with warnings.catch_warnings():
        warnings.simplefilter("ignore")
        yield


@pytest.fixture(scope="session")
def grade():
    """Grades a file as submission.grade does, and keeps the last fork server and our answers.

    Tasks that are not asked for count as passed, where others build on them.
    """
    with contextlib.ExitStack() as stack:
        servers, ours = {}, {}

        def kept(exercise, server):
            if exercise.number not in ours:
                own = ours[exercise.number] = ours_of(exercise, server)
                stack.callback(own.close)
                own.close = lambda: None  # a submission that ends leaves it to the next one
            return ours[exercise.number]

        def call(exercise, file, tasks=None):
            if exercise.imports not in servers:
                servers.clear()
                ours.clear()
                stack.pop_all().close()
                servers[exercise.imports] = stack.enter_context(fork_server(exercise.imports))
            tasks = exercise.tasks if tasks is None else tasks
            opened = submission.opened(exercise, file, servers[exercise.imports])
            with pytest.MonkeyPatch.context() as patch:
                patch.setattr(submission, "ours_of", kept)
                with opened as one:
                    for task in exercise.tasks:
                        if task not in tasks:
                            points = task.max_points
                            passed = TaskResult(task.id, task.title, points, points, "")
                            one._results[task.id] = passed
                    results = [one.grade(task).complete() for task in tasks]
            return submission.Result(exercise.number, exercise.title, results, one.banner)

        yield call
