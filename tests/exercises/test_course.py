"""What exercises import keeps its names; a new exercise is two folders and nothing else."""

import ast
import contextlib
import re
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

import tiny_course
from botschool import arena as arenas
from botschool import config
from botschool.course import film_agent, locomotion, recordings
from botschool.course.coevolution import (
    _touching,
    draw_chases,
    draw_red_queen,
    draw_tournament,
    load_run,
    play,
    robot,
)
from botschool.course.locomotion import Runner
from botschool.errors import BotschoolError
from botschool.evolution.run import Run, evolve
from botschool.grading.classes import batch
from botschool.grading.copies.skeleton import skeleton
from botschool.grading.copies.starting import open_notebook
from botschool.grading.declare import exercise as declared
from botschool.grading.declare.exercise import (
    exercise_numbers,
    folder_of,
    load_exercise,
    submission_file,
)
from botschool.grading.declare.trust import trust
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
        "exercises/ex16_tiny/HINTS.md": tiny_course.HINTS,
        "exercises/ex16_tiny/README.md": "# Exercise 16. Tiny\n",
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


def test_an_exercise_without_its_packages_says_what_to_install(sixteen, monkeypatch):
    monkeypatch.setattr(
        "botschool.grading.declare.exercise._installed", lambda name: name != "stable-baselines3"
    )
    trust(sixteen[0])
    exercise = load_exercise(13, sixteen[0])
    with pytest.raises(
        BotschoolError, match=r"needs stable-baselines3.*botschool start 13.*\[rl\]"
    ):
        exercise.require()
    job = batch.Job(16, sixteen[0] / "solutions/ex16_tiny/tiny.py")
    result = batch.Grades(sixteen[0]).of([job], 1)[job]
    assert result["points"] == 0 and "needs stable-baselines3" in result["problem"]
    load_exercise(1, sixteen[0]).require()


@pytest.mark.parametrize("kind", [bool, float, np.bool_, np.int64])
def test_film_of_an_agent_whose_choices_are_other_types_than_int(tmp_path, kind):
    file = tmp_path / "agent.mp4"
    film_agent(file, "CartPole-v1", lambda seen: kind(seen[2] + seen[3] > 0), maxsteps=3)
    assert file.stat().st_size > 1000


# --- What exercise 9 is given: runners, recorded episodes; and that it is graded without PyBullet.


BALANCING = ROOT / "solutions" / "ex10_balance_bot" / "balancing_robot.py"
ROBOTS = ("Hopper", "HalfCheetah", "Ant", "Walker2D", "Humanoid")


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


@pytest.mark.parametrize("seed", [1, 3])
def test_one_stands_and_the_other_hops(seed):
    """What exercise 9 shows, after a fifth of its steps; seed 3's hopper is the worst of ten."""
    metres, grounded = {}, {}
    for version in ("v0", "v5"):
        runner = Runner(f"PlanarHopper-{version}")
        genotype = runner.evolve(1_000_000, seed)
        episodes = [runner.record(genotype, 1000 + i) for i in range(5)]
        ways = [one["distance"] for one in episodes]
        metres[version] = np.mean([way[0] - way[-1] for way in ways])
        grounded[version] = np.mean([one["feet"].mean() for one in episodes])
    assert metres["v5"] > 2 * metres["v0"]
    assert grounded["v0"] > 0.9 and grounded["v5"] < 0.6


@pytest.mark.parametrize("body", ["hopper", "walker2d", "halfcheetah"])
def test_recorded_episodes_add_up(body):
    """Progress is the reward of version 5; in a gait feet leave the ground and come back."""
    name = {"hopper": "Hopper", "walker2d": "Walker2D", "halfcheetah": "HalfCheetah"}[body]
    runner = Runner(f"Planar{name}-v5")
    genotype = np.load(ROOT / "data" / "genotypes" / f"planar{body}.npy")
    one, play = runner.record(genotype, 7, 300), list(runner.play(genotype, 7, 300))
    steps = len(play)
    assert len(one["distance"]) == steps + 1
    assert one["actions"].shape == (steps, runner.policy.spec.outputs)
    assert one["feet"].shape == (steps, 1 if body == "hopper" else 2)
    progress = -np.diff(one["distance"]) / one["duration"]
    if body != "halfcheetah":  # which pays for joints at their limits, too
        np.testing.assert_allclose(progress, [step.reward for step in play], atol=1e-4)
    np.testing.assert_array_equal(one["height"], [step.state[1] for step in play])
    np.testing.assert_array_equal(one["pitch"], [step.state[2] for step in play])
    changes = np.abs(np.diff(one["feet"], axis=0)).sum(axis=0)
    assert set(np.unique(one["feet"])) == {0.0, 1.0} and (changes >= 4).all()


@pytest.mark.parametrize("name", ["PlanarHopper", "PlanarWalker2D", "PlanarHalfCheetah"])
def test_a_foot_is_down_while_the_ground_pushes_it(name):
    runner = Runner(f"{name}-v5")
    genotype = np.load(ROOT / "data" / "genotypes" / f"{name.lower()}.npy")
    scene = runner._scene()
    ((_, feet),) = scene.charted
    shown = [
        [scene.numbers(step.state)[foot] for foot in feet] for step in runner.play(genotype, 3, 200)
    ]
    np.testing.assert_array_equal(runner.record(genotype, 3, 200)["feet"], shown)
    assert len(feet) == 1 or any(left != right for left, right in shown)


