"""Robots of one's own (docs/robots.md), read by MuJoCo's compiler, beside MuJoCo itself."""

from __future__ import annotations

import gymnasium
import numpy as np
import pytest

import botschool.envs  # noqa: F401 (registers the environments)
from botschool import _core, problems
from botschool.config import PolicyConfig
from botschool.errors import BotschoolError
from botschool.policies.policy import Policy
from botschool.problems import Episodes

mujoco = pytest.importorskip("mujoco")

LEG = """
  <link name="{0}_thigh"><collision><origin xyz="0 0 -0.1"/>
    <geometry><capsule radius="0.02" length="0.2"/></geometry></collision></link>
  <joint name="{0}_hip" type="revolute"><parent link="base"/><child link="{0}_thigh"/>
    <origin xyz="{1} {2} 0" rpy="{3} 0 0"/><axis xyz="0 1 0"/>
    <limit lower="-1" upper="1" effort="20"/><dynamics damping="0.3"/></joint>
  <link name="{0}_shin"><collision><origin xyz="0 0 -0.1"/>
    <geometry><cylinder radius="0.02" length="0.2"/></geometry></collision></link>
  <joint name="{0}_knee" type="continuous"><parent link="{0}_thigh"/><child link="{0}_shin"/>
    <origin xyz="0 0 -0.2"/><axis xyz="0 2 0"/><limit effort="20"/></joint>
  <link name="{0}_foot"><collision>
    <geometry><sphere radius="0.03"/></geometry></collision></link>
  <joint name="{0}_weld" type="fixed"><parent link="{0}_shin"/><child link="{0}_foot"/>
    <origin xyz="0 0 -0.2"/></joint>"""
BASE = """<robot name="own"><link name="base">
  <inertial><mass value="4"/>
    <inertia ixx="0.02" iyy="0.05" izz="0.06" ixy="0.001" ixz="0" iyz="0"/></inertial>
  <collision><geometry><box size="0.4 0.2 0.1"/></geometry></collision></link>"""
URDF = BASE + "".join(
    LEG.format(f"{a}{b}", x, y, tilt)
    for a, x in (("f", 0.2), ("b", -0.2))
    for b, y, tilt in (("l", 0.1, 0.2), ("r", -0.1, -0.2))
) + "\n</robot>"  # fmt: skip

MJCF = """<mujoco><compiler angle="radian"/>
<default><geom density="500"/><joint damping="0.1"/></default>
<worldbody><geom type="plane" size="9 9 1"/>
  <body name="trunk" pos="0 0 1"><freejoint/>
    <geom name="trunk" type="box" size="0.2 0.1 0.05"/>
    <body name="thigh" pos="0.2 0 0" euler="0.1 0 0.3">
      <joint name="roll" axis="1 0 0" range="-0.5 0.5"/>
      <joint name="hip" axis="0.6 0.8 0" range="-1 1"/>
      <geom name="thigh" type="capsule" fromto="0 0 0 0 0 -0.2" size="0.03"/>
      <body name="foot" pos="0 0 -0.2"><geom name="foot" size="0.04"/></body></body>
    <body name="arm" pos="-0.2 0 0.1">
      <joint name="lift" axis="0 0 1" type="slide" range="-0.2 0.2"/>
      <geom name="arm" type="ellipsoid" size="0.05 0.03 0.02"/></body></body>
</worldbody>
<actuator><motor name="roll" joint="roll" gear="7"/><motor name="hip" joint="hip" gear="20"/>
  <motor name="lift" joint="lift" gear="30"/></actuator></mujoco>"""

MOTOR = '<motor name="hip" joint="hip" gear="20"/>'
CHANGES = {
    "as it is": ("", ""),
    "fixed": ("<freejoint/>", ""),
    "armature": ('name="hip" axis', 'armature="0.3" name="hip" axis'),
    "spring with a rest": ('name="hip" axis', 'stiffness="40" springref="0.4" name="hip" axis'),
    "reference": ('name="hip" axis', 'ref="0.2" name="hip" axis'),
    "root that resists": ("<freejoint/>", '<joint type="free" damping="2" armature="0.2"/>'),
    "position servo": (MOTOR, '<position joint="hip" kp="30" kv="2" gear="3" ctrlrange="-2 2.5"/>'),
    "position servo without a range": (MOTOR, '<position joint="hip" kp="30" gear="-1"/>'),
    "velocity servo": (MOTOR, '<velocity joint="hip" kv="4"/>'),
    "limited force": (MOTOR, '<position joint="hip" kp="900" gear="2" forcerange="-3 5"/>'),
}  # fmt: skip


