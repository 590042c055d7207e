"""Any environment evolves (docs/specification.md, "Any environment")."""

import ctypes
import sys
from contextlib import suppress

import gymnasium
import numpy as np
import pytest
from gymnasium import spaces

from botschool import config, problems, wrappers
from botschool.envs.wrappers import AliveBonus, LimbsApart
from botschool.errors import BotschoolError
from botschool.policies.policy import Policy
from botschool.problems import Episodes, making
from botschool.problems.spaces import Flattener, fitted, interface
from running import TESTS, experiment, run_seeds, same, write_experiment

# observations


def test_parts_of_an_observation_come_one_after_the_other():
    import tiny_envs

    env = gymnasium.make("tiny_envs:Nested-v0")
    raw, _ = env.reset(seed=3)
    flattener = Flattener(env.observation_space, "Nested")
    flat = flattener(raw)
    side, bits = raw["pair"]
    expected = [np.eye(3)[int(side) + 1], bits, np.arange(6), raw["x"].astype(float)]
    np.testing.assert_array_equal(flat, np.concatenate(expected))  # "pair", "view", "x"
    assert flattener.size == len(flat) == 13 and flat.dtype == np.float64
    assert isinstance(env.unwrapped, tiny_envs.Nested)


@pytest.mark.parametrize("seed", range(5))
def test_numbers_are_those_of_gymnasium(seed):
    space = spaces.Tuple(
        (
            spaces.Box(-1, 1, (2, 3)),
            spaces.Dict(b=spaces.Discrete(4), a=spaces.MultiDiscrete([[2, 3], [4, 2]])),
            spaces.MultiBinary([2, 2]),
            spaces.Box(0, 255, (2, 2, 3), np.uint8),
        ),
        seed=seed,
    )
    flattener = Flattener(space, "any")
    for _ in range(10):
        raw = space.sample()
        np.testing.assert_array_equal(flattener(raw), spaces.flatten(space, raw))


@pytest.mark.parametrize(
    "wrong", [{}, {"x": [0.0]}, {"x": [0, 0], "n": 9}, {"x": [0, 0], "n": "a"}, [0, 0], None, "x"]
)
def test_what_the_space_does_not_contain(wrong):
    flattener = Flattener(spaces.Dict(x=spaces.Box(-1, 1, (2,)), n=spaces.Discrete(3)), "any")
    with pytest.raises((TypeError, ValueError, LookupError)):
        flattener(wrong)


# actions


def test_each_choice_is_the_strongest_of_its_own_outputs():
    asked = interface(2, spaces.MultiDiscrete([3, 2]), 0)
    assert (asked.outputs, asked.groups, asked.discrete) == (5, (3, 2), True)
    policy = Policy("any", asked, config.PolicyConfig(nhiddens=0, out_type=3))
    policy.network.parameters[:] = [0, 0, 2, 0, 1, 0, 5, 0, 4, 0]
    for sign, action in ((1, [1, 0]), (-1, [0, 1])):
        np.testing.assert_array_equal(policy.act(np.array([sign, 0.0])), action)


def test_actions_are_in_their_space():
    many = spaces.MultiDiscrete([[3, 2]], start=[[-1, 4]])
    given = fitted(np.array([2, 0]), many)
    assert many.contains(given) and given.tolist() == [[1, 4]]
    bits = spaces.MultiBinary([2, 2])
    assert interface(1, bits, 0).groups == (2, 2, 2, 2)
    given = fitted(np.array([1, 0, 0, 1]), bits)
    assert bits.contains(given) and given.tolist() == [[1, 0], [0, 1]]
    plate = spaces.Box(-1, 1, (2, 2))
    given = fitted(np.array([3, 0.5, -2, np.nan], dtype=np.float32), plate)
    assert plate.contains(given) and given.tolist() == [[1, 0.5], [-1, 0]]


@pytest.mark.slow
@pytest.mark.parametrize("name", ["Nested", "Buttons", "Plate", "Picture"])
def test_they_evolve_alike_with_workers_and_resumed(name, tmp_path):
    own = experiment(tmp_path / name, f"tiny_envs:{name}-v0", maxmsteps=0.0006)
    assert run_seeds(own, tmp_path / "whole")
    assert run_seeds(own, tmp_path / "parts", steps=300)
    assert run_seeds(own, tmp_path / "parts", workers=2 if name == "Nested" else 1, resume=True)
    assert same(tmp_path / "whole", tmp_path / "parts")


def loads(library):
    with suppress(OSError):
        return ctypes.CDLL(library)


