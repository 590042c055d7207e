"""Show a robot without a policy: move its joints by sliders, in a film or on a sheet."""

from __future__ import annotations

import difflib
import itertools
import math
import time
from collections.abc import Iterator
from dataclasses import dataclass
from pathlib import Path

import numpy as np

from botschool.envs import bullet
from botschool.envs.locomotor_bodies import BODIES
from botschool.errors import BotschoolError
from botschool.output import check_output, written_whole

SHEET_SUFFIXES = (".png", ".pdf", ".svg")
POSES = 5
"""Pictures of each joint on a sheet, from its lowest to its highest position."""
FPS = 30.0
SWEEP = 2.0
"""Seconds that a film shows each joint."""
PHYSICS_STEP = 1 / 240
YAW, PITCH = 25.0, -40.0
"""Direction of the camera in degrees."""
MOVING, STILL = (0.9, 0.5, 0.1, 1), (0.45, 0.5, 0.6, 1)
"""Colours: red, green, blue, opacity."""
PYBULLETS = {
    "a1": "a1/a1.urdf",
    "aliengo": "aliengo/aliengo.urdf",
    "biped": "biped/biped2d_pybullet.urdf",
    "cartpole": "cartpole.urdf",
    "husky": "husky/husky.urdf",
    "kuka": "kuka_iiwa/model.urdf",
    "laikago": "laikago/laikago_toes.urdf",
    "mini_cheetah": "mini_cheetah/mini_cheetah.urdf",
    "minitaur": "quadruped/minitaur.urdf",
    "panda": "franka_panda/panda.urdf",
    "r2d2": "r2d2.urdf",
    "racecar": "racecar/racecar.urdf",
    "vision60": "quadruped/vision60.urdf",
    "xarm": "xarm/xarm6_robot.urdf",
}
"""Common names of PyBullet's models; its other models go by their files' names."""


@dataclass
class Joint:
    """A joint that moves; radians, or metres where it slides."""

    index: int
    name: str
    low: float
    high: float
    slides: bool

    def written(self, position: float) -> str:
        """Return a position as text for learners."""
        return f"{position:.2f} m" if self.slides else f"{math.degrees(position):.0f} degrees"


class Model:
    """A robot in a physics world of its own, floating where its file puts it."""

    def __init__(self, name: str, window: bool = False) -> None:
        """Load a model; name: see find_model. Raises BotschoolError."""
        path, flags = find_model(name)
        self.name = path.stem
        self.bullet = bullet.import_pybullet()
        self.client = bullet.connect(window)
        try:
            self.robot = bullet.load_model(self.client, path, flags)
            self.joints = self._find_joints(path)
            if not self.joints:
                raise BotschoolError(f"{path} has no joint that moves, so nothing can be shown.")
            self._find_size()
        except BaseException:
            self.close()
            raise
        for joint in self.joints:
            self.bullet.setJointMotorControl2(
                self.robot,
                joint.index,
                self.bullet.VELOCITY_CONTROL,
                force=0,
                physicsClientId=self.client,
            )

    def _find_joints(self, path: Path) -> list[Joint]:
        world, found = {"physicsClientId": self.client}, []
        kinds = (self.bullet.JOINT_REVOLUTE, self.bullet.JOINT_PRISMATIC)
        for i in range(self.bullet.getNumJoints(self.robot, **world)):
            info = self.bullet.getJointInfo(self.robot, i, **world)
            try:
                name, low, high = info[1].decode(), info[8], info[9]
            except UnicodeDecodeError:
                raise BotschoolError(
                    f"{path} has a joint whose name is not UTF-8: rename it, or save the file as "
                    "UTF-8."
                ) from None
            if info[2] not in kinds or name.startswith("ignore"):
                continue
            slides = info[2] == self.bullet.JOINT_PRISMATIC
            if low >= high:  # without limits
                low, high = (-0.5, 0.5) if slides else (-math.pi, math.pi)
            found.append(Joint(i, name, low, high, slides))
        return found

    def _find_size(self) -> None:
        """Find a camera position from which everything in reach of the joints is visible."""
        self.pose()
        self.lowest = float(self._corners()[:, 2].min())
        corners = [self._corners()]
        for joint in self.joints:
            for position in np.linspace(joint.low, joint.high, POSES):
                self.pose(joint, float(position))
                corners.append(self._corners())
        self.pose()
        self.centre, self.distance = bullet.fitting_camera(np.concatenate(corners), YAW, PITCH)

    def _corners(self) -> np.ndarray:
        """Return the corners of the boxes around the links, shape (n, 3), in metres."""
        world = {"physicsClientId": self.client}
        links = range(-1, self.bullet.getNumJoints(self.robot, **world))
        boxes = np.array([self.bullet.getAABB(self.robot, link, **world) for link in links])
        solid = (boxes[:, 0] < boxes[:, 1]).any(axis=1)  # links without a shape have no extent
        boxes = boxes[solid] if solid.any() else boxes
        which = np.array(list(itertools.product((0, 1), repeat=3)))
        return boxes[:, which, np.arange(3)].reshape(-1, 3)

    def pose(self, moved: Joint | None = None, position: float = 0.0) -> None:
        """Put one joint at a position, and all others at 0 or as near as their limits allow."""
        for joint in self.joints:
            rest = min(max(0.0, joint.low), joint.high)
            self.bullet.resetJointState(
                self.robot,
                joint.index,
                position if joint is moved else rest,
                physicsClientId=self.client,
            )

    def picture(self, size: tuple[int, int]) -> np.ndarray:
        """Return a picture, (height, width, 3) uint8; size is width and height."""
        return bullet.picture(self.client, self.centre, self.distance, YAW, PITCH, size)

    def paint(self, moved: Joint) -> None:
        """Paint the limb that a joint moves in one colour, and everything else in another."""
        world, moving = {"physicsClientId": self.client}, {moved.index}
        for i in range(-1, self.bullet.getNumJoints(self.robot, **world)):
            if i >= 0 and self.bullet.getJointInfo(self.robot, i, **world)[16] in moving:
                moving.add(i)
            colour = MOVING if i in moving else STILL
            self.bullet.changeVisualShape(self.robot, i, rgbaColor=colour, **world)

    def close(self) -> None:
        """End the physics world."""
        bullet.disconnect(self.client)