def written(folder, text, name="own.xml"):
    (folder / name).write_text(text)
    return folder / name


def made(path, options=""):
    return problems.make("SpatialBody-v0", options=f"robot='{path}'{options}")


def in_the_air(path):
    """MuJoCo's model of a robot in the air, without limits and dry friction."""
    spec = mujoco.MjSpec.from_file(str(path))
    if path.suffix == ".urdf":
        spec.compiler.fusestatic = False
        spec.worldbody.first_body().add_freejoint()
    model = spec.compile()
    off = mujoco.mjtDisableBit
    model.opt.disableflags |= off.mjDSBL_CONTACT | off.mjDSBL_LIMIT | off.mjDSBL_FRICTIONLOSS
    return model, mujoco.MjData(model)


def controls(model, problem, action):
    """What the actions of a problem are for MuJoCo: from home to the ends of the range."""
    low, home, high = problem.robot.controls.T
    return home + np.where(action > 0, action * (high - home), action * (home - low))


def compare(path, rounds=20):
    problem = made(path)
    body = _core.SpatialBody(problem.race)
    model, data = in_the_air(path)
    fixed, rng = problem.robot.fixed, np.random.default_rng(1)
    links = len(problem.robot.names)
    for _ in range(rounds):
        position, speed = np.zeros(links + 6), rng.normal(0, 2, links + 5)
        position[:7] = 0, 0, 1, *rng.normal(size=4)
        position[3:7] /= np.linalg.norm(position[3:7])
        position[7:] = problem.robot.pose[4:] + rng.uniform(-0.5, 0.5, links - 1)
        if fixed:
            position[:7], speed[:6] = (0, 0, 0, 1, 0, 0, 0), 0
        action = rng.uniform(-1, 1, problem.robot.motors)
        data.qpos[:], data.qvel[:] = position[7 * fixed :], speed[6 * fixed :]
        if model.nu:
            data.ctrl[:] = controls(model, problem, action)
        else:
            data.qfrc_applied[6:] = 20 * action
        mujoco.mj_forward(model, data)
        found = body.accelerations(position, speed, action)[6 * fixed :]
        assert found == pytest.approx(data.qacc, rel=1e-9, abs=1e-9)


@pytest.mark.parametrize("change", CHANGES)
def test_a_robot_moves_as_in_mujoco(tmp_path, change):
    old, new = CHANGES[change]
    assert old in MJCF
    compare(written(tmp_path, MJCF.replace(old, new)))


def test_a_robot_of_a_urdf_file_moves_as_in_mujoco(tmp_path):
    path = written(tmp_path, URDF, "own.urdf")
    compare(path)
    table = _core.SpatialBody(made(path).race).table
    assert [link["name"] for link in table["links"]][:3] == ["base", "fl_hip", "fl_knee"]
    assert table["motors"] == 8


REFUSED = {
    "a tendon": ("</worldbody>", '</worldbody><tendon><fixed name="cord" stiffness="3">'
                 '<joint joint="hip" coef="1"/></fixed></tendon>', "tendon 'cord'"),
    "a loop": ("</worldbody>", '</worldbody><equality><connect name="weld" body1="foot" '
               'body2="arm" anchor="0 0 0"/></equality>', "equality 'weld'"),
    "a ball": ('name="hip" axis="0.6 0.8 0" range="-1 1"', 'name="hip" type="ball"', "ball joint"),
    "a muscle": (MOTOR, '<muscle name="calf" joint="hip"/>',
                 "actuator 'calf'"),
    "two motors": ("</actuator>", '<motor joint="hip"/></actuator>', "two actuators on joint"),
    "two robots": ("</worldbody>", '<body name="twin"><freejoint/><geom size="1"/></body>'
                   "</worldbody>", "a body 'twin' beside its robot"),
    "no mass": ('size="0.04"', 'size="0.04" mass="-1"', "refused by MuJoCo: .*mass"),
}  # fmt: skip


