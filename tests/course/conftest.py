"""Many submissions are graded one after another here: the fork server is kept between them."""

import contextlib

import pytest

from botschool.grading.judge import submission
from botschool.grading.run.confined import fork_server


def pytest_addoption(parser):
    parser.addoption("--secrets", type=int, default=0, help="grade cases under so many secrets")


def pytest_ignore_collect(collection_path, config):
    asked = config.getoption("secrets", 0)
    return True if collection_path.name == "test_secrets.py" and not asked else None


@pytest.fixture
def secrets(request):
    """The secrets that --secrets asks for."""
    many = request.config.getoption("secrets")
    return [f"secret {number}" for number in range(1, many + 1)]


@pytest.fixture(scope="session")
def grade():
    """Grades a file as submission.grade does; the last fork server is kept for the same imports."""
    with contextlib.ExitStack() as stack:
        kept = {}

        def call(exercise, file, tasks=None):
            if exercise.imports not in kept:
                kept.clear()
                stack.pop_all().close()
                kept[exercise.imports] = stack.enter_context(fork_server(exercise.imports))
            return submission.grade(exercise, file, tasks=tasks, server=kept[exercise.imports])

        yield call