def find_model(name: str) -> tuple[Path, tuple[str, ...]]:
    """Return the file of a robot, and the flags to load it with.

    name: one of the locomotors, balancebot, a model that comes with PyBullet (PYBULLETS, or the
    name of its file), or the path of a .urdf or MuJoCo .xml file. Raises BotschoolError.
    """
    locomotors = {body.lower(): BODIES[body].model for body in BODIES}
    word = name.lower()
    if word in locomotors:
        path = bullet.data_folder() / "mjcf" / f"{locomotors[word]}.xml"
        return path, bullet.SELF_COLLISION
    if word == "balancebot":
        try:
            import balance_bot
        except ImportError:
            raise BotschoolError(
                "the balancing robot is not installed: pip install -e envs/balance_bot."
            ) from None
        return Path(balance_bot.__file__).parent / "balance_bot.urdf", ()
    if Path(name).suffix.lower() in bullet.FORMATS:
        if not Path(name).is_file():
            raise BotschoolError(f"There is no model file {name}.")
        bullet.check_model(Path(name))
        return Path(name), ()
    if path := _of_pybullet(word):
        return path, ()
    known = [*BODIES, "balancebot", *PYBULLETS]
    near = difflib.get_close_matches(word, [robot.lower() for robot in known], n=1)
    hint = f"did you mean {near[0]}?" if near else f"choose from {', '.join(known)}."
    raise BotschoolError(f"There is no robot '{name}' (nor is it a .urdf or .xml file); {hint}")


def list_robots() -> None:
    """Print the robots that botschool showrobot shows by name."""
    print(f"locomotors: {', '.join([*BODIES, 'balancebot'])}")
    print(f"models of PyBullet: {', '.join(PYBULLETS)} (others by their files' names)")
    print("your own: the name of a .urdf or .xml file")
    print("To show one: botschool showrobot hopper; without a display add --sheet hopper.png")


def _of_pybullet(word: str) -> Path | None:
    """Return a model of pybullet_data by its name or its file's name."""
    folder = bullet.data_folder()
    if word in PYBULLETS:
        return folder / PYBULLETS[word]
    found = [
        path
        for path in folder.rglob("*")
        if path.suffix.lower() in bullet.FORMATS and path.stem.lower() == word
    ]
    return min(found, key=lambda path: (len(path.parts), path), default=None)


