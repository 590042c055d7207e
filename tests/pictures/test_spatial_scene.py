"""Pictures of bodies in space, in films and in pages."""

import json
import shutil
import subprocess
from pathlib import Path

import numpy as np
import pytest

from botschool import _core
from botschool.problems import make
from botschool.render import replay
from botschool.render.scenes import make_scene, scene_of
from botschool.render.space import followed

BODIES = {
    "SpatialAnt-v0": "ant",
    "SpatialAnt-v5": "ant",
    "SpatialHumanoid-v0": "humanoid",
    "SpatialHumanoid-v5": "humanoid",
    "SpatialHumanoidStandup-v0": "humanoidstandup",
    "SpatialBalanceBot-v0": "balancebot",
}
DRAWING = Path(replay.__file__).parent / "replay_space.js"


def at(name, x=0.0, z=None, seed=None):
    """A state of a body at rest; its hinges are turned at random if there is a seed."""
    body = _core.SpatialBody(BODIES[name])
    state = np.zeros(make_scene(name).state_size)
    state[[0, 2, 3]] = x, z or (0.3 if BODIES[name] == "balancebot" else 1.0), 1.0
    if seed is not None:
        rng = np.random.default_rng(seed)
        state[3 : body.coordinates] = rng.normal(size=body.coordinates - 3)
        state[3:7] /= np.linalg.norm(state[3:7])
    return state


@pytest.mark.parametrize("name", BODIES)
def test_a_film_shows_the_body_its_shadow_and_its_way(name):
    scene = make_scene(name)
    frame = scene.draw(at(name))
    assert frame.shape == (408, 720, 3) and frame.dtype == np.uint8
    assert scene.fps == pytest.approx({"Ant": 20, "Hum": 200 / 3, "Bal": 100}[name[7:10]])
    assert (make_scene(name).draw(at(name)) == frame).all()
    aloft = make_scene(name).draw(at(name, z=200.0))  # with its shadow far away
    changed = (aloft.astype(int) - frame).any(axis=2)
    colourful = np.ptp(frame.astype(int), axis=2) > 40
    assert (changed & colourful).sum() > 2000
    shadow = changed & ~colourful & (frame.max(axis=2) < 0.8 * aloft.max(axis=2))
    assert shadow.sum() > 300
    assert (make_scene(name).draw(at(name, x=0.5)) != frame).any(), "marks show where it is"


@pytest.mark.parametrize("options", ["slope=0.3", "step=0.3"])
def test_ground_that_rises_is_drawn_under_the_robot(options):
    """What stands on it looks as on flat ground."""
    scene = scene_of(make("SpatialAnt-v5", options=options))
    x, level = 10.0, make_scene("SpatialAnt-v5").draw(at("SpatialAnt-v5", x=10.0))
    height = 3.0 if options.startswith("slope") else 0.3
    frame = scene.draw(at("SpatialAnt-v5", x=x, z=1.0 + height))
    body = np.ptp(level.astype(int), axis=2) > 40
    assert (frame == level)[body].mean() > 0.99
    assert (frame == level).all() == options.startswith("step"), "far from the step it is flat"


HAMMER = """<robot name="hammer"><link name="head">
  <inertial><mass value="4"/>
    <inertia ixx="0.02" iyy="0.05" izz="0.06" ixy="0" ixz="0" iyz="0"/></inertial>
  <collision><geometry><box size="0.4 0.2 0.1"/></geometry></collision></link>
  <link name="grip"><collision><origin xyz="0 0 -0.1"/>
    <geometry><capsule radius="0.02" length="0.2"/></geometry></collision></link>
  <joint name="neck" type="revolute"><parent link="head"/><child link="grip"/>
    <origin xyz="0.2 0 0"/><axis xyz="0 1 0"/><limit lower="-1" upper="1" effort="20"/></joint>
</robot>"""


def test_a_robot_of_ones_own_is_seen_from_near_and_its_box_is_a_box(tmp_path):
    pytest.importorskip("mujoco")
    (tmp_path / "own.urdf").write_text(HAMMER)
    problem = make("SpatialBody-v0", options=f"urdf='{tmp_path}/own.urdf', seconds=0.04")
    scene = scene_of(problem)
    assert scene.fps == 25 and scene.view[2] < 1
    bars = np.array([limb[1:8] for limb in scene.space.limbs if limb[0] == 0])
    ends, radii = bars[:, :6].reshape(-1, 3), bars[:, 6].repeat(2)[:, None]
    size = (ends + radii).max(axis=0) - (ends - radii).min(axis=0)
    assert size == pytest.approx([0.4, 0.2, 0.1], abs=1e-9)
    state = np.zeros(scene.state_size)
    state[[2, 3]] = 0.2, 1.0
    frame = scene.draw(state)
    assert (np.ptp(frame.astype(int), axis=2) > 40).sum() > 5000
    assert np.ptp(make_scene("SpatialBody-v0").draw(at("SpatialAnt-v5")), axis=2).max() > 40


JAVASCRIPT = """
import { readFileSync } from "fs";
const { space, cases, rows } = JSON.parse(readFileSync(GIVEN));
const numbersAt = (step) => rows[step];
let time = 0;
const answer = cases.map((numbers) => {
  const frames = framesOf(space.links, numbers);
  return space.limbs.map(([link, ...own]) => [own.slice(0, 3), own.slice(3, 6)]
    .map((end) => sum(frames[link].origin, turned(frames[link].axes, end))));
});
const cameras = rows.map((_, i) => { time = i; return followed(wayOf(space)); });
console.log(JSON.stringify({ answer, cameras }));
"""


@pytest.mark.parametrize(
    "name",
    ["SpatialAnt-v5", "SpatialHumanoid-v5", "SpatialHumanoidStandup-v0", "SpatialBalanceBot-v0"],
)
def test_a_page_puts_limbs_and_camera_where_films_do(name, tmp_path):
    if shutil.which("node") is None:
        pytest.skip("no Node found: install nodejs to test pages without a browser")
    scene, body = make_scene(name), _core.SpatialBody(BODIES[name])
    cases = [at(name, x=seed, seed=seed)[: body.coordinates] for seed in range(10)]
    rows = np.random.default_rng(1).normal(size=(90, 2)).cumsum(axis=0)
    given = replay.scene_description(scene) | {
        "cases": [case.tolist() for case in cases],
        "rows": rows.tolist(),
    }
    (tmp_path / "given.json").write_text(json.dumps(given))
    program = DRAWING.read_text() + JAVASCRIPT.replace("GIVEN", f'"{tmp_path}/given.json"')
    (tmp_path / "program.mjs").write_text(program)
    done = subprocess.run(["node", tmp_path / "program.mjs"], capture_output=True, text=True)
    assert done.returncode == 0, done.stderr
    answer = json.loads(done.stdout)
    for case, ends in zip(cases, answer["answer"], strict=True):
        places = body.places(case)
        expected = [
            [
                places[limb[0], 0] + np.array(own) @ places[limb[0], 1:]
                for own in (limb[1:4], limb[4:7])
            ]
            for limb in scene.space.limbs
        ]
        np.testing.assert_allclose(ends, expected, rtol=0, atol=1e-12)
    for i, camera in enumerate(answer["cameras"]):
        window = [rows[max(i - back, 0)] for back in range(scene.memory + 1)]
        np.testing.assert_allclose(camera, followed(np.array(window)), rtol=0, atol=1e-12)
