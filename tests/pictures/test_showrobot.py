"""showrobot: which robot, its joints, the sheet, the film, the errors."""

import sys

import imageio.v3 as iio
import numpy as np
import pytest

pytest.importorskip("pybullet")

from botschool.envs import showrobot
from botschool.envs.showrobot import Model, find_model, show_robot
from botschool.errors import BotschoolError

ARM = """<robot name="arm">
  <link name="base"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"
    ixy="0" ixz="0" iyz="0"/></inertial><visual><geometry><box size=".2 .2 .1"/></geometry></visual>
  </link>
  <link name="tip"><inertial><mass value="1"/><inertia ixx="1" iyy="1" izz="1"
    ixy="0" ixz="0" iyz="0"/></inertial><visual><origin xyz="0 0 .3"/><geometry>
    <box size=".1 .1 .6"/></geometry></visual><collision><origin xyz="0 0 .3"/><geometry>
    <box size=".1 .1 .6"/></geometry></collision></link>
  <joint name="elbow" type="revolute"><parent link="base"/><child link="tip"/>
    <axis xyz="1 0 0"/><limit lower="-0.5" upper="1" effort="1" velocity="1"/></joint>
</robot>"""


@pytest.fixture
def arm(tmp_path):
    path = tmp_path / "arm.urdf"
    path.write_text(ARM)
    return path


@pytest.mark.parametrize("name, joints", [("Hopper", 3), ("halfcheetah", 6), ("humanoid", 17)])
def test_locomotors_have_the_joints_of_their_actions(name, joints):
    model = Model(name)
    assert len(model.joints) == joints
    assert all(joint.low < joint.high for joint in model.joints)
    model.close()


def test_a_joint_is_put_where_it_is_told(arm):
    model = Model(str(arm))
    (joint,) = model.joints
    assert (joint.name, joint.low, joint.high) == ("elbow", -0.5, 1.0)
    first = model.picture((80, 60))
    model.pose(joint, 0.8)
    state = model.bullet.getJointState(model.robot, joint.index, physicsClientId=model.client)
    assert state[0] == pytest.approx(0.8)
    assert (model.picture((80, 60)) != first).any()
    model.close()


@pytest.mark.slow
def test_sheet_and_film(arm, tmp_path, capsys, monkeypatch):
    monkeypatch.setattr(showrobot, "SWEEP", 0.3)
    show_robot(str(arm), tmp_path / "arm.mp4", tmp_path / "arm.png")
    assert "sheet: " in capsys.readouterr().out
    sheet = iio.imread(tmp_path / "arm.png")
    assert sheet.shape[1] > sheet.shape[0] > 100
    frames = iio.imread(tmp_path / "arm.mp4")
    assert len(frames) == 9
    assert np.abs(frames[0].astype(int) - frames[3]).max() > 50


@pytest.mark.parametrize("name, joints", [("minitaur", 16), ("KUKA", 7), ("r2d2", 8)])
def test_models_of_pybullet_by_name(name, joints):
    model = Model(name)
    assert len(model.joints) == joints
    model.close()


@pytest.mark.parametrize(
    "name, words",
    [
        ("hoper", "did you mean hopper"),
        ("zzz", "choose from Hopper"),
        ("nothing.urdf", "no model file nothing.urdf"),
    ],
)
def test_unknown_robots(name, words):
    with pytest.raises(BotschoolError, match=words):
        find_model(name)


def test_a_file_that_crashes_pybullet_says_so(tmp_path, refused):
    """A joint without a child: PyBullet ends the process that loads it."""
    path = tmp_path / "arm.urdf"
    path.write_text(ARM.replace("<child link=", "<child lijk=", 1))
    refused("showrobot", path, "--sheet", tmp_path / "a.png", says=["arm.urdf", "PyBullet crashes"])


def test_without_a_display(monkeypatch, refused):
    if sys.platform != "linux":
        pytest.skip("elsewhere there is a display")
    monkeypatch.delenv("DISPLAY", raising=False)
    refused("showrobot", "hopper", says="display")