def show_robot(name: str, video: Path | None, sheet: Path | None) -> None:
    """Write a film or a sheet if asked to, otherwise open PyBullet's window with sliders."""
    if sheet is not None:
        sheet = check_output(sheet, SHEET_SUFFIXES)
    model = Model(name, window=video is None and sheet is None)
    try:
        if video is None and sheet is None:
            _window(model)
            return
        if sheet is not None:
            _sheet(model, sheet)
            print(f"sheet: {sheet}")
        if video is not None:
            from botschool.render.video import write_video

            write_video(video, _sweeps(model), FPS)
            print(f"video: {video}")
    finally:
        model.close()


def _sheet(model: Model, file: Path) -> None:
    """Write a row for every joint: its name and range, and pictures from one end to the other."""
    from matplotlib.figure import Figure

    columns = 2 if len(model.joints) > 6 else 1
    rows = math.ceil(len(model.joints) / columns)
    size = (9.5 * columns, 1.75 * rows + 0.5)
    figure = Figure(figsize=size, layout="constrained")
    figure.suptitle(f"{model.name}: each joint through its range, the others at rest")
    parts = figure.subfigures(rows, columns, squeeze=False, wspace=0.02)
    for part, joint in zip(parts.T.flat, model.joints, strict=False):
        model.paint(joint)
        axes = part.subplots(1, POSES)
        for i, position in enumerate(np.linspace(joint.low, joint.high, POSES)):
            model.pose(joint, float(position))
            axes[i].imshow(model.picture((300, 240)))
            axes[i].set_title(joint.written(position), fontsize=8)
            axes[i].set(xticks=[], yticks=[])
        axes[0].set_ylabel(joint.name, fontsize=10)
    with written_whole(file) as temporary:
        figure.savefig(temporary, dpi=100, format=file.suffix[1:].lower())


def _sweeps(model: Model) -> Iterator[np.ndarray]:
    """Yield frames in which one joint after the other moves through its range."""
    import pygame

    from botschool.render.canvas import draw_offscreen, to_frame, write_text

    draw_offscreen()
    for joint in model.joints:
        model.paint(joint)
        rest = min(max(0.0, joint.low), joint.high)
        middle, half = (joint.low + joint.high) / 2, (joint.high - joint.low) / 2
        start = math.asin((rest - middle) / half)
        for phase in np.linspace(0, 2 * math.pi, round(SWEEP * FPS), endpoint=False):
            position = middle + half * math.sin(start + phase)
            model.pose(joint, position)
            surface = pygame.surfarray.make_surface(model.picture((400, 300)).swapaxes(0, 1))
            write_text(surface, f"{joint.name}: {joint.written(position)}", (10, 8))
            yield to_frame(surface)


def _window(model: Model) -> None:
    """Show PyBullet's window with sliders for joints and gravity, until it is closed."""
    gui, world = model.bullet, {"physicsClientId": model.client}
    gui.configureDebugVisualizer(gui.COV_ENABLE_GUI, 1, **world)
    floor = bullet.load_floor(model.client, bullet.data_folder() / "plane_stadium.sdf")
    gui.resetBasePositionAndOrientation(floor, (0, 0, model.lowest - 0.02), (0, 0, 0, 1), **world)
    gui.resetDebugVisualizerCamera(model.distance, YAW, PITCH, model.centre, **world)
    gui.setTimeStep(PHYSICS_STEP, **world)
    gravity = gui.addUserDebugParameter("gravity (m/s2)", 0, 20, 0, **world)
    sliders = [
        gui.addUserDebugParameter(
            joint.name, joint.low, joint.high, min(max(0.0, joint.low), joint.high), **world
        )
        for joint in model.joints
    ]
    print("Move the sliders; closing the window ends.")
    try:
        while gui.isConnected(**world):
            gui.setGravity(0, 0, -gui.readUserDebugParameter(gravity, **world), **world)
            gui.setJointMotorControlArray(
                model.robot,
                [joint.index for joint in model.joints],
                gui.POSITION_CONTROL,
                targetPositions=[gui.readUserDebugParameter(s, **world) for s in sliders],
                **world,
            )
            gui.stepSimulation(**world)
            time.sleep(PHYSICS_STEP)
    except gui.error:  # the window was closed between two calls
        return
