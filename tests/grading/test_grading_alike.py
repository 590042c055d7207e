"""When answers are alike, and which modules a submission may use."""

import numpy as np
import pytest

from botschool.grading.declare.alike import Call
from botschool.grading.declare.modules import CORE, closed_files, needed


@pytest.mark.parametrize("answer", [np.arange(3), [1, 2], {"a": np.arange(2)}, None])
def test_no_answer_proves_an_exception(answer):
    call = Call(b"", ours=1.0, got={"raised": "ValueError", "text": "no"})
    assert call.proof(answer) == 0.0


def test_the_compiled_module_is_there_for_what_needs_it():
    """In a checkout it does not lie beside the modules in Python."""
    assert "botschool._core" in needed(frozenset({"botschool.net"}))
    assert CORE not in closed_files(needed(frozenset({"botschool.net"})))
