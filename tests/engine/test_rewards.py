"""Rewards of one's own: what an expression pays, and that it pays the same everywhere."""

import gymnasium
import numpy as np
import pytest

import botschool
import botschool.envs
from botschool import BotschoolError, _core, config, problems
from botschool.evolution.run import Run, evolve
from botschool.problems.native import NATIVE, NativeProblem
from running import run_seeds, same

EXPRESSIONS = (
    ("CartPole-v1", "cos(angle) - 0.01 * x ** 2", "abs(angle) > 0.5 or abs(x) > 3"),
    ("CartPole-v1", "where(-0.1 < angle < 0.1, 1, 0) * (1 - abs(x) / 2.4)", ""),
    ("Pendulum-v1", "exp(-angle ** 2) - 0.01 * action ** 2", "time > 5 and upright > 0.99"),
    ("Acrobot-v1", "height + 0.1 * change(height)", "height > 1.5"),
    ("envSwingupCustom", "upright if abs(x) < 1 else -1", ""),
    ("ErDiscrim", "1 / (1 + max(cylinder, 0)) + reward", "ended or time >= 20"),
    ("PlanarHopper-v5", "ahead - 0.05 * effort + 0.2 * upright", "height < 0.6 or upright < 0.3"),
    ("PlanarHopper-v5", "max(rise, 0) * (foot_force == 0)", "not 0.5 < height < 3"),
    ("PlanarHalfCheetah-v5", "min(ahead, 3) - sqrt(power) / 100 - 0.1 * abs(spin)", ""),
    ("SpatialAnt-v5", "clip(ahead, -1, 4) - 0.001 * power + 0.1 * cos(heading)", "upright < 0"),
    ("SpatialAnt-v5", "sin(3 * time) * spin - abs(hip_1_angle)", "height < 0.25"),
    ("SpatialHumanoid-v5", "reward - 0.1 * effort + 2 * (torso_force > 0)", ""),
)


def returns(environment, reward, ends="", instruction_set="", workers=1, n=40):
    problem = NativeProblem(environment, instruction_set=instruction_set, reward=reward, ends=ends)
    policy = problem.policy(config.PolicyConfig(nhiddens=5))
    genotypes = np.array([policy.initial(1, i) for i in range(n)])
    episodes = problems.Episodes.of([7] * n, 1)
    return problem.evaluate(policy, genotypes, None, episodes, 60, workers)


@pytest.mark.parametrize(("environment", "reward", "ends"), EXPRESSIONS)
def test_every_instruction_set_and_number_of_threads_pays_the_same(environment, reward, ends):
    sets = _core.instruction_sets()
    first = returns(environment, reward, ends, sets[0])
    other = returns(environment, reward, ends, sets[-1], workers=2)
    assert np.array_equal(first.fitness, other.fitness) and np.array_equal(first.steps, other.steps)
    assert len(set(first.fitness)) > 1, "nothing depends on the robot"


@pytest.mark.parametrize(("environment", "reward", "ends"), EXPRESSIONS)
def test_the_environment_pays_what_the_lanes_pay(environment, reward, ends):
    """The actions of an episode of the engine, one after another, step by step."""
    problem = NativeProblem(environment, reward=reward, ends=ends)
    policy = problem.policy(config.PolicyConfig(nhiddens=5))
    steps = list(problem.play(policy, policy.initial(3), None, 5, 0, 40))
    stepper = _core.make_stepper(problem.dynamics)
    stepper.set(problem.limit, problem.options())
    stepper.start(5, 0)
    for step in steps:
        assert stepper.step(np.asarray(step.action, float))[0] == step.reward


def test_a_reward_is_what_python_computes_from_the_states():
    made = {"reward": "cos(angle) - 0.01 * x ** 2 + change(x)", "ends": "x > 0.05"}
    env = gymnasium.make("botschool/SwingUp-v0", **made)
    env.reset(seed=3)
    before = env.unwrapped._simulation.state[0]
    for _ in range(100):
        _, reward, ended, _, _ = env.step(np.float32([1]))
        x, _, angle, _ = env.unwrapped._simulation.state
        assert reward == pytest.approx(np.cos(angle) - 0.01 * x**2 + x - before, abs=1e-12)
        assert ended == (x > 0.05)
        before = x
        if ended:
            break
    assert ended