@pytest.mark.parametrize("what", REFUSED)
def test_what_a_race_cannot_have_is_named(tmp_path, what):
    old, new, says = REFUSED[what]
    assert old in MJCF
    path = written(tmp_path, MJCF.replace(old, new))
    with pytest.raises(BotschoolError, match=rf"own\.xml .*{says}"):
        made(path)


WRONG = {
    "an sdf": ("<robot ", "<sdf ", "</robot>", "</sdf>", "begins with <sdf>"),
    "a xacro": ('name="own"', 'name="own" xmlns:xacro="x"', "", "", "xacro .* > robot.urdf"),
    "a mimic": ('<axis xyz="0 2 0"/>', '<axis xyz="0 2 0"/><mimic joint="fl_hip"/>', "", "",
                "joint 'fl_knee' that mimics"),
    "two parents": ('<child link="fl_foot"/>', '<child link="fr_foot"/>', "", "",
                    "multiple parents"),
    "a name twice": ('<link name="fl_foot">', '<link name="fr_foot">', "", "", "repeated"),
    "an impossible inertia": ('ixx="0.02"', 'ixx="-0.02"', "", "", "positive eigenvalues"),
    "no file": ('<sphere radius="0.03"/>', '<mesh filename="package://a/b.stl"/>', "", "", "b.stl"),
}  # fmt: skip


@pytest.mark.parametrize("what", WRONG)
def test_a_wrong_urdf_file_is_refused(tmp_path, what):
    old, new, end, other, says = WRONG[what]
    assert old in URDF
    path = written(tmp_path, URDF.replace(old, new).replace(end or "</robot>", other or "</robot>"))
    with pytest.raises(BotschoolError, match=rf"own\.xml .*{says}"):
        made(path)


def test_gazebos_blocks_and_missing_products_of_inertia_are_no_matter(tmp_path):
    plain = written(tmp_path, URDF, "plain.urdf")
    text = URDF.replace("</robot>", "<gazebo><link name='x'/><joint name='y'/></gazebo></robot>")
    other = written(tmp_path, text.replace('ixz="0" iyz="0"', ""), "other.urdf")
    assert made(plain).robot.digest == made(other).robot.digest


def at_the_start(path, options=""):
    """The places of a robot's points of contact above the ground at the start, and its problem."""
    problem = made(path, f", noise=0{options}")
    body = _core.SpatialBody(problem.race)
    stepper = _core.make_stepper("SpatialBody-v0")
    stepper.set(1000, problem.race)
    stepper.start(1)
    places = body.places(stepper.state[: body.coordinates])
    rows = [(places[link][0] + np.array(at) @ places[link][1:])[2] - radius
            for link, at, radius, _ in body.table["balls"]]  # fmt: skip
    return np.array(rows), problem, stepper


@pytest.mark.parametrize("bent", ["", "keyframe", "limits"])
def test_a_robot_stands_on_the_ground_by_the_pose_that_it_has(tmp_path, bent):
    text = MJCF
    if bent == "keyframe":
        key = '<keyframe><key qpos="1 2 9 0.9 0.1 0 0 0.2 0.5 0.1"/></keyframe></mujoco>'
        text = text.replace("</mujoco>", key)
    if bent == "limits":
        text = text.replace('range="-1 1"', 'range="0.6 1.4"')
    heights, problem, stepper = at_the_start(written(tmp_path, text))
    assert heights.min() == pytest.approx(0, abs=1e-9)
    angles = {"": [0, 0, 0], "keyframe": [0.2, 0.5, 0.1], "limits": [0, 1, 0]}[bent]
    assert stepper.state[7:10] == pytest.approx(angles)
    assert problem.robot.pose[4:] == pytest.approx(angles)


def test_a_flat_cylinder_is_a_disc_and_one_on_its_axle_a_wheel(tmp_path):
    text = URDF.replace('<box size="0.4 0.2 0.1"/>', '<cylinder radius="0.2" length="0.1"/>')
    table = _core.SpatialBody(made(written(tmp_path, text, "disc.urdf")).race).table
    rim = [np.hypot(*at[:2]) for link, at, radius, _ in table["balls"] if link == 0 and not radius]
    assert rim == pytest.approx([0.2] * 16)
    turned = MJCF.replace(
        '<geom name="foot" size="0.04"/>',
        '<joint name="roll2" axis="0 1 0"/>'
        '<geom name="foot" type="cylinder" size="0.1 0.02" zaxis="0 1 0"/>',
    )
    table = _core.SpatialBody(made(written(tmp_path, turned)).race).table
    wheels = [ball for ball in table["balls"] if ball[3] == "foot"]
    assert [(ball[0], ball[2]) for ball in wheels] == [(3, 0.1)]


