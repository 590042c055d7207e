"""The arenas stepped by hand: motion, collisions, rewards and ends against an independent account;
what holds whatever happens; and what cannot be is refused in a sentence."""

import math

import numpy as np
import pytest

from botschool import arena, problems
from botschool.config import PolicyConfig
from botschool.errors import BotschoolError
from botschool.policies.policy import Policy
from reference_arena import KHEPERA, MARXBOT, World

PI = math.pi
NAMES = ("discrim", "predprey")
BODIES = {"discrim": [KHEPERA], "predprey": [MARXBOT, MARXBOT]}
SPEEDS = {"discrim": [144.0], "predprey": [400.0, 500.0]}
NEAR = {"rel": 0, "abs": 1e-9}


def reference(own):
    """The world of an arena, as it stands."""
    cylinders, walls = own.objects[: own.cylinders], own.objects[own.cylinders :]
    rounds = cylinders[:, [0, 1, 4]]
    return World(BODIES[own.name], SPEEDS[own.name], own.robots, walls[:, :4], rounds)


def restart(own):
    """Goes on where an episode has ended."""
    robots, objects = own.robots.copy(), own.objects.copy()
    own.reset()
    own.robots, own.objects = robots, objects


# motion and collisions


@pytest.mark.parametrize("wildness", [0.3, 1.0, 3.0, 40.0])
@pytest.mark.parametrize("name", NAMES)
def test_a_thousand_random_steps_follow_the_reference(name, wildness):
    rng = np.random.default_rng(5)
    own = arena.make(name, max_steps=10**6)
    own.reset(seed=8)
    if name == "predprey":  # often near each other
        own.robots[1, :2] = 1200, 1550
    world, bumps = reference(own), set()
    for _ in range(1000):
        action = rng.uniform(-wildness, wildness, len(own.action))
        action += rng.choice([0, 0.8], p=[0.7, 0.3])
        action[1::2] = np.where(rng.random() < 0.1, action[::2], action[1::2])  # straight
        action[1::2] += np.where(rng.random() < 0.1, 1e-9, 0)
        own.action = action
        own.step()
        bumped = [world.drive(r, *action[2 * r : 2 * r + 2]) for r in range(len(world.poses))]
        bumps |= set(bumped)
        poses = np.array(world.poses)
        poses[:, 2] = own.robots[:, 2] + np.remainder(poses[:, 2] - own.robots[:, 2] + PI, 2 * PI)
        poses[:, 2] -= PI
        assert own.robots == pytest.approx(poses, **NEAR)
        assert own.terminated == (any(bumped) if name == "discrim" else "robot" in bumped)
        if own.terminated:
            restart(own)
    # they were worth it
    assert bumps >= ({"", "wall"} if wildness > 1 or name == "discrim" else {""})


# tasks


def test_discrim_starts_and_noise():
    own = arena.make("discrim")
    starts = np.array([(own.reset(seed=k), own.state)[1] for k in range(4000)])
    x, y, heading, cylinder_x, cylinder_y, steps = starts.T
    for values, low, high in (
        (x, 150, 250), (y, 270, 370), (heading, 0, 2 * PI), (cylinder_x, 100, 300),
        (cylinder_y, 100, 200),
    ):  # fmt: skip
        unit = np.sort((values - low) / (high - low))
        assert unit[0] >= 0 and unit[-1] <= 1
        assert np.abs(unit - (np.arange(4000) + 0.5) / 4000).max() < 2 / np.sqrt(4000)
    assert not steps.any()
    assert np.all(np.abs(np.corrcoef(starts[:, :5].T) - np.eye(5)) < 5 / np.sqrt(4000))
    own.robots[0], own.objects[0, :2] = (200, 300, 0), (100, 100)  # nothing in range
    noise = []
    while not own.done:
        own.step()
        noise.append(own.observation.copy())
    noise = np.array(noise) / 0.03
    assert noise.mean() == pytest.approx(0, abs=5 / np.sqrt(4000))
    assert noise.std() == pytest.approx(1, abs=5 / np.sqrt(8000))
    assert np.abs(noise).max() < 6
    assert len(np.unique(noise)) > 3990
    assert np.all(np.abs(np.corrcoef(noise.T) - np.eye(8)) < 5 / np.sqrt(500))