@pytest.mark.slow
def test_mujoco_is_filmed_without_a_display(tmp_path):
    """In a process of its own: what draws is chosen once."""
    pytest.importorskip("mujoco")
    if sys.platform != "linux":
        pytest.skip("elsewhere there is a display")
    if not any(map(loads, [library for _, library in making.DRAWING])):
        pytest.skip("MuJoCo has nothing to draw with")
    from running import call, environment_of_command

    ini = write_experiment(tmp_path, "Hopper-v5", policy={"maxsteps": 5})
    hidden = ("DISPLAY", "WAYLAND_DISPLAY", "MUJOCO_GL", "PYOPENGL_PLATFORM")
    environment = {k: v for k, v in environment_of_command().items() if k not in hidden}
    film = tmp_path / "hopper.mp4"
    code, _, errors = call("es", "-f", ini, "-p", "--video", film, "--episodes", 1, env=environment)
    assert code == 0, errors
    import imageio.v3

    assert imageio.v3.imread(film).std() > 5


@pytest.mark.parametrize(
    ("name", "package"),
    [
        ("FetchReach-v4", "gymnasium-robotics"),
        ("MiniGrid-Empty-5x5-v0", "minigrid"),
        ("BeamRiderNoFrameskip-v4", "ale-py"),
        ("ALE/Pong-v5", "ale-py"),
    ],
)
def test_what_to_install_for_a_known_family(name, package, monkeypatch):
    for module in ("gymnasium_robotics", "minigrid", "ale_py"):
        monkeypatch.setitem(sys.modules, module, None)
    monkeypatch.delitem(gymnasium.registry, name, raising=False)
    with pytest.raises(BotschoolError, match=f"{name} comes with the package {package}: install"):
        problems.make(name)


# wrappers


def test_wrappers_are_read():
    text = "TimeAwareObservation(normalize_time=False), my.own:Thing(1, word='a, b', size=(2, 3))"
    first, second = wrappers.parse(f" {text} ")
    assert (first.module, first.name, first.named) == (
        "", "TimeAwareObservation", {"normalize_time": False}
    )  # fmt: skip
    assert (second.module, second.name, second.given) == ("my.own", "Thing", (1,))
    assert second.named == {"word": "a, b", "size": (2, 3)}
    assert wrappers.parse("minigrid.wrappers.ImgObsWrapper")[0].module == "minigrid.wrappers"
    assert wrappers.parse("") == ()


def fitness(name, around="", maxsteps=30, seed=3):
    """Returns of two random robots, and the sizes of their observations."""
    problem = problems.make(name, wrappers=around)
    policy = Policy(name, problem.interface, config.PolicyConfig(nhiddens=0))
    genotypes = np.stack([policy.initial(seed, i) for i in (0, 1)])
    episodes = Episodes.of(np.array([4, 4], dtype=np.uint64), 2)
    outcome = problem.evaluate(policy, genotypes, None, episodes, maxsteps)
    return outcome.fitness, problem.interface.observations


@pytest.mark.slow
def test_wrappers_wrap_the_first_one_innermost():
    plain, _ = fitness("tiny_envs:Tiny-v0")
    doubled, size = fitness("tiny_envs:Tiny-v0", "tiny_envs:Doubled")
    np.testing.assert_allclose(doubled, 2 * plain)
    clipped = "tiny_envs:Doubled(times=3), ClipReward(min_reward=0, max_reward=0.5)"
    limited, _ = fitness("tiny_envs:Tiny-v0", clipped)
    assert (limited <= 0.5 * 12).all() and (limited > 0).all()
    _, timed = fitness("tiny_envs:Tiny-v0", "TimeAwareObservation(normalize_time=True)")
    assert timed == size + 1


def test_an_alive_bonus_is_paid_for_steps_that_do_not_end_the_episode():
    """CartPole pays 1 a step, also for the last one, in which it falls."""
    env = AliveBonus(gymnasium.make("CartPole-v1"), bonus=0.5)
    env.reset(seed=1)
    rewards, fallen = [], False
    while not fallen:
        _, reward, fallen, _, _ = env.step(1)
        rewards.append(reward)
    assert len(rewards) > 5 and rewards == [1.5] * (len(rewards) - 1) + [1.0]