def test_shapes_touch_each_other_where_mujoco_says_so(tmp_path):
    below = MJCF.replace('type="ellipsoid" size="0.05 0.03 0.02"', 'size="0.3"')
    assert len(made(written(tmp_path, below)).robot.pairs) == 2  # with thigh and foot
    apart = below.replace('name="arm" size', 'name="arm" contype="2" conaffinity="2" size')
    assert len(made(written(tmp_path, apart)).robot.pairs) == 0
    out = '<contact><exclude body1="arm" body2="thigh"/></contact></mujoco>'
    assert len(made(written(tmp_path, below.replace("</mujoco>", out))).robot.pairs) == 1


def advanced(path, action, steps, options="", h=0.002):
    """Coordinates and speeds of a fixed robot's joints after some substeps from the start."""
    problem = made(path, options)
    body = _core.SpatialBody(problem.race)
    state = np.zeros(body.size)
    state[3 : body.coordinates] = problem.robot.pose
    state = body.advance(state, np.array(action, float), h, steps)
    n = body.coordinates
    return state[7:n], state[n + 6 : n + body.speeds]


FIXED = MJCF.replace("<freejoint/>", "").replace('density="500"', 'density="500" contype="0"')


@pytest.mark.parametrize("gains", ['kp="40" kv="2"', 'kp="90000" kv="9000"'])
def test_a_position_servo_goes_where_it_is_told(tmp_path, gains):
    """Also one that is far too stiff for the substep."""
    hip = f'<position joint="hip" {gains} ctrlrange="-0.8 0.8"/>'
    text = FIXED.replace(MOTOR, hip)
    angles, rates = advanced(written(tmp_path, text), [0, 0.5, 0], 2000)
    assert angles[1] == pytest.approx(0.4, abs=0.1) and abs(rates[1]) < 1e-3
    angles, _ = advanced(written(tmp_path, text), [0, 0.5, 0], 2000, ", reach=0.1")
    assert angles[1] == pytest.approx(0.05, abs=0.1)


def test_a_servos_force_is_limited(tmp_path):
    """The speed after a substep is that of the largest force, whatever the gain."""
    speeds = []
    for gains in ('kp="900" forcerange="-2 2"', 'kp="1e6" kv="1e4" forcerange="-2 2"'):
        hip = f'<position joint="hip" {gains} ctrlrange="-0.8 0.8"/>'
        text = FIXED.replace(MOTOR, hip)
        speeds.append(advanced(written(tmp_path, text), [0, 1, 0], 5)[1][1])
    assert speeds[0] > 0.1 and speeds[1] == pytest.approx(speeds[0], rel=0.02)


def test_a_velocity_servo_keeps_its_speed_and_dry_friction_stops_a_joint(tmp_path):
    hip = '<velocity joint="hip" kv="50" ctrlrange="-4 4"/>'
    text = FIXED.replace(MOTOR, hip)
    text = text.replace(' range="-1 1"', "")
    _, rates = advanced(written(tmp_path, text), [0, 1, 0], 500)
    assert rates[1] == pytest.approx(4, rel=0.05)
    stuck = FIXED.replace('name="hip" axis', 'frictionloss="9" name="hip" axis')
    angles, _ = advanced(written(tmp_path, stuck), [0, 0.3, 0], 250)
    loose, _ = advanced(written(tmp_path, stuck), [0, 1, 0], 250)
    assert abs(angles[1]) < 0.01 < 0.3 < loose[1]


def test_limits_answer_as_mujocos(tmp_path):
    """A motor drives its hinge beyond the limit, as far as in MuJoCo, and is held there."""
    path = written(tmp_path, FIXED)
    model = mujoco.MjModel.from_xml_path(str(path))
    data = mujoco.MjData(model)
    data.ctrl[:] = 0, 0.4, 0
    for steps in (200, 1000):
        for _ in range(steps - round(data.time / 0.002)):
            mujoco.mj_step(model, data)
        angles, _ = advanced(path, [0, 0.4, 0], steps)
        assert 1 < data.qpos[1] == pytest.approx(angles[1], abs=0.02)


