"""When answers are alike."""

import numpy as np
import pytest

from botschool.grading.declare.alike import Call


@pytest.mark.parametrize("answer", [np.arange(3), [1, 2], {"a": np.arange(2)}, None])
def test_no_answer_proves_an_exception(answer):
    call = Call(b"", ours=1.0, got={"raised": "ValueError", "text": "no"})
    assert call.proof(answer) == 0.0
