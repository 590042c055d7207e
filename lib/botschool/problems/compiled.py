"""Read robots by MuJoCo's own compiler, as tables of links for races in space."""

from __future__ import annotations

import re
from pathlib import Path
from typing import Any
from xml.etree import ElementTree

import numpy as np

from botschool.errors import BotschoolError
from botschool.problems.forms import Forms
from botschool.problems.robot import LINK, Robot

EFFORT = 10.0
"""Of a joint of a URDF file without <limit effort=...>, N m."""
FAST = 10.0
"""Largest speed that an action asks of a velocity servo without a range, rad/s or m/s."""
UNLIMITED = 1e6
"""Range of a joint without limits, and of a servo's force."""
FIRM = 8000.0
"""N/m of the ground for each kg of the robot."""


def read(path: Path, reach: float) -> Robot:
    """Return the robot of an MJCF or URDF file.

    reach: how far an action of 1 takes the target of a position servo, if its range is not less.
    Raises BotschoolError, also where MuJoCo is not installed.
    """
    try:
        import mujoco
    except ImportError:
        raise BotschoolError(
            f"{path} needs MuJoCo's compiler: pip install mujoco, or give the robotS1.npz of a run."
        ) from None
    root = _parsed(path)
    efforts: dict[str, float] | None = None
    try:
        if root.tag == "robot":
            efforts = _prepare(root, path)
            spec = mujoco.MjSpec.from_string(ElementTree.tostring(root, encoding="unicode"))
            spec.compiler.fusestatic = False
            base = spec.worldbody.first_body()
            if base is not None and root.find("link[@name='world']") is None:
                base.add_freejoint()
        else:
            spec = mujoco.MjSpec.from_file(str(path))
        model = spec.compile()
    except ValueError as error:
        lines = [line.strip().rstrip(".:,") for line in str(error).splitlines() if line.strip()]
        raise BotschoolError(f"{path} is refused by MuJoCo: {', '.join(lines)}.") from None
    return _Reader(mujoco, model, path, efforts, reach).robot()


def _parsed(path: Path) -> ElementTree.Element:
    try:
        text = path.read_text(encoding="utf-8", errors="replace")
        root = ElementTree.fromstring(text)
    except OSError as error:
        raise BotschoolError(f"{path} cannot be read: {error.strerror}.") from None
    except ElementTree.ParseError as error:
        raise BotschoolError(f"{path} is no XML file: {error}.") from None
    if re.search(r"<\s*xacro:|xmlns:xacro|\$\{", text):
        raise BotschoolError(f"{path} is a xacro: expand it by xacro {path} > robot.urdf.")
    if root.tag not in ("mujoco", "robot"):
        raise BotschoolError(
            f"{path} is no robot that can be read: it begins with <{root.tag}>, MJCF with <mujoco> "
            "and URDF with <robot>."
        )
    return root


def _prepare(root: ElementTree.Element, path: Path) -> dict[str, float]:
    """Make a URDF file what MuJoCo expects; return the effort of each joint, NaN if it has none."""
    for tag in ("gazebo", "transmission", "ros2_control"):
        for element in root.findall(tag):
            root.remove(element)
    efforts = {}
    for joint in root.findall("joint"):
        name, limit = joint.get("name", ""), joint.find("limit")
        if joint.find("mimic") is not None:
            raise BotschoolError(f"{path} has a joint '{name}' that mimics another: leave it out.")
        try:
            efforts[name] = float("nan" if limit is None else limit.get("effort", "nan"))
        except ValueError:
            raise BotschoolError(f"{path} has a joint '{name}' with a wrong effort.") from None
    for link in root.findall("link"):
        for inertia in link.iter("inertia"):
            inertia.attrib |= {key: inertia.get(key, "0") for key in ("ixy", "ixz", "iyz")}
        for visual in link.findall("visual") if link.find("collision") is None else ():
            if visual.find("geometry/mesh") is None:
                visual.tag = "collision"
    for mesh in root.iter("mesh"):
        mesh.set("filename", _mesh_file(mesh.get("filename", ""), path))
    own = root.find("mujoco")
    own = ElementTree.SubElement(root, "mujoco") if own is None else own
    compiler = own.find("compiler")
    compiler = ElementTree.SubElement(own, "compiler") if compiler is None else compiler
    compiler.attrib |= {"strippath": "false", "fusestatic": "false", "discardvisual": "true"}
    return efforts


