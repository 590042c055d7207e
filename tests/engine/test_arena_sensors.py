"""What robots sense, against closed forms written a second time; measured tables."""

import math

import numpy as np
import pytest
from hypothesis import given
from hypothesis import strategies as st

from botschool import arena
from botschool.arenas import samples
from botschool.errors import BotschoolError
from reference_arena import off
from reference_network import REPEATABLE
from test_arena import reference, refused

PI = math.pi
NEAR = {"rel": 0, "abs": 1e-9}


def place(own, robot, pose):
    """Puts a robot there; whether it can stand there."""
    own.robots[robot] = pose
    inside = min(pose[:2]) > 0 and max(pose[:2]) < own.width
    return inside and reference(own).bump(robot, *pose[:2]) == ""


def checked(own):
    """The arena's observation, after a comparison with the reference."""
    world, seen = reference(own), own.sense()
    for robot, values in enumerate(np.split(seen, len(own.robots))):
        expected = world.infrared(robot)
        if own.name == "predprey":
            expected += world.camera(robot) + world.ground(robot, own.width, own.height)
            expected += [own.steps / own.max_steps, 1.0]
        assert values == pytest.approx(expected, **NEAR)
    return seen


@pytest.mark.parametrize("name", ["discrim", "predprey"])
def test_random_places_follow_the_reference(name):
    rng = np.random.default_rng(6)
    own = arena.make(name, max_steps=100, noise=0)
    seen, size = [], own.models[0].radius
    while len(seen) < 500:
        for robot in range(len(own.robots)):
            where = own.robots[0, :2] + rng.uniform(-4 * size, 4 * size, 2)
            while not place(own, robot, (*where, rng.uniform(-9, 9))):
                where = rng.uniform(size, own.width - size, 2)
        own.steps = int(rng.integers(100))
        if name == "discrim":
            x, y, _ = own.robots[0]
            own.objects[0, :2] = x + rng.choice([-1, 1]) * rng.uniform(41, 90), y + 30
            own.objects[0, 4] = rng.uniform(5, 13)
        seen.append(checked(own).copy())
    infrared = np.concatenate(
        [part[:, :8] for part in np.split(np.array(seen), len(own.robots), 1)]
    )
    assert np.all((infrared > 0.01).mean(axis=0) > 0.02)
    assert np.any(infrared == 1) == (name == "discrim")


def test_infrared_ends_at_its_range_and_sums_objects():
    own = arena.make("discrim", noise=0)
    own.objects[0, :2] = 50, 50
    for gap, seen in ((44.99, True), (45.01, False)):
        own.robots[0] = 200, 400 - 27.5 - gap, PI / 2
        assert (own.sense().max() > 0) == seen
    alone = []
    for cylinder in ((50, 50), (272, 362)):  # a wall alone, a wall and a cylinder
        own.objects[0, :2] = cylinder
        own.robots[0] = 200, 400 - 27.5 - 25, PI / 4
        alone.append(own.sense().copy())
    own.objects[4 - 1, [1, 3]] = 900  # the upper wall, away: the cylinder alone
    assert alone[1] - alone[0] == pytest.approx(own.sense(), **NEAR)


@REPEATABLE
@given(st.floats(-30, 30), st.floats(171, 1400), st.floats(-PI, PI))
def test_camera_and_apparent_size(heading, distance, direction):
    own = arena.make("predprey")
    own.robots[0] = 1500, 1500, heading
    own.robots[1] = (
        1500 + distance * math.cos(direction), 1500 + distance * math.sin(direction), heading,
    )  # fmt: skip
    seen = own.sense()[8:17]
    expected = [
        max(0, 1 - off(direction - heading, (s + 0.5) * PI / 4) / (PI / 4)) for s in range(8)
    ]
    assert seen[:8] == pytest.approx(expected, **NEAR)
    assert 1 - 1e-9 <= seen[:8].sum() <= 1 + 1e-9
    assert seen[8] == pytest.approx(2 * (PI / 2 - math.atan(distance / 85)), **NEAR)
    # each sees the other
    assert own.observation[24 + 16] == pytest.approx(seen[8], **NEAR)


def test_ground_time_and_bias():
    own = arena.make("predprey", max_steps=8)
    half = math.hypot(1500, 1500)
    own.robots[:] = (1500, 1500, 0.3), (2000, 1500, 0)
    centre, other = np.split(own.sense(), 2)
    assert centre[17:21] == pytest.approx([0.5] * 4, **NEAR)
    assert centre[21] == pytest.approx(0.9 * 85 / half, **NEAR)
    arm, angle = 0.9 * 85, 0.0872
    ahead = math.hypot(500 + arm * math.cos(angle), arm * math.sin(angle)) / half
    behind = math.hypot(500 - arm * math.cos(angle), arm * math.sin(angle)) / half
    mean = (ahead + behind) / 2
    expected = [0.5 + 10 * (x - mean) for x in (ahead, ahead, behind, behind)] + [mean]
    assert other[17:22] == pytest.approx(expected, **NEAR)
    times = []
    while not own.done:
        times.append(own.observation[[22, 46]].tolist())
        own.step()
        assert own.observation[[23, 47]].tolist() == [1, 1]
    assert times == [[t / 8, t / 8] for t in range(8)]


