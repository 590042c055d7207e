"""No points without the work: hostile/tasks has ways to answers that a library or the grader knows.

Each is handed in with the skeleton, and graded in the tasks that it names.
"""

import pytest

import building
from botschool.grading.declare.state import VARIABLE
from botschool.grading.judge.points import grade_task
from botschool.grading.run.confined import fork_server
from botschool.grading.run.ours import ours_of

pytestmark = pytest.mark.course

CASES = building.unearned()

NEAR = {
    "13.4": """
import torch


def entropy_of_choices(scores):
    from scipy.special import softmax

    logarithms = torch.log_softmax(torch.as_tensor(scores), 1)
    return -(softmax(scores, axis=1) * logarithms.numpy()).sum(1)


def entropy_of_gaussians(log_deviation):
    return float(np.sum(0.5 + 0.5 * np.log(2 * np.pi) + np.asarray(log_deviation)))
""",
    "11.2": """
import matplotlib.pyplot
import torch.nn.functional as F
from torch.optim import Adam
from torch.utils.data import DataLoader, TensorDataset

torch.manual_seed(0)
device = torch.device("cpu")


class Data(torch.utils.data.Dataset):
    pass


@torch.no_grad()
def as_array(values: torch.Tensor | None) -> torch.Tensor:
    return values.numpy() if isinstance(values, torch.Tensor) else values


with torch.no_grad():
    pass


def gradient_by_hand(inputs, targets, w1, b1, w2, b2):
    from scipy.special import expit

    hidden = expit(as_array(inputs) @ w1.T + b1)
    error = hidden @ w2.T + b2 - targets
    d2 = 2 * error / error.size
    d1 = d2 @ w2 * hidden * (1 - hidden)
    found = {"w1": d1.T @ inputs, "b1": d1.sum(0), "w2": d2.T @ hidden, "b2": d2.sum(0)}
    return {"loss": np.mean(error**2)} | found
""",
    "12.5": """
from torch.distributions import Categorical, Normal


def cross_entropy(scores, actions):
    chosen = scores.gather(1, actions[:, None])[:, 0]
    return (torch.logsumexp(scores, 1) - chosen).mean()
""",
}
"""Right answers that use what stands beside the refused parts."""


@pytest.fixture(scope="module")
def graded(tmp_path_factory):
    """Grades code in a task; the processes of the last exercise are kept."""
    kept = {}

    def grade(task, code):
        number = int(task.partition(".")[0])
        if number not in kept:
            close()
            exercise = building.exercise(number)
            server = fork_server(exercise.imports)
            exercise.ours = ours_of(exercise, server)
            kept[number] = exercise, server
        exercise, server = kept[number]
        text = building.inserted(building.source(number).skeleton, code)
        file = building.write(tmp_path_factory.mktemp("unearned"), number, text)
        return grade_task(exercise.find(task), file, server)

    def close():
        while kept:
            exercise, server = kept.popitem()[1]
            exercise.ours.close()
            server.close()

    with pytest.MonkeyPatch.context() as patch:
        patch.setenv(VARIABLE, "another secret of ours")
        yield grade
    close()


@pytest.mark.parametrize("task, name, code", CASES, ids=lambda each: str(each)[:40].split("\n")[0])
def test_earns_nothing(graded, task, name, code):
    result = graded(task, code)
    if result.missing:
        pytest.skip(f"this system cannot confine a submission's {', '.join(result.missing)}")
    assert result.points == 0, result
    assert "LEAKED" not in result.message + result.printed


@pytest.mark.parametrize("task", NEAR)
def test_what_stands_beside_it_is_allowed(graded, task):
    result = graded(task, NEAR[task])
    assert result.points == result.max_points, result
