"""What exercises import keeps its names; a new exercise is two folders and nothing else."""

import importlib
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

import tiny_course
from botschool.course import film_agent
from botschool.errors import BotschoolError
from botschool.grading.classes import batch
from botschool.grading.copies.skeleton import skeleton
from botschool.grading.declare.exercise import exercise_numbers, load_exercise, submission_file
from botschool.grading.declare.trust import trust
from botschool.moved import MOVED
from running import call, environment_of_command

ROOT = Path(__file__).parents[1]


@pytest.mark.parametrize("name", MOVED)
def test_modules_that_moved_keep_their_old_names(name):
    """Files that users wrote earlier import these."""
    old = importlib.import_module(f"botschool.{name}")
    new = importlib.import_module(f"botschool.{MOVED[name]}")
    public = {name for name in vars(new) if not name.startswith("_")}
    assert public and all(getattr(old, each) is getattr(new, each) for each in public)
    assert new.__spec__.name == f"botschool.{MOVED[name]}"


@pytest.mark.parametrize("number", exercise_numbers(ROOT))
def test_titles_of_texts_are_the_graders(number):
    exercise = load_exercise(number, ROOT)
    (text,) = ROOT.glob(f"exercises/ex{number:02d}_*/README.md")
    heading = text.read_text(encoding="utf-8").splitlines()[0]
    assert heading == f"# Exercise {number}. {exercise.title}"
    course = (ROOT / "README.md").read_text(encoding="utf-8").partition("## The course")[2]
    assert f" {number} {exercise.title}".lower() in " ".join(course.split()).lower()


@pytest.fixture
def sixteen(tmp_path):
    """The folder of a course with some of our exercises and a sixteenth; its environment."""
    root = tmp_path / "course"
    for name in ("ex01_gymnasium", "ex13_inside_ppo"):
        for top in ("exercises", "solutions"):
            shutil.copytree(ROOT / top / name, root / top / name)
    for name in ("Makefile", "tools/setup.sh", "pyproject.toml", "constraints.txt"):
        (root / name).parent.mkdir(exist_ok=True)
        shutil.copy(ROOT / name, root / name)
    texts = {
        f"solutions/ex16_tiny/{tiny_course.FILE}": tiny_course.SOLUTION,
        f"exercises/ex16_tiny/{tiny_course.FILE}": skeleton(tiny_course.SOLUTION),
        "exercises/ex16_tiny/test_tiny.py": tiny_course.GRADER,
        "exercises/ex16_tiny/HINTS.md": tiny_course.HINTS,
        "exercises/ex16_tiny/README.md": "# Exercise 16. Tiny\n",
    }
    for name, text in texts.items():
        text = re.sub(r"\b3\.([12])\b", r"16.\1", text).replace("Exercise(3,", "Exercise(16,")
        text = text.replace('file="tiny.py"', 'file="tiny.py", extras=("rl",)')
        (root / name).parent.mkdir(exist_ok=True)
        (root / name).write_text(text, encoding="utf-8")
    return root, environment_of_command() | {"BOTSCHOOL_COURSE": str(root)}


def test_a_sixteenth_exercise_is_two_folders(sixteen, tmp_path):
    pytest.importorskip("torch")
    root, env = sixteen
    code, out, errors = call("grade", "16", env=env)
    assert (code, errors) == (1, "") and "0 of 100 points" in out and "Next: task 16.1" in out
    code, out, _ = call("grade", "16", "--submission", "solutions", cwd=root, env=env)
    assert code == 0 and "100 of 100 points" in out
    assert "Hint 1 of 2 for task 16.1" in call("hint", "16.1", env=env)[1]
    code, out, _ = call("progress", env=env)
    titles = {line.split()[0]: line for line in out.splitlines()}
    assert code == 0 and {"1", "13", "16"} <= titles.keys() and "Tiny" in titles["16"]
    code, _, errors = call("grade", "15", env=env)
    assert code == 2 and "There is no exercise 15; there are 1, 13, 16." in errors
    assert call("release", tmp_path / "copy", env=env)[0] == 0
    code, out, _ = call("grade", "16", env=env | {"BOTSCHOOL_COURSE": str(tmp_path / "copy")})
    assert code == 1 and "0 of 100 points" in out
    for folder in (root, tmp_path / "copy"):
        for number, needed in ((1, []), (13, ["rl"]), (16, ["rl"])):
            assert _set_up_for(folder, number) == needed


