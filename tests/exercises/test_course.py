"""What exercises import keeps its names; a new exercise is two folders and nothing else."""

import ast
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

import tiny_course
from botschool import arena as arenas
from botschool import config
from botschool.course import locomotion, recordings
from botschool.course.coevolution import (
    load_run,
    play,
    robot,
)
from botschool.course.locomotion import Runner
from botschool.errors import BotschoolError
from botschool.evolution.run import Run, evolve
from botschool.grading.copies.skeleton import skeleton
from botschool.grading.declare import exercise as declared
from botschool.grading.declare.exercise import (
    exercise_numbers,
    folder_of,
    load_exercise,
)
from botschool.grading.judge.submission import grade
from botschool.grading.report.screen import Screen
from running import call, environment_of_command

ROOT = Path(__file__).parents[2]


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
        "exercises/ex16_tiny/README.md": tiny_course.HINTS.replace("# Tiny", "# Exercise 16. Tiny"),
    }
    for name, text in texts.items():
        text = re.sub(r"\b3\.([12])\b", r"16.\1", text).replace("Exercise(3,", "Exercise(16,")
        text = text.replace('file="tiny.py"', 'file="tiny.py", extras=("rl",)')
        (root / name).parent.mkdir(exist_ok=True)
        (root / name).write_text(text, encoding="utf-8")
    return root, environment_of_command() | {"BOTSCHOOL_COURSE": str(root)}


@pytest.mark.parametrize("number", exercise_numbers(ROOT))
def test_no_grader_keeps_what_follows_from_the_seeds_of_one_submission(number):
    """Only exercise.cached does; functools.cache gave right answers the numbers of others."""
    folder = folder_of(number, ROOT)
    functions = {
        node.name: node
        for file in folder.glob("test_*.py")
        for node in ast.parse(file.read_text()).body
        if isinstance(node, ast.FunctionDef)
    }
    used = {
        name: {each.id for each in ast.walk(node) if isinstance(each, ast.Name)}
        for name, node in functions.items()
    }
    draws = {n for n, node in functions.items() if "exercise.seed(" in ast.unparse(node)}
    while more := {name for name, names in used.items() if names & draws} - draws:
        draws |= more
    kept = {
        name
        for name, node in functions.items()
        for decorator in map(ast.unparse, node.decorator_list)
        if "cache" in decorator and decorator != "exercise.cached"
    }
    assert not kept & draws


@pytest.mark.slow
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
    (root / "lib" / "botschool").mkdir(
        parents=True
    )  # a course with its source; a copy without one uses what is installed
    for number, needed in ((1, []), (13, ["rl"]), (16, ["rl"])):
        assert _set_up_for(root, number) == needed
    assert _set_up_for(tmp_path / "copy", 16) == []


def _set_up_for(root, number):
    """The extras that `make test-exN` would install."""
    command = ["make", "-n", f"test-ex{number}"]
    done = subprocess.run(command, cwd=root, capture_output=True, text=True, check=True)
    assert f"botschool grade {number}" in done.stdout
    return re.findall(r"setup\.sh extra (\S+)", done.stdout)


# --- What exercise 9 is given: runners, recorded episodes; and that it is graded without PyBullet.


BALANCING = ROOT / "solutions" / "ex10_balance_bot" / "balancing_robot.py"


@pytest.fixture
def without_pybullet(monkeypatch):
    monkeypatch.setenv("BOTSCHOOL_COURSE", str(ROOT))
    monkeypatch.setattr(recordings, "find_spec", lambda name: None)
    monkeypatch.delattr(recordings, "simulated")


def test_robots_are_those_of_the_experiment_file(tmp_path):
    """The same genotype as with `botschool es` and the same steps, but for `pepisodes`."""
    experiment = config.load(ROOT / "data" / "experiments" / "planarhopper.ini")
    experiment.policy.pepisodes = locomotion.POLICY["pepisodes"]
    run = Run(experiment, 5)
    evolve(run, tmp_path, steps=60_000)
    evolved = Runner("PlanarHopper-v5").evolve(60_000, 5)
    assert np.array_equal(evolved, np.load(tmp_path / "bestgS5.npy"))


@pytest.mark.slow
def test_exercise_9_is_graded_without_pybullet(without_pybullet):
    exercise = load_exercise(9, ROOT)
    assert not exercise.extras
    file = ROOT / "solutions" / "ex09_reward_functions" / "reward_functions.py"
    tasks = [exercise.find(id) for id in ("9.3", "9.4")]
    result = grade(exercise, file, tasks=tasks)
    assert [task.points for task in result.tasks] == [task.max_points for task in tasks]