@pytest.mark.slow
def test_workers_resume_and_gymnasium_carry_the_reward(tmp_path):
    file = tmp_path / "own.ini"
    file.write_text(
        "[EXP]\nenvironment = CartPole-v1\nreward = cos(angle) - 0.01 * x ** 2\nends = abs(x) > 1\n"
        "[POLICY]\nnhiddens = 3\n[ALGO]\nmaxmsteps = 0.02\nsamplesize = 4\n"
    )
    own = config.load(file)
    assert run_seeds(own, tmp_path / "1")
    assert run_seeds(own, tmp_path / "2", workers=2)
    run = Run(own, 1)
    (tmp_path / "3").mkdir()
    evolve(run, tmp_path / "3", steps=9000)
    assert run_seeds(own, tmp_path / "3", resume=True)
    assert same(tmp_path / "1", tmp_path / "2") and same(tmp_path / "1", tmp_path / "3")
    pole = botschool.problem("CartPole-v1", reward="7")
    assert (
        pole.evaluate(np.zeros(pole.parameters))[0]
        == 7 * pole.evaluate(np.zeros(pole.parameters))[1]
    )


@pytest.mark.parametrize(
    ("reward", "sentence"),
    [
        (
            "heigth",
            "no quantity 'heigth' in PlanarHopper-v5; did you mean height?",
        ),
        ("sqt(x)", "there is no function 'sqt'; did you mean sqrt?"),
        ("x.real", "quantities have no parts"),
        ("'x'", "there is a text in quotes"),
        ("x = 1", "write == to compare"),
        ("x ^ 2", "write **"),
        ("x ** -1", "an exponent is a whole number"),
        ("max(x)", "max takes 2 or more values"),
        ("(x", "a bracket is not closed"),
        ("x)", "without its '('"),
        ("x if 1", "'if' needs an 'else'"),
        ("2x", "write a sign between them"),
        ("x +", "it ends too early"),
        ("x[0]", "write round brackets"),
        ("change(ahead)", "ahead is a change itself"),
        ("change(x + 1)", "change takes the name of one quantity"),
        ("__import__(x)", "there is no function"),
        ("+".join(["x"] * 400), "at most 160 operations"),
        ("(" * 100 + "x" + ")" * 100, "too many brackets"),
        ("x" * 2000, "more than 1000 characters"),
        ("é", "has no meaning here"),
    ],
)
def test_a_wrong_expression_is_one_sentence(reward, sentence):
    with pytest.raises(BotschoolError) as told:
        botschool.problem("PlanarHopper-v5", reward=reward)
    assert sentence in str(told.value) and "\n" not in str(told.value)
    assert len(str(told.value)) < 400


def test_division_by_zero_names_expression_step_and_quantities():
    pole = botschool.problem("CartPole-v1", reward="1 / (time > 0.05) - x")
    with pytest.raises(
        BotschoolError,
        match=r"is infinite in step 1 of episode 0 of seed 3, where time = 0.02 and x = ",
    ):
        pole.evaluate(np.zeros(pole.parameters), seeds=3)
    safe = botschool.problem("CartPole-v1", reward="where(time > 0.05, 1 / (time > 0.05), 0)")
    assert np.isfinite(safe.evaluate(np.zeros(safe.parameters))[0])


def test_only_native_problems_take_a_reward(command, refused):
    with pytest.raises(BotschoolError, match="is for native problems"):
        botschool.problem("MountainCar-v0", reward="1")
    assert "1 upright" in command("problems", "SpatialAnt-v5")[1]
    refused("problems", "MountainCar-v0", says=["runs in Python"])


@pytest.mark.parametrize("name", sorted({core for core, _ in NATIVE.values()}))
def test_every_native_problem_names_quantities_with_meanings(name):
    rows = _core.quantities(name)
    names = [row[0] for row in rows]
    assert len(set(names)) == len(names) > 5
    assert all(name.isidentifier() and meaning for name, _, meaning in rows)
    outcome = (
        returns(name, " + ".join(name for name in names[-30:]), n=2)
        if len(NativeProblem(name).robots) < 2
        else None
    )
    assert outcome is None or np.isfinite(outcome.fitness).all()


@pytest.mark.slow
def test_trainings_and_environments_take_a_reward(tmp_path):
    own = {"reward": "7", "ends": "time > 0.99"}
    agent = botschool.train("CartPole-v1", steps=2000, progress=False, **own)
    assert agent.settings.own == own and agent.settings.engine == "native"
    assert np.isfinite(agent.history["mean"]).all()
    assert (agent.play(2) == 350).all()
    with pytest.raises(BotschoolError, match="no quantity 'hieght'"):
        botschool.train("PlanarHopper-v5", reward="hieght")
    env = gymnasium.make("botschool/CartPole-v1", **own)
    env.reset(seed=1)
    assert env.step(0)[1] == 7