def _set_up_for(root, number):
    """The extras that `make test-exN` would install."""
    command = ["make", "-n", f"test-ex{number}"]
    done = subprocess.run(command, cwd=root, capture_output=True, text=True, check=True)
    assert f"botschool grade {number}" in done.stdout
    return re.findall(r"setup\.sh extra (\S+)", done.stdout)


def test_an_exercise_without_its_packages_says_what_to_install(sixteen, monkeypatch):
    monkeypatch.setattr(
        "botschool.grading.declare.exercise._installed", lambda name: name != "stable-baselines3"
    )
    trust(sixteen[0])
    exercise = load_exercise(13, sixteen[0])
    with pytest.raises(BotschoolError, match=r"needs stable-baselines3.*make test-ex13.*\[rl\]"):
        exercise.require()
    job = batch.Job(13, submission_file(13, "solutions", sixteen[0]))
    result = batch.Grades(sixteen[0]).of([job], 1)[job]
    assert result["points"] == 0 and "needs stable-baselines3" in result["problem"]
    load_exercise(1, sixteen[0]).require()


def test_own_losses_have_the_gradient_of_torch():
    """What exercise 13's closing part measures from NumPy functions is what autograd finds."""
    torch = pytest.importorskip("torch")
    from botschool.course import ppo

    def policy_loss(now, old, advantages, epsilon):
        advantages = (advantages - advantages.mean()) / (advantages.std(ddof=1) + 1e-8)
        ratio = np.exp(now - old)
        clipped = np.clip(ratio, 1 - epsilon, 1 + epsilon)
        return {"loss": -np.minimum(ratio * advantages, clipped * advantages).mean()}

    def entropy(scores):
        p = np.exp(scores) / np.exp(scores).sum(axis=1, keepdims=True)
        return -(p * np.log(p)).sum(axis=1)

    functions = {
        "policy_loss": policy_loss,
        "value_loss": lambda now, old, returns: np.mean((returns - now) ** 2),
        "entropy_of_choices": entropy,
        "approx_kl": lambda now, old: 0.0,
        "updates_made": lambda found, limit: int(found[0][0] <= 1.5 * limit),
        "total_loss": lambda policy, value, e, ce, cv: policy + cv * value - ce * np.mean(e),
    }
    torch.manual_seed(1)
    policy, critic = ppo._network(2), ppo._network(1)
    rng, n = np.random.default_rng(1), 32
    batch = {
        "seen": rng.normal(size=(n, 4)), "actions": rng.integers(0, 2, n),
        "log_prob": -0.7 + 0.2 * rng.normal(size=n), "advantages": rng.normal(size=n),
        "values": rng.normal(size=n), "returns": rng.normal(size=n),
    }  # fmt: skip
    parameters = [*policy.parameters(), *critic.parameters()]
    measured = torch.autograd.grad(ppo._loss(functions, policy, critic, batch), parameters)
    given = {key: torch.as_tensor(array) for key, array in batch.items()}
    logarithms = torch.log_softmax(policy(given["seen"]), dim=1)
    now = logarithms.gather(1, given["actions"][:, None])[:, 0]
    a = (given["advantages"] - given["advantages"].mean()) / (given["advantages"].std() + 1e-8)
    ratio = torch.exp(now - given["log_prob"])
    surrogate = torch.minimum(ratio * a, ratio.clip(1 - ppo.CLIP, 1 + ppo.CLIP) * a).mean()
    error = ((given["returns"] - critic(given["seen"])[:, 0]) ** 2).mean()
    entropies = -(logarithms.exp() * logarithms).sum(dim=1).mean()
    loss = -surrogate + ppo.CRITIC * error - ppo.ENTROPY * entropies
    for ours, theirs in zip(measured, torch.autograd.grad(loss, parameters), strict=True):
        assert torch.allclose(ours, theirs, atol=1e-6), (ours - theirs).abs().max()
    functions["approx_kl"] = lambda now, old: 1.0
    assert ppo._loss(functions, policy, critic, batch) is None


@pytest.mark.parametrize("kind", [bool, float, np.bool_, np.int64])
def test_film_of_an_agent_whose_choices_are_other_types_than_int(tmp_path, kind):
    file = tmp_path / "agent.mp4"
    film_agent(file, "CartPole-v1", lambda seen: kind(seen[2] + seen[3] > 0), maxsteps=3)
    assert file.stat().st_size > 1000