@pytest.mark.slow
def test_a_task_without_its_packages_is_not_graded(monkeypatch, capsys):
    monkeypatch.setenv("BOTSCHOOL_COURSE", str(ROOT))
    monkeypatch.setattr(
        declared, "missing_packages", lambda extras: ["torch"] if "rl" in extras else []
    )
    exercise = load_exercise(10, ROOT)
    tasks = [exercise.find(id) for id in ("10.1", "10.8", "10.10")]
    result = grade(exercise, BALANCING, tasks=tasks)
    assert [(task.points, task.graded) for task in result.tasks] == [
        (12, True), (8, True), (0, False),
    ]  # fmt: skip
    (first, _, last) = result.to_json()["tasks"]
    assert "graded" not in first and last["graded"] is False
    assert re.match(r"Not graded: this task needs torch, not installed here: ", last["message"])
    screen = Screen()
    screen.task(result.tasks[2])
    screen.end(result, whole=False)
    told = capsys.readouterr().out
    assert "– of 8" in told and "20 of 28 points (8 of them could not be graded" in told
    with pytest.raises(BotschoolError, match=r"Exercise 10 needs torch: .*botschool\[rl\]"):
        exercise.require_some([exercise.find("10.10")])
    exercise.require_some(exercise.tasks)
    with pytest.raises(BotschoolError, match="torch"):
        exercise.require()


# --- What exercise 15 is given ready-made.


PARAMETERS = 4977


def robots(count, seed=1):
    """They drive fast and nearly straight on, so that some meet."""
    genotypes = 0.05 * np.random.default_rng(seed).normal(size=(count, PARAMETERS))
    genotypes[:, 25:27] += 0.8
    return genotypes


def stepped(predator, prey, maxsteps):
    arena = arenas.make("predprey", max_steps=maxsteps)
    networks, fitness = (robot(predator), robot(prey)), 0.0
    while not arena.done:
        seen = np.split(arena.observation.copy(), 2)
        for network, observation in zip(networks, seen, strict=True):
            network.observation = observation
        arena.action = np.concatenate([network.step() for network in networks])
        fitness += arena.step()
    return fitness


def test_play_is_what_stepping_gives():
    predators, prey = robots(3), robots(2, seed=2)
    pairs = np.array([(2, 1), (0, 0), (1, 0), (2, 1)])
    fitness = play(predators, prey, pairs, 60)
    expected = [stepped(predators[i], prey[j], 60) for i, j in pairs]
    np.testing.assert_allclose(fitness, expected, atol=1e-9)
    assert np.count_nonzero(fitness) > 0


def save(folder, seed, generations, individuals=3):
    folder.mkdir(parents=True, exist_ok=True)
    for generation in generations:
        both = robots(2 * individuals, seed=generation)
        np.save(folder / f"S{seed}G{generation}.npy", both)
        np.save(folder / f"S{seed}FitG{generation}.npy", np.zeros((6, 3)))


@pytest.fixture
def course(tmp_path, monkeypatch):
    (tmp_path / "exercises").mkdir()
    monkeypatch.setenv("BOTSCHOOL_COURSE", str(tmp_path))
    return tmp_path


def test_own_run_comes_first(course):
    save(course / "data/genotypes/predprey", 12, (0, 7))
    save(course / "run", 3, range(0, 200, 10))
    run = load_run("run", most=5, best=2)
    assert list(run) == [0, 50, 100, 140, 190]
    predators, prey = run[50]
    np.testing.assert_array_equal(predators, robots(6, seed=50)[:2])
    np.testing.assert_array_equal(prey, robots(6, seed=50)[3:5])


def test_else_that_of_the_course(course):
    save(course / "data/genotypes/predprey", 12, (0, 7))
    assert list(load_run("run")) == [0, 7]
    save(course / "run", 3, (0,))
    assert list(load_run("run")) == [0, 7]
    assert len(load_run("run")[7][0]) == 3


def test_runs_that_cannot_be_used(course):
    with pytest.raises(BotschoolError, match="predprey"):
        load_run("run")
    (course / "data/genotypes/predprey").mkdir(parents=True)
    with pytest.raises(BotschoolError, match="holds no populations: evolve some"):
        load_run("run")
    save(course / "run", 3, (0, 1))
    save(course / "run", 4, (0, 1))
    with pytest.raises(BotschoolError, match=re.escape("several seeds (3, 4)")):
        load_run("run")