def evaluated(path, options="", instruction_set="", workers=1, candidates=20):
    problem = problems.native.NativeProblem(
        "SpatialBody-v0", instruction_set=instruction_set, options=f"robot='{path}'{options}"
    )
    policy = Policy(problem.name, problem.interface, PolicyConfig(nhiddens=5, bias=1))
    genotypes = np.array([policy.initial(seed) for seed in range(candidates)])
    episodes = Episodes.of(np.arange(candidates), 2)
    return problem.evaluate(policy, genotypes, None, episodes, 60, workers)


DISCS = "".join(
    f'<body pos="0 0 {0.2 + 0.1 * i}"><joint name="j{i}" axis="1 0 0" stiffness="1"/>'
    '<geom type="cylinder" size="0.05 0.03"/></body>'
    for i in range(14)
)
CROWD = MJCF.replace("</body></body>\n</worldbody>", f"</body>{DISCS}</body></worldbody>")


def test_a_robot_of_many_points_has_the_same_bits_everywhere(tmp_path):
    """With servos, pairs, a slide and 250 points; in groups of 1 and of many lanes."""
    text = CROWD.replace(MOTOR,
                         '<position joint="hip" kp="300" forcerange="-9 9"/>')  # fmt: skip
    path = written(tmp_path, text.replace('type="ellipsoid" size="0.05 0.03 0.02"', 'size="0.2"'))
    problem = made(path)
    assert len(_core.SpatialBody(problem.race).table["balls"]) > 230
    options = ", noise=0.1, vary='ground, mass, motors, delay, noise'"
    first = evaluated(path, options)
    assert len(set(first.fitness)) > 30
    for instruction_set in _core.instruction_sets():
        other = evaluated(path, options, instruction_set, 2)
        assert other.fitness.tobytes() == first.fitness.tobytes()
    alone = evaluated(path, options, candidates=1)
    assert alone.fitness.tobytes() == first.fitness[:2].tobytes()


def test_too_many_points_are_told(tmp_path):
    path = written(tmp_path, CROWD.replace(DISCS, DISCS + DISCS.replace('"j', '"k')))
    with pytest.raises(BotschoolError, match="no more than 256 points"):
        made(path)


def test_gymnasium_has_a_robot_of_ones_own(tmp_path):
    path = written(tmp_path, MJCF)
    env = gymnasium.make("botschool/SpatialBody-v0", options=f"robot='{path}'")
    seen, _ = env.reset(seed=1)
    assert seen.shape == env.observation_space.shape == (17,) and env.action_space.shape == (3,)
    fixed = gymnasium.make(
        "botschool/SpatialBody-v0", options=f"robot='{written(tmp_path, FIXED)}'"
    )
    seen, _ = fixed.reset(seed=1)
    assert seen.shape == (6,)


def test_what_evolution_would_exploit_is_told(tmp_path, capsys):
    strong = written(tmp_path, URDF.replace('effort="20"', 'effort="10000"'), "own.urdf")
    made(strong)
    assert "up to 10000 N m" in capsys.readouterr().err
    light = MJCF.replace('name="arm" type', 'name="arm" mass="1e-7" type')
    made(written(tmp_path, light))
    assert "moves only 1e-07 kg" in capsys.readouterr().err


EXPERIMENT = """[EXP]
environment = SpatialBody-v0
algo = ARS
options = robot='own.xml', noise=0
[POLICY]
maxsteps = 5
nhiddens = 0
[ALGO]
maxmsteps = 0.001
samplesize = 2
"""


@pytest.mark.slow
def test_a_run_keeps_its_robot(tmp_path, command, refused):
    """It plays and goes on without the file, and not with another robot."""
    written(tmp_path, EXPERIMENT, "own.ini")
    path = written(tmp_path, MJCF)
    run = "es", "-f", tmp_path / "own.ini", "-s", 1, "-o", tmp_path / "run"
    assert command(*run, "--steps", 100)[0] == 0
    path.rename(tmp_path / "away.xml")
    genotype = tmp_path / "run" / "bestgS1.npy"
    code, said, _ = command(*run[:-2], "-p", "-g", genotype)
    assert code == 0 and "fitness" in said
    assert command(*run, "--resume", "--steps", 200)[0] == 0
    written(tmp_path, MJCF.replace('range="-1 1"', 'range="-1 1.01"'))
    refused(*run, "--resume", says=["own.xml is another robot than that of the run"])