# measured tables

ANGLES, DISTANCES, FIRST, STEP = 12, 3, 5, 10


def table(seed=1):
    return np.random.default_rng(seed).uniform(0, 0.9, (DISTANCES, ANGLES, 8)).round(3)


def text_of(readings, header=f"8 {ANGLES} {DISTANCES} {FIRST} {STEP}", first=0):
    lines = [header]
    for k, rows in enumerate(readings):
        lines.append(f"TURN {k + first}")
        lines += [" ".join(f"{value:g}" for value in row) for row in rows]
    return "\n".join([*lines, "END", ""])


def written(folder, text):
    path = folder / "own.sample"
    path.write_text(text)
    return path


def test_a_robot_reads_from_the_table(tmp_path):
    """The nearest angle and distance; nothing half a step past the last."""
    readings = table()
    path = written(tmp_path, text_of(readings))
    own = arena.make("discrim", noise=0, round_table=path)
    for angle in np.arange(0.3, 360, 7):
        for gap, row in ((0.5, 0), (9.9, 0), (10.1, 1), (19, 1), (27, 2), (29.9, 2), (30.1, None)):
            own.robots[0] = 200, 200, 0.4
            towards = 0.4 + math.radians(angle)
            far = 27.5 + gap + 12.5
            own.objects[0, :2] = 200 + far * math.cos(towards), 200 + far * math.sin(towards)
            expected = np.zeros(8) if row is None else readings[row, round(angle / 30) % ANGLES]
            assert own.sense() == pytest.approx(expected, **NEAR), (angle, gap)


GOOD = text_of(table())
LINES = GOOD.splitlines()


@pytest.mark.parametrize(
    ("text", "words"),
    [
        ("", ["ends where the header"]),
        ("END\n", ["line 1", "five numbers"]),
        (GOOD.replace("8 12 3", "6 12 3"), ["line 1", "8 infrared sensors", "6"]),
        (GOOD.replace("8 12 3", "8 0 3"), ["line 1", "number of angles"]),
        (GOOD.replace("8 12 3", "8 12.5 3"), ["line 1", "number of angles"]),
        (GOOD.replace("8 12 3", "8 12 1e9"), ["line 1", "number of distances"]),
        (GOOD.replace("3 5 10", "3 -5 10"), ["line 1", "negative"]),
        (GOOD.replace("3 5 10", "3 5 0"), ["line 1", "above 0"]),
        (GOOD.replace("3 5 10", "3 5 nan"), ["line 1", "five numbers"]),
        (GOOD.replace("8 12 3", "8 12 4"), ["line 41", "TURN 3", "END"]),
        (GOOD.replace("8 12 3", "8 12 2"), ["line 28", "END", "TURN 2"]),
        (GOOD.replace("8 12 3", "8 13 3"), ["line 15", "8 readings", "TURN 1"]),
        (GOOD.replace("8 12 3", "8 11 3"), ["line 14", "TURN 1"]),
        (GOOD.replace("TURN 1", "TRUN 1"), ["line 15", "TURN 1", "TRUN"]),
        ("\n".join([*LINES[:5], "0 0 0", *LINES[6:]]), ["line 6", "8 readings", "not 3"]),
        ("\n".join([*LINES[:5], "0 0 0 x 0 0 0 0", *LINES[6:]]), ["line 6", "0 to 1023", "x"]),
        ("\n".join([*LINES[:5], "0 0 0 -1 0 0 0 0", *LINES[6:]]), ["line 6", "0 to 1023", "-1"]),
        ("\n".join([*LINES[:5], "0 0 0 2e3 0 0 0 0", *LINES[6:]]), ["line 6", "0 to 1023"]),
        ("\n".join([*LINES[:5], "0 0 0 nan 0 0 0 0", *LINES[6:]]), ["line 6", "0 to 1023"]),
        ("\n".join(LINES[:9]), ["ends where", "8 readings"]),
        ("\n".join(LINES[:-1]), ["ends where END"]),
        (GOOD + "more\n", ["line 42", "follow END", "more"]),
        (GOOD.replace("\n", "\n\n").replace("TURN 2", "TURN two"), ["line 55", "TURN 2"]),
    ],
)
def test_malformed_tables_are_refused(text, words, tmp_path):
    path = written(tmp_path, text)
    refused(lambda: samples.load(path), "own.sample", *words)
    refused(lambda: arena.make("discrim", wall_table=path), *words)


@REPEATABLE
@given(st.text(st.sampled_from("8 1\n0.5TURNENDx-e"), max_size=80))
def test_any_text_is_a_table_or_a_sentence(tmp_path_factory, text):
    path = written(tmp_path_factory.getbasetemp(), text)
    try:
        samples.load(path)
    except BotschoolError as error:
        assert "\n" not in str(error)
