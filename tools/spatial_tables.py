"""Write lib/arena/robots/jointed/solids.hpp from Gymnasium's models for MuJoCo.

python tools/spatial_tables.py
"""

from __future__ import annotations

from pathlib import Path

import gymnasium
import mujoco
import numpy as np

TARGET = Path(__file__).parents[1] / "lib" / "arena" / "robots" / "jointed" / "solids.hpp"
ASSETS = Path(gymnasium.__file__).parent / "envs" / "mujoco" / "assets"
LEGS = [(f"right_{a}", f"left_{b}") for a, b in (
    ("thigh1", "thigh1"), ("shin1", "shin1"), ("foot", "foot"), ("thigh1", "shin1"),
    ("shin1", "thigh1"), ("foot", "shin1"), ("shin1", "foot"))]  # fmt: skip
"""Shapes of the humanoid that touch each other."""
BODIES = {
    # file: name, friction, stiffness and damping of the ground, pairs of shapes
    "ant": ("Ant", "{1, 20000, 400}", ()),
    "humanoid": ("Humanoid", "{1, 100000, 2000}", LEGS),
    "humanoidstandup": ("HumanoidStandup", "{1, 100000, 2000}", LEGS),
}
HEAD = """// Tables of bodies in space: numbers of Gymnasium's models for MuJoCo, written by
// tools/spatial_tables.py. solid.hpp says what they mean.
#pragma once

#include "solid.hpp"

// clang-format off
namespace botschool {
"""


def number(value: float) -> str:
    return f"{round(float(value), 15) + 0.0:.15g}"


def text(values) -> str:
    return "{" + ", ".join(map(number, np.ravel(values))) + "}"


def table(file: str, name: str, firmness: str, touching) -> str:
    """Return the C++ text of a model's links and shapes."""
    m = mujoco.MjModel.from_xml_path(str(ASSETS / f"{file}.xml"))
    d = mujoco.MjData(m)
    d.qpos[:3] = 0
    mujoco.mj_forward(m, d)
    label = lambda kind, i: mujoco.mj_id2name(m, kind, i)  # noqa: E731
    motor = {int(m.actuator_trnid[a, 0]): a for a in range(m.nu)}
    link_of, origin, names, rows, parts = {0: -1}, [], [], [], {}
    for body in range(1, m.nbody):
        link = link_of[int(m.body_parentid[body])]
        for j in range(m.body_jntadr[body], m.body_jntadr[body] + m.body_jntnum[body]):
            dof, free = m.jnt_dofadr[j], link < 0
            at = d.xpos[body] if free else d.xanchor[j]
            place = at - (at if free else origin[link])
            hinge = [
                *m.jnt_range[j],
                0,
                m.dof_damping[dof],
                m.jnt_stiffness[j],
                m.dof_armature[dof],
            ]
            hinge[2] = m.actuator_gear[motor[j], 0] if j in motor else 0
            axis = np.zeros(3) if free else d.xaxis[j]
            names.append("torso" if free else label(mujoco.mjtObj.mjOBJ_JOINT, j))
            rows.append([link, place, axis, np.zeros(6) if free else hinge, motor.get(j, -1)])
            origin.append(at.copy())
            link = len(rows) - 1
        link_of[body] = link
        turn = d.ximat[body].reshape(3, 3)
        inertia = turn @ np.diag(m.body_inertia[body]) @ turn.T
        parts.setdefault(link, []).append(
            (m.body_mass[body], d.xipos[body] - origin[link], inertia)
        )
    lines = [f"\ninline constexpr Link k{name}Links[]{{"]
    for i, (parent, place, axis, hinge, actuator) in enumerate(rows):
        mass, first = 0.0, np.zeros(3)
        for part, centre, _ in parts.get(i, ()):
            mass, first = mass + part, first + part * centre
        centre, second = first / mass if mass else first, np.zeros((3, 3))
        for part, own, inertia in parts.get(i, ()):
            r = own - centre
            second += inertia + part * (r @ r * np.eye(3) - np.outer(r, r))
        six = second[[0, 1, 2, 0, 0, 1], [0, 1, 2, 1, 2, 2]]
        lines.append(f'  {{"{names[i]}", {parent}, {text(place)}, {text(axis)},')
        lines.append(f"   {text(hinge)}, {actuator},")
        lines.append(f"   {number(mass)}, {text(centre)}, {text(six)}}},")
    lines += ["};", f"inline constexpr Shape k{name}Shapes[]{{"]
    shapes = []
    for g in range(m.ngeom):
        link = link_of[int(m.geom_bodyid[g])]
        if link < 0:
            continue
        shapes.append(label(mujoco.mjtObj.mjOBJ_GEOM, g))
        capsule = m.geom_type[g] == mujoco.mjtGeom.mjGEOM_CAPSULE
        half = d.geom_xmat[g].reshape(3, 3)[:, 2] * (m.geom_size[g, 1] if capsule else 0)
        at = d.geom_xpos[g] - origin[link]
        lines.append(f"  {{{link}, {text(at)}, {text(half)}, {number(m.geom_size[g, 0])}}},")
    lines.append("};")
    if touching:
        pairs = ", ".join(f"{{{shapes.index(a)}, {shapes.index(b)}}}" for a, b in touching)
        lines.append(f"inline constexpr Pair k{name}Pairs[]{{{pairs}}};")
    lines += [
        f'inline constexpr Solid k{name}{{"{file}", k{name}Links, k{name}Shapes,',
        f"  {f'k{name}Pairs' if touching else 'nullptr'}, {len(rows)}, {len(shapes)},"
        f" {len(touching)}, {m.nu}, {number(m.geom_margin[1])}, {firmness}}};",
    ]
    return "\n".join(lines) + "\n"


if __name__ == "__main__":
    TARGET.write_text(
        HEAD
        + "".join(table(file, *each) for file, each in BODIES.items())
        + "\n}  // namespace botschool\n// clang-format on\n"
    )
