"""Plans of declared arenas: what they are in files and in Python, and what cannot be."""

import dataclasses

import pytest
from hypothesis import given
from hypothesis import strategies as st

from botschool import arena, config, problems
from botschool.arenas.plan import Cylinder, Light, Plan, Robot, Wall, Zone
from botschool.arenas.section import ArenaConfig
from botschool.errors import BotschoolError
from reference_network import REPEATABLE
from running import write_experiment
from test_arena import refused

TEXT = """
[ARENA]
width    = 500
robot1   = e-puck, x 100 to 300, y 200
robot2   = marxbot, x 400, y 100, heading 90, speed 100
wall1    = x 0, y 350, x2 200, y2 350
cylinder1 = x 100, y 50, radius 20
light1   = x 350
zone1    = x 100, y 300, radius 60, shade 0.5
sensors  = infrared, Light
reward   = near-light
"""
PLAN = Plan(
    width=500,
    robots=[Robot("e-puck", x=(100, 300), y=200), Robot("marXbot", 400, 100, 90, 100)],
    walls=[Wall(0, 350, 200, 350)],
    cylinders=[Cylinder(100, 50, 20)],
    lights=[Light(x=350)],
    zones=["x 100, y 300, radius 60, shade 0.5"],
    sensors=["infrared", "light"],
    reward="near-light",
)


def file_of(folder, text):
    path = write_experiment(folder, "ErArena", policy={"nrobots": 1 + ("robot2" in text)})
    path.write_text(path.read_text() + text)
    return path


def test_a_file_declares_what_python_declares(tmp_path):
    experiment = config.load(file_of(tmp_path, TEXT))
    assert experiment.plan == PLAN
    assert config.from_dict(config.to_dict(experiment)) == experiment
    assert problems.of(experiment).interface.observations == 16
    assert problems.of(experiment).robots[1].speed == 100


def test_without_a_section_there_is_one_khepera(tmp_path):
    experiment = config.load(file_of(tmp_path, ""))
    assert experiment.plan == Plan() == Plan(robots=[Robot("Khepera")])
    assert [model.name for model in problems.make("ErArena").robots] == ["Khepera"]


NUMBERS = st.one_of(st.integers(0, 400), st.floats(0, 400))
RANGES = st.one_of(
    st.none(), NUMBERS.map(float), st.tuples(NUMBERS, NUMBERS).map(lambda p: tuple(sorted(p)))
)


@REPEATABLE
@given(RANGES, RANGES, RANGES, NUMBERS)
def test_texts_of_things_are_read_back(x, y, heading, number):
    things = [Robot("e-puck", x, y, heading, number), Light(x, y), Wall(number, 1, 2, 3)]
    things += [Cylinder(x, y, number + 1), Zone(x, y, number + 1, number / 400)]
    for thing in things:
        assert type(thing).read(thing.text()) == thing


