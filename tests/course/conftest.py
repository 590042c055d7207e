"""Many submissions are graded one after another here: the fork server is kept between them."""

import contextlib

import pytest

from botschool.grading.judge import submission
from botschool.grading.run.confined import fork_server


@pytest.fixture(scope="session")
def grade():
    """Grades a file as submission.grade does; the last fork server is kept for the same imports."""
    with contextlib.ExitStack() as stack:
        kept = {}

        def call(exercise, file):
            if exercise.imports not in kept:
                kept.clear()
                stack.pop_all().close()
                kept[exercise.imports] = stack.enter_context(fork_server(exercise.imports))
            return submission.grade(exercise, file, server=kept[exercise.imports])

        yield call