@pytest.mark.parametrize("robot", ROBOTS)
def test_recorded_episodes_are_those_of_pybullet(robot, monkeypatch):
    pytest.importorskip("pybullet")
    monkeypatch.setenv("BOTSCHOOL_COURSE", str(ROOT))
    one, other = recordings.recorded(robot), recordings.simulated(robot, 1)
    assert one.trajectory.keys() == other.trajectory.keys()
    for key in one.trajectory.keys() - {"robot"}:
        np.testing.assert_allclose(one.trajectory[key], other.trajectory[key], atol=1e-6)
    assert one.v0.keys() == other.v0.keys()
    for key in one.v0:
        np.testing.assert_allclose(one.v0[key], other.v0[key], atol=1e-4)
    np.testing.assert_allclose(one.v5, other.v5, atol=1e-4)


def test_exercise_9_is_graded_without_pybullet(without_pybullet):
    exercise = load_exercise(9, ROOT)
    assert not exercise.extras
    file = ROOT / "solutions" / "ex09_reward_functions" / "reward_functions.py"
    tasks = [exercise.find(id) for id in ("9.3", "9.4")]
    result = grade(exercise, file, tasks=tasks)
    assert [task.points for task in result.tasks] == [task.max_points for task in tasks]


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


def test_users_of_a_wheel_are_not_told_to_use_make(sixteen, tmp_path, monkeypatch):
    monkeypatch.setattr(declared, "missing_packages", lambda extras: ["torch"])
    monkeypatch.setattr("botschool.grading.copies.starting.find_spec", lambda name: None)
    (tmp_path / "exercises").symlink_to(sixteen[0] / "exercises")
    shutil.copy(ROOT / "Makefile", tmp_path)
    trust(tmp_path)
    monkeypatch.setenv("BOTSCHOOL_COURSE", str(tmp_path))
    exercise = load_exercise(16, tmp_path)
    for tells in (
        exercise.require,
        lambda: open_notebook(16, tmp_path / "x.py", tmp_path),
        lambda: submission_file(16, str(tmp_path), tmp_path),
    ):
        with pytest.raises(BotschoolError) as told:
            tells()
        assert " make " not in str(told.value).replace("'", " "), told.value


@pytest.mark.parametrize(("number", "picture"), [(5, "box2d"), (13, "rl"), (14, "")])
def test_an_exercise_is_graded_without_what_only_its_picture_needs(number, picture, monkeypatch):
    monkeypatch.setattr(declared, "missing_packages", list)
    exercise = load_exercise(number, ROOT)
    exercise.require(exercise.tasks)
    assert not any(map(declared.cannot_be_graded, exercise.tasks))
    with pytest.raises(BotschoolError, match=picture) if picture else contextlib.nullcontext():
        exercise.require()


def test_a_picture_of_gaits_shows_every_robot(tmp_path):
    runner = Runner("PlanarHopper-v5")
    genotype = np.load(ROOT / "data" / "genotypes" / "planarhopper.npy")
    one = runner.record(genotype, 1, 300)
    row = runner.strip(genotype, 1, 200, 5)
    assert row.shape[1] % 5 == 0 and row.std() > 10
    fallen = np.append(np.zeros(runner.size - 11), np.ones(11))  # after 124 steps
    short = runner.strip(fallen, 1, pictures=8)
    assert short.shape[1] == 8 * row.shape[1] // 5 and (short[:, -100:] == 255).all()
    file = tmp_path / "gaits.png"
    income = {"progress": 800.0, "alive": 300.0, "effort": -2.0}
    locomotion.draw_gaits(file, {"a": [one, one]}, {"a": income}, {"a": one}, {"a": row})
    assert file.stat().st_size > 20_000


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


@pytest.mark.parametrize(
    ("predators", "pairs", "said"),
    [
        (robots(2)[0], [(0, 0)], "The predators have the shape (4977,)"),
        (robots(2)[:, 1:], [(0, 0)], "use (individuals, 4977)"),
        (robots(2), [(0.0, 0.0)], "whole numbers"),
        (robots(2), [0, 1], "shape (chases, 2)"),
        (robots(2), [(2, 0)], "there are 2 predators and 3 prey"),
        (robots(2), [(0, -1)], "an index that does not exist"),
    ],
)
def test_play_says_what_is_wrong(predators, pairs, said):
    with pytest.raises(BotschoolError, match=re.escape(said)):
        play(predators, robots(3), np.array(pairs))


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


def test_a_caught_prey_is_drawn_touching():
    places = np.array([[[0.0, 0.0], [900.0, 0.0]], [[300.0, 0.0], [300.0, 200.0]]])
    drawn = _touching(places, 170.0)
    assert drawn[-1].tolist() == [[300.0, 30.0], [300.0, 200.0]]
    assert np.array_equal(drawn[:-1], places[:-1])
    assert places[-1, 0].tolist() == [300.0, 0.0], "the recorded chase stays as it is"


def test_pictures(tmp_path):
    sides, parts = ("predators", "prey"), ("change", "own", "others")
    matrices = {side: np.eye(3) for side in sides}
    spans = {"ancient": np.zeros(2), "present": np.ones(3), "future": np.zeros(2)}
    draw_tournament(tmp_path / "a.png", matrices, dict.fromkeys(sides, spans), [0, 10, 20])
    red = {side: {part: np.ones(2) for part in parts} for side in sides}
    draw_red_queen(tmp_path / "b.png", red, [0, 10, 20])
    poses = np.random.default_rng(1).uniform(100, 2900, (5, 2, 3))
    chases = {(0, 0): {"poses": poses, "caught": True}, (0, 9): {"poses": poses, "caught": False}}
    draw_chases(tmp_path / "c.png", chases)
    assert all((tmp_path / name).stat().st_size > 5000 for name in ("a.png", "b.png", "c.png"))