BAD = [
    ("robot1 = Khepera, x 10, y 100", 1, ["robot1 stands outside", "27.5 to 372.5"]),
    ("robot1 = Khepera, x 30 to 380", 1, ["robot1 stands outside", "x is 30 to 380"]),
    ("wall1 = x 100, y 0, x2 100, y2 300\nrobot1 = Khepera, x 100, y 200", 2, ["inside wall1"]),
    ("cylinder1 = x 200, y 200\nrobot1 = e-puck, x 200, y 240", 2, ["robot1 stands inside cylin"]),
    ("robot1 = e-puck, x 200, y 200\nrobot2 = e-puck, x 200, y 240", 2, ["robot2 stands inside"]),
    ("cylinder1 = radius 190\ncylinder2 = radius 150", 2, ["not enough room for cylinder2"]),
    ("robot1 = Kepera", 1, ["no robot 'Kepera'", "did you mean Khepera?"]),
    ("sensors = infrared, lihgt", 1, ["no sensor 'lihgt'", "did you mean light?"]),
    ("sensors = laser, laser", 1, ["laser is named twice"]),
    ("reward = near-ligth", 1, ["did you mean near-light?"]),
    ("reward = near-light", 1, ["reward near-light needs a light", "light1 ="]),
    ("sensors = ground", 1, ["sensor ground needs a zone"]),
    ("sensors = camera", 1, ["camera is for two robots"]),
    ("reward = together", 1, ["together is for two robots"]),
    ("robot1 = e-puck\nrobot2 = e-puck\nzone1 = x 1\nzone2 = x 2\nzone3 = x 3\nreward = every-zone",
     6, ["3 zones and 2 robots"]),
    ("cylinder9 = x 1", 1, ["cylinder1 to cylinder8"]),
    ("robots = Khepera", 1, ["write robot1"]),
    ("wall2 = x 0, y 0, x2 10, y2 10", 1, ["no wall1"]),
    ("wall1 = x 3, y 4", 1, ["wall1: x2 is missing"]),
    ("wall1 = x 3, y 4, x2 3, y2 4", 1, ["wall1 has no length"]),
    ("light1 = x 900", 1, ["light1 stands outside"]),
    ("robot1 = Khepera, x 300 to 100", 1, ["robot1: x 300 to 100 goes from high to low"]),
    ("robot1 = Khepera, z 3", 1, ["z 3 is unknown", "heading"]),
    ("robot1 = Khepera, x three", 1, ["x three is not a number"]),
    ("zone1 = shade 2", 1, ["shade must be 0 to 1, but is 2"]),
    ("cylinder1 = radius 0", 1, ["radius must be above 0"]),
    ("laser_beams = 33", 1, ["laser_beams = 33", "1 to 32"]),
    ("noise = -1", 1, ["noise = -1"]),
    ("width = wide", 1, ["width = wide is not a number"]),
    ("colisions = end", 1, ["did you mean collisions?"]),
    ("nhiddens = 3", 1, ["belongs in section [POLICY]"]),
]  # fmt: skip


@pytest.mark.parametrize(("text", "line", "says"), BAD)
def test_what_cannot_be_is_refused_with_its_line(text, line, says, tmp_path, refused):
    path = file_of(tmp_path, f"\n[ARENA]\n{text}\n")
    before = path.read_text().count("\n") - text.count("\n") - 1
    refused("es", "-f", path, "-o", tmp_path, says=[f"own.ini, line {before + line}:", *says])
    assert [file.name for file in tmp_path.iterdir()] == ["own.ini"]


def test_what_python_cannot_declare():
    refused_ = [
        (lambda: Plan(robots=[Robot(x=5)]), "robot1 stands outside"),
        (lambda: Plan(robots=["Khepera"] * 5), "at most 4 robots"),
        (lambda: Plan(walls=[(1, 2, 3, 4)]), "wall1"),
        (lambda: Plan(width=float("nan")), "width is a number"),
        (lambda: Plan(steps=1.5), "steps is a whole number"),
        (lambda: Plan(reward="wealth"), "no reward 'wealth'"),
        (lambda: Plan(sensors=()), "no sensor ''"),
        (lambda: Robot("Kepera"), "did you mean Khepera?"),
        (lambda: Robot(x="far"), "x = far is not a number"),
        (lambda: Robot(x=(1, 2, 3)), "is not a number"),
        (lambda: arena.make(Plan(), models="e-puck"), "takes its robots from its plan"),
        (lambda: problems.make("CartPole-v1", plan=Plan()), "CartPole-v1 takes no plan"),
    ]
    for call, words in refused_:
        refused(call, words)


def test_every_field_of_a_plan_is_a_key_of_the_section():
    keys = {field.name for field in dataclasses.fields(ArenaConfig)}
    for field in dataclasses.fields(Plan):
        assert field.name in keys or f"{field.name[:-1]}1" in keys
    with pytest.raises(BotschoolError):
        Plan.of(ArenaConfig(zone2="x 3"))