@pytest.mark.parametrize(
    ("name", "problem"), [("discrim", "ErDiscrim"), ("predprey", "ErPredprey")]
)
def test_it_is_the_world_of_evolution(name, problem):
    """The actions of an evaluated episode lead through the same states, and to its fitness."""
    made = problems.make(problem)
    config = PolicyConfig(nrobots=made.interface.robots, architecture=3, nhiddens=5)
    policy = Policy(problem, made.interface, config)
    own = arena.make(name, max_steps=200)
    for seed, episode in ((3, 0), (2**63, 7)):
        own.reset(seed, episode)
        total = 0.0
        for transition in made.play(policy, policy.initial(2), None, seed, episode, 200):
            # single precision is what evolution's policies see
            assert own.observation == pytest.approx(transition.observation, rel=0, abs=1e-4)
            own.action = transition.action
            total += own.step()
            assert own.state.tolist() == transition.state.tolist()
        assert own.done and total == transition.total


# the face


def test_resets():
    own, other = arena.make("discrim"), arena.make("discrim")
    first = own.reset(seed=5).copy()
    following = own.reset().copy()
    assert not np.array_equal(first, following)
    assert np.array_equal(other.reset(5, 1), following)
    assert np.array_equal(own.reset(seed=5), first)
    own.objects[0, 4] = 30
    own.reset(seed=5)
    assert own.objects[0, 4] == 30


def refused(call, *words):
    with pytest.raises(BotschoolError) as caught:
        call()
    sentence = str(caught.value)
    assert "\n" not in sentence and sentence[-1] in ".?" and sentence[0].isprintable()
    for word in words:
        assert word in sentence, sentence


def test_what_cannot_be_made():
    refused(lambda: arena.make("discrm"), "did you mean discrim?")
    refused(lambda: arena.make("maze"), "known are arena, discrim, predprey, staybehind.")
    refused(lambda: arena.make(["discrim"]), "no arena")
    for steps in (0, -1, 1.5, "long", 2**31):
        refused(lambda steps=steps: arena.make("discrim", steps), "max_steps")
    for noise in (-0.1, math.nan, math.inf, "loud"):
        refused(lambda noise=noise: arena.make("discrim", noise=noise), "noise")
    refused(lambda: arena.make("discrim", wall_table="none.sample"), "none.sample", "no such file")


@pytest.mark.parametrize(
    ("array", "index", "value", "words"),
    [
        ("action", 1, math.nan, ["action[1] is nan"]),
        ("action", 0, -math.inf, ["action[0] is -inf"]),
        ("robots", (0, 2), math.nan, ["robots[0, 2] is nan"]),
        ("robots", (0, 0), 10, ["Robot 0", "radius 27.5 mm", "overlap a wall"]),
        ("robots", (0, 1), 399, ["Robot 0", "399.0", "overlap a wall"]),
        ("objects", (0, 4), -1, ["Row 0", "cylinder", "radius", "above 0"]),
        ("objects", (0, 4), 0, ["Row 0", "cylinder", "radius", "above 0"]),
        ("objects", (0, 4), 1e6, ["Robot 0", "overlap"]),
        ("objects", (2, 4), 5, ["Row 2", "wall", "5"]),
        ("objects", (0, 3), 5, ["Row 0", "x2 and y2"]),
        ("objects", (3, 1), math.inf, ["objects[3, 1] is inf"]),
    ],
)
def test_what_cannot_be_stepped(array, index, value, words):
    own = arena.make("discrim")
    own.reset(seed=2)
    own.robots[0, :2], own.objects[0, :2] = (200, 300), (150, 150)
    getattr(own, array)[index] = value
    refused(own.step, *words)
    if array != "action":
        refused(own.sense, *words)
    assert own.steps == 0
