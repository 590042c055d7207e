"""The arenas stepped by hand: motion, collisions, rewards and ends against an independent account;
what holds whatever happens; and what cannot be is refused in a sentence."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from botschool import arena, problems
from botschool.config import PolicyConfig
from botschool.errors import BotschoolError
from botschool.policies.policy import Policy
from reference_arena import KHEPERA, MARXBOT, World
from reference_network import REPEATABLE

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


def test_a_robot_that_bumps_stays_where_it_was():
    own = arena.make("discrim")
    own.reset(seed=1)
    for pose, action in (
        [(372, 200, 0), (1, 1)],
        [(200, 30, 1.5 * PI), (1, 0.9)],
        [(100, 200, 0), (30, 30)],  # would land beyond the wall
        [(own.objects[0, 0] - 42, own.objects[0, 1], 0), (0.5, 0.5)],
    ):
        restart(own)
        own.robots, own.action = [pose], action
        assert own.step() == 0
        assert own.terminated and own.done
        assert own.robots.tolist() == [list(map(float, pose))]


@pytest.mark.parametrize("name", NAMES)
@REPEATABLE
@given(st.integers(8, 40), st.floats(-1, 1), st.booleans(), st.floats(-20, 20), st.integers(1, 2))
def test_a_circle_leads_back(name, steps, forward, clockwise, heading, rounds):
    own = arena.make(name, max_steps=10**6)
    body = own.models[0]
    reach = body.speed * 0.1
    turn = 2 * PI / steps * (-1 if clockwise else 1)
    half = turn * body.axle / 2 / reach
    forward *= min(1.0, 70 * abs(turn) / reach)  # radius of at most 70 mm
    own.robots[0] = own.width / 2, own.height / 2, heading
    own.objects[: own.cylinders, :2] = 30
    before = own.robots[0].copy()
    own.action[:2] = forward - half, forward + half
    for _ in range(steps * rounds):
        own.step()
        assert not own.done
    assert own.robots[0, :2] == pytest.approx(before[:2], **NEAR)
    assert math.remainder(own.robots[0, 2] - before[2], 2 * PI) == pytest.approx(0, **NEAR)


@REPEATABLE
@given(st.lists(st.tuples(st.floats(-1, 1), st.floats(-1, 1)), max_size=20))
def test_the_way_back_leads_back(actions):
    own = arena.make("predprey")
    own.robots[1] = 2800, 2800, 0
    before = own.robots[0].copy()
    for sign, row in ((1, actions), (-1, actions[::-1])):
        for left, right in row:
            own.action[:2] = sign * left, sign * right
            own.step()
    assert own.robots[0, :2] == pytest.approx(before[:2], **NEAR)
    assert math.remainder(own.robots[0, 2] - before[2], 2 * PI) == pytest.approx(0, **NEAR)


@pytest.mark.parametrize("name", NAMES)
@pytest.mark.parametrize("seed", range(3))
def test_mirror_images_stay_mirror_images(name, seed):
    """Left and right changed, with the wheels changed too; marXbots have mirrored sensors."""
    rng = np.random.default_rng(seed)
    one, other = (arena.make(name, noise=0) for _ in range(2))
    one.reset(seed=seed)
    if name == "predprey":
        one.robots[:, :] = (200, 500, 3.0), (420, 520, 0.3)

    def mirrored(robots):
        flipped = robots * [-1, 1, -1] + [one.width, 0, PI]
        flipped[:, 2] = flipped[:, 2] % (2 * PI)
        return flipped

    other.robots = mirrored(one.robots)
    other.objects = one.objects
    other.objects[0, 0] = one.width - one.objects[0, 0] if one.cylinders else one.objects[0, 0]
    for _ in range(300):
        action = rng.uniform(-0.5, 1, len(one.action))
        one.action = action
        other.action = action.reshape(-1, 2)[:, ::-1].ravel()
        assert one.step() == other.step()
        assert one.done == other.done
        gap = mirrored(one.robots) - other.robots
        gap[:, 2] = [math.remainder(angle, 2 * PI) for angle in gap[:, 2]]
        assert np.abs(gap).max() < 1e-9
        if name == "predprey":
            for seen, image in zip(
                *(np.split(a.observation, 2) for a in (one, other)), strict=True
            ):
                assert image[:8] == pytest.approx(seen[7::-1], rel=0, abs=1e-8)
                assert image[8:16] == pytest.approx(seen[15:7:-1], rel=0, abs=1e-8)
                assert image[17:21] == pytest.approx(seen[[18, 17, 20, 19]], rel=0, abs=1e-8)
        if one.done:
            break


@pytest.mark.parametrize("name", NAMES)
@REPEATABLE
@given(st.integers(0, 2**64 - 1), st.integers(0, 2**32 - 1), st.sampled_from([1.0, 5.0, 1e3, 1e30]))
def test_whatever_happens(name, seed, episode, wildness):
    """Robots never overlap anything nor leave, and readings are in their ranges."""
    rng = np.random.default_rng([seed, episode])
    own = arena.make(name, max_steps=20, noise=0)
    own.reset(seed, episode)
    while not own.done:
        own.action = rng.uniform(-wildness, wildness, len(own.action))
        reward = own.step()
        assert 0 <= reward <= 1
        world = reference(own)
        for robot, (x, y, heading) in enumerate(own.robots):
            assert world.bump(robot, x, y) == ""
            assert 0 < x < own.width and 0 < y < own.height and 0 <= heading <= 2 * PI
        assert np.all((own.observation >= 0) & (own.observation <= 1))
    assert own.terminated or own.steps == 20


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


def test_discrim_rewards_nearness():
    own = arena.make("discrim", max_steps=4)
    x, y = own.objects[0, :2] = 200, 200
    for distance, reward in ((99.99, 1), (100.01, 0), (41, 1), (150, 0)):
        own.robots[0] = x + distance, y, 0
        assert not own.done
        assert own.step() == reward
    assert own.done and not own.terminated
    own.reset()
    own.objects[0] = 200, 200, 0, 0, 20  # a larger one
    own.robots[0] = 200 + 107.4, 200, 0
    assert own.step() == 1


def test_predprey_ends_when_they_touch():
    own = arena.make("predprey", max_steps=50)
    assert own.robots.tolist() == [[1000, 1500, 0], [2000, 1500, PI]]
    own.action = [1, 1, 0, 0]
    rewards = []
    while not own.done:
        rewards.append(own.step())
    # 40 mm a step; 1000 - 170 mm apart
    assert len(rewards) == 21 and own.terminated
    assert rewards == [0.0] * 20 + [1 - 21 / 50]
    assert own.robots[0].tolist() == [1800, 1500, 0]
    own.reset()
    own.action[:] = 0
    while not own.done:
        assert own.step() == 0
    assert own.steps == 50 and not own.terminated


def test_walls_only_block_predator_and_prey():
    own = arena.make("predprey", max_steps=100)
    own.action = [-1, -1, -1, -1]
    while not own.done:
        own.step()
    assert not own.terminated
    assert own.robots.tolist() == [[120, 1500, 0], [2900, 1500, PI]]


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


@pytest.mark.parametrize("name", NAMES)
def test_arrays_stay_the_same_ones(name):
    own = arena.make(name)
    arrays = [own.observation, own.action, own.robots, own.objects]
    own.action, own.robots, own.objects = own.action + 0.1, own.robots + 1, own.objects + 0
    own.step()
    own.reset(seed=4)
    own.sense()
    for array, now in zip(
        arrays, [own.observation, own.action, own.robots, own.objects], strict=True
    ):
        assert array is now and array.dtype == np.float64
    assert own.observation.shape == ((8,) if name == "discrim" else (48,))
    assert own.action.tolist() == pytest.approx([0.1] * len(own.action))


def test_sensing_moves_nothing():
    own = arena.make("discrim", noise=0)
    own.robots[0], own.objects[0, :2] = (200, 200, 0), (260, 200)
    seen = own.sense().copy()
    assert seen.max() > 0.2 and own.steps == 0
    assert own.robots.tolist() == [[200, 200, 0]]
    own.objects[0, 0] = 300
    assert own.sense().max() == 0
    own.objects[1] = 0, 170, 400, 170, 0  # the lower wall, moved near
    assert own.sense().max() > 0.3


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


@pytest.mark.parametrize("name", NAMES)
def test_what_cannot_be_given(name):
    own = arena.make(name)
    size = len(own.action)
    for action in ([1] * (size + 1), [1] * (size - 1), [[1] * size], "fast", None, [None] * size,
                   [[1], [1, 2]]):  # fmt: skip
        refused(lambda action=action: setattr(own, "action", action), "The action needs", str(size))
    for poses in ([1, 2], np.zeros((5, 3)), "here"):
        refused(lambda poses=poses: setattr(own, "robots", poses), "robots needs")
    refused(lambda: setattr(own, "objects", np.zeros((2, 5))), "objects needs")
    for seed in (-1, 2**64, 1.5, "one"):
        refused(lambda seed=seed: own.reset(seed), "The seed is a whole number")
    refused(lambda: own.reset(1, 2**32), "The episode is a whole number")


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


def test_robots_inside_each_other_and_steps_after_the_end():
    own = arena.make("predprey", max_steps=1)
    own.robots[1] = 1100, 1500, 0
    refused(own.step, "Robot 0", "another robot")
    own.reset()
    own.step()
    assert own.done and not own.terminated
    own.action[:] = 0.1
    own.step()  # moves on, but the episode stays over
    assert own.done and own.steps == 2 and own.robots[0, 0] > 1000