def _mesh_file(name: str, path: Path) -> str:
    """Return where the mesh of a URDF file lies: package://robot/meshes/a.stl is found above it."""
    bare = re.sub(r"^(package|file|model)://", "", name).lstrip("/")
    for folder in path.resolve().parents:
        for part in (bare, bare.partition("/")[2]):
            if part and (folder / part).is_file():
                return str(folder / part)
    return name


class _Reader:
    """Turns a model of MuJoCo into tables. All places are those where qpos is 0."""

    def __init__(
        self, mujoco: Any, model: Any, path: Path, efforts: dict[str, float] | None, reach: float
    ) -> None:
        self.mujoco, self.model, self.path, self.reach = mujoco, model, path, reach
        self._check()
        kinds, free = model.jnt_type, int(mujoco.mjtJoint.mjJNT_FREE)
        roots = [int(model.jnt_bodyid[j]) for j in range(model.njnt) if kinds[j] == free]
        self.fixed, self.root = not roots, roots[0] if roots else 0
        self.joints = [j for j in range(model.njnt) if kinds[j] != free]
        for b in [*roots[1:], *(model.jnt_bodyid[j] for j in self.joints)]:
            if roots and model.body_rootid[b] != self.root:
                raise self._error(f"has a body '{model.body(b).name}' beside its robot that moves")
        self.start = self._pose()
        self.motors = self._efforts(efforts) if model.nu == 0 and efforts else self._drives()
        if not self.motors:
            raise self._error(
                "has no motor: give a joint an <actuator>, or in URDF a <limit effort=...> above 0"
            )
        zero = np.zeros(model.nq)
        zero[3 : 0 if self.fixed else 4] = 1.0
        self.data = self._placed(zero)

    def _error(self, what: str) -> BotschoolError:
        return BotschoolError(f"{self.path} {what}.")

    def _check(self) -> None:
        """Raise an error that names the first element that a race cannot have."""
        m, mj = self.model, self.mujoco
        kinds = mj.mjtObj
        plain = (int(mj.mjtTrn.mjTRN_JOINT), int(mj.mjtTrn.mjTRN_JOINTINPARENT))
        simple = (int(mj.mjtBias.mjBIAS_NONE), int(mj.mjtBias.mjBIAS_AFFINE))
        strings = (m.tendon_limited, m.tendon_stiffness, m.tendon_damping, m.tendon_frictionloss)
        wrong = [
            *((kinds.mjOBJ_JOINT, j, "a ball joint", "write three hinges in its place")
              for j in range(m.njnt) if m.jnt_type[j] == int(mj.mjtJoint.mjJNT_BALL)),
            *((kinds.mjOBJ_EQUALITY, e, "an equality", "a robot is a tree without loops")
              for e in range(m.neq) if m.eq_active0[e]),
            *((kinds.mjOBJ_TENDON, t, "a tendon", "a race in space has none")
              for t in range(m.ntendon) if any(np.any(table[t]) for table in strings)),
            *((kinds.mjOBJ_ACTUATOR, a, "an actuator", "it must move a hinge or a slide")
              for a in range(m.nu) if m.actuator_trntype[a] not in plain
              or m.jnt_type[m.actuator_trnid[a, 0]] == int(mj.mjtJoint.mjJNT_FREE)),
            *((kinds.mjOBJ_ACTUATOR, a, "an actuator", "write a <motor>, <position> or <velocity>")
              for a in range(m.nu) if m.actuator_dyntype[a] != int(mj.mjtDyn.mjDYN_NONE)
              or m.actuator_gaintype[a] != int(mj.mjtGain.mjGAIN_FIXED)
              or m.actuator_biastype[a] not in simple),
            *((kinds.mjOBJ_BODY, b, "a body with gravcomp", "a race in space has none")
              for b in range(m.nbody) if m.body_gravcomp[b]),
        ]  # fmt: skip
        for kind, number, what, remedy in wrong:
            raise self._error(f"has {what} '{mj.mj_id2name(m, kind, number) or number}': {remedy}")

    def _placed(self, position: np.ndarray) -> Any:
        data = self.mujoco.MjData(self.model)
        data.qpos[:] = position
        self.mujoco.mj_fwdPosition(self.model, data)
        return data

    def _pose(self) -> np.ndarray:
        """Return the first keyframe's qpos, else angles of 0, or the middle of their limits."""
        m = self.model
        if m.nkey:
            return m.key_qpos[0].copy()
        position = m.qpos0.copy()
        for j in self.joints:
            (low, high), q = m.jnt_range[j], m.jnt_qposadr[j]
            if m.jnt_limited[j] and not low <= position[q] <= high:
                position[q] = (low + high) / 2
        return position

    def _efforts(self, efforts: dict[str, float]) -> dict[int, tuple]:
        """Return the motors of a URDF file, by joint."""
        m, motors = self.model, {}
        for j in self.joints:
            effort = efforts.get(m.joint(j).name, 0.0)
            effort = EFFORT if np.isnan(effort) else effort
            if effort > 0:
                motors[j] = len(motors), (-effort, 0.0, effort), effort, (0.0,) * 7
        return motors

    def _drives(self) -> dict[int, tuple]:
        """Return by joint a motor's number, its controls for actions of -1, 0 and 1, its torque or
        else its drive.
        """
        motors: dict[int, tuple] = {}
        for a in range(self.model.nu):
            j = int(self.model.actuator_trnid[a, 0])
            if j in motors:
                raise self._error(f"has two actuators on joint '{self.model.joint(j).name}'")
            motors[j] = (a, *self._drive(a, j))
        return motors

    def _drive(self, a: int, j: int) -> tuple:
        m = self.model
        gear, gain = m.actuator_gear[a, 0], m.actuator_gainprm[a, 0]
        affine = m.actuator_biastype[a] == int(self.mujoco.mjtBias.mjBIAS_AFFINE)
        bias = m.actuator_biasprm[a, :3] if affine else np.zeros(3)
        position, velocity = bias[1] != 0, bias[1] == 0 and bias[2] != 0
        if m.actuator_ctrllimited[a]:
            low, high = m.actuator_ctrlrange[a]
        elif position and m.jnt_limited[j]:
            low, high = sorted(gear * m.jnt_range[j])
        else:
            high = abs(gear) * np.pi if position else FAST if velocity else 1.0
            low = -high
        home = 0.0
        if position:
            home = gear * self.start[m.jnt_qposadr[j]]
            home = m.key_ctrl[0, a] if m.nkey and m.key_ctrl[0].any() else home
            low, high = max(low, home - self.reach), min(high, home + self.reach)
        home = float(np.clip(home, low, high))
        least, most = -UNLIMITED, UNLIMITED
        if m.actuator_forcelimited[a]:
            least, most = sorted(gear * m.actuator_forcerange[a])
        if m.jnt_actfrclimited[j]:
            least, most = max(least, m.jnt_actfrcrange[j, 0]), min(most, m.jnt_actfrcrange[j, 1])
        if not least < most:
            raise self._error(f"has an actuator '{m.actuator(a).name}' without force")
        force, controls = gear * gain, (float(low), home, float(high))
        up, down = force * (high - home), force * (home - low)
        if not affine and home == 0 and up == down and abs(up) <= min(-least, most):
            return controls, up, (0.0,) * 7
        still = gear * (gain * home + bias[0])
        pull, drag = -(gear**2) * bias[1], -(gear**2) * bias[2]
        return controls, 0.0, (still, up, down, pull, drag, least, most)

    def robot(self) -> Robot:
        """Return the tables."""
        m = self.model
        names, links, origin, link_of = self._links()
        forms = Forms(self.mujoco, m, self.data, origin, link_of)
        shape_names, shapes = forms.shapes()
        placed = self._placed(self.start)
        lowest, friction = forms.lowest(placed)
        notes = []
        if not len(shapes) and not self.fixed:
            notes.append(f"{self.path}: nothing of it touches the ground.")
        if m.opt.density or m.opt.viscosity:
            notes.append(f"{self.path}: water and air (density, viscosity) are left out.")
        turned = (1.0, 0.0, 0.0, 0.0) if self.fixed else self.start[3:7]
        height = 0.0 if self.fixed or not len(shapes) else self.start[2] - lowest
        firmness = float(np.clip(FIRM * sum(row[LINK["mass"]] for row in links), 1e3, 1e6))
        inverse = np.zeros((m.nv, m.nv))
        self.mujoco.mj_solveM(m, placed, inverse, np.eye(m.nv))
        ease = np.diag(inverse)
        return Robot(
            path=str(self.path),
            names=names,
            links=np.array(links, float),
            shapes=shapes,
            shape_names=shape_names,
            pairs=forms.pairs(self.start, self.joints),
            pose=np.array([*turned, *(self.start[m.jnt_qposadr[j]] for j in self.joints)]),
            controls=np.array([row[1] for row in sorted(self.motors.values())]),
            looks=forms.looks(),
            ease=np.array([0.0, *(ease[m.jnt_dofadr[j]] for j in self.joints)]),
            facts=np.array([height, friction, firmness, float(self.fixed)]),
            notes=notes,
        )

    def _links(self) -> tuple[list[str], list[list[float]], list[np.ndarray], dict[int, int]]:
        """Return names, rows and origins of links, and the link of each body."""
        m, d = self.model, self.data
        names, rows = [m.body(self.root).name or "root"], [[-1.0] + [0.0] * (len(LINK) - 1)]
        rows[0][LINK["motor"]] = -1
        if not self.fixed:
            top = m.body_dofadr[self.root]
            rows[0][LINK["damping"]] = m.dof_damping[top]
            rows[0][LINK["armature"]] = m.dof_armature[top]
        origin, link_of = [d.xpos[self.root].copy()], {self.root: 0}
        for b in range(self.root + 1, m.nbody):
            if self.root and m.body_rootid[b] != self.root:
                continue
            link_of[b] = link_of[int(m.body_parentid[b])]
            for j in (j for j in self.joints if m.jnt_bodyid[j] == b):
                names.append(m.joint(j).name or f"{m.body(b).name or b}_{j}")
                rows.append(self._joint(j, link_of[b], d.xanchor[j] - origin[link_of[b]]))
                origin.append(d.xanchor[j].copy())
                link_of[b] = len(rows) - 1
        for i, row in enumerate(rows):
            row[LINK["mass"] : LINK["servo"]] = self._mass(
                [b for b, of in link_of.items() if of == i and b and m.body_mass[b] > 0], origin[i]
            )
        return names, rows, origin, link_of

    def _joint(self, j: int, parent: int, place: np.ndarray) -> list[float]:
        m, dof = self.model, self.model.jnt_dofadr[j]
        low, high = m.jnt_range[j] if m.jnt_limited[j] else (-UNLIMITED, UNLIMITED)
        motor, _, torque, drive = self.motors.get(j, (-1, None, 0.0, (0.0,) * 7))
        return [
            parent, *place, *self.data.xaxis[j], low, high, torque, m.dof_damping[dof],
            m.jnt_stiffness[j], m.dof_armature[dof], motor, *[0.0] * 11, *drive,
            m.qpos_spring[m.jnt_qposadr[j]], m.dof_frictionloss[dof],
            float(m.jnt_type[j] == int(self.mujoco.mjtJoint.mjJNT_SLIDE)),
        ]  # fmt: skip

    def _mass(self, bodies: list[int], origin: np.ndarray) -> list[float]:
        """Return mass, centre and inertia of some bodies together."""
        m, d = self.model, self.data
        mass = sum(m.body_mass[b] for b in bodies)
        if not mass:
            return [0.0] * 10
        centre = sum(m.body_mass[b] * d.xipos[b] for b in bodies) / mass
        inertia = np.zeros((3, 3))
        for b in bodies:
            turn, away = d.ximat[b].reshape(3, 3), d.xipos[b] - centre
            inertia += turn @ np.diag(m.body_inertia[b]) @ turn.T
            inertia += m.body_mass[b] * (away @ away * np.eye(3) - np.outer(away, away))
        six = inertia[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
        return [mass, *(centre - origin), *six]