@pytest.mark.slow
@pytest.mark.parametrize("apart", [False, True])
def test_limbs_apart_touch_the_ground_only(apart):
    """A humanoid that is dropped and kicks its legs together."""
    pytest.importorskip("mujoco")
    env = gymnasium.make("Humanoid-v5", terminate_when_unhealthy=False)
    env = LimbsApart(env) if apart else env
    env.reset(seed=1)
    touched = set()
    for _ in range(200):
        env.step(0.4 * np.sign(np.random.default_rng(1).normal(size=17)))
        contacts = env.unwrapped.data.contact
        touched |= {0 in pair for pair in contacts.geom.tolist()}
    assert touched == ({True} if apart else {True, False})


@pytest.mark.parametrize("body", ["ant", "humanoid"])
def test_robots_in_space_play_in_mujoco(body):
    """The files' policies read and move as much in MuJoCo as in lanes."""
    pytest.importorskip("mujoco")
    folder = TESTS.parent / "data" / "experiments"
    found = [config.load(folder / f"spatial{body}_{where}.ini") for where in ("linear", "mujoco")]
    lanes, mujoco = (problems.of(each) for each in found)
    sizes = [p.policy(e.policy).genotype_size for p, e in zip((lanes, mujoco), found, strict=True)]
    assert sizes[0] == sizes[1] and lanes.fps == pytest.approx(mujoco.fps, rel=0.02)
    assert lanes.interface.high == pytest.approx(mujoco.interface.high)


@pytest.mark.parametrize("name", ["CartPole-v1", "Pendulum-v0", "ErDiscrim", "envSwingupCustom"])
def test_native_problems_are_wrapped_as_environments(name):
    """Their starts are then those of the environment, so returns differ."""
    _, size = fitness(name)
    returns, more = fitness(name, "TimeAwareObservation(normalize_time=True)")
    assert more == size + 1 and np.isfinite(returns).all()


@pytest.mark.slow
def test_an_experiment_file_names_wrappers(tmp_path, command):
    ini = write_experiment(tmp_path, "tiny_envs:Tiny-v0", maxmsteps=0.0006)
    text = ini.read_text().replace("algo =", "wrappers = tiny_envs:Doubled(times=5)\nalgo =")
    ini.write_text(text)
    for folder, workers in (("one", 1), ("two", 2)):
        code, _, errors = command("es", "-f", ini, "-o", tmp_path / folder, "-w", workers)
        assert (code, errors) == (0, "")
    assert same(tmp_path / "one", tmp_path / "two")
    best = float((tmp_path / "one" / "S1.fit").read_text().split()[-1])
    code, out, _ = command("es", "-f", ini, "-p", "-g", tmp_path / "one" / "bestgS1.npy")
    assert f"mean {best:.2f}" in out
    ini.write_text(text.replace("times=5", "times=4"))
    code, _, errors = command("es", "-f", ini, "-o", tmp_path / "one", "--resume")
    assert code == 2 and "wrappers = tiny_envs:Doubled(times=5)" in errors


@pytest.mark.parametrize(
    ("named", "says"),
    [
        ("FlatenObservation", ["no wrapper 'FlatenObservation'", "did you mean FlattenObserv"]),
        ("zzz", ["no wrapper 'zzz' in gymnasium.wrappers", "module:Class"]),
        ("tiny_envs:Dubled", ["no wrapper 'Dubled' in tiny_envs", "did you mean Doubled?"]),
        ("not_there:Thing", ["no module not_there", "Thing"]),
        ("vector", "vector is no wrapper, but a module"),
        ("tiny_envs:Tiny(render_mode='x'), tiny_envs:gymnasium.Env", "is no wrapper"),
        ("numpy:asarray", "makes a ndarray of an environment"),
        ("Doubled(", "line 3: 'Doubled(' is no wrapper"),
        ("A,,B", "line 3: the wrappers have a comma too many"),
        ("ClipReward(min_reward=x)", "line 3: The arguments of the wrapper ClipReward cannot be"),
        ("ClipReward(**{'a': 1})", ["ClipReward", "does not fit"]),
        ("tiny_envs:Doubled(speed=2)", ["Doubled does not fit", "speed", "in brackets"]),
        ("NormalizeObservation", ["remembers earlier episodes", "normalize = 1"]),
    ],
)
def test_wrong_wrappers_are_refused_in_a_sentence(named, says, tmp_path, refused):
    ini = write_experiment(tmp_path, "tiny_envs:Tiny-v0")
    ini.write_text(ini.read_text().replace("algo =", f"wrappers = {named}\nalgo ="))
    refused("es", "-f", ini, "-o", tmp_path / "run", says=says)
    assert not (tmp_path / "run").exists()
