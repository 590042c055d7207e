"""Turn the geoms of a MuJoCo model into what touches the ground or each other, and is drawn."""

from __future__ import annotations

from collections.abc import Iterator
from typing import Any

import numpy as np

POINTS, PAIRS = 256, 64
"""The most points of contact with the ground, and pairs of shapes that touch each other."""
POSES = 300
"""Random poses in which shapes are tried for whether they can touch each other."""


class Forms:
    """Geoms of a robot; data: of the pose in which links have their origins."""

    def __init__(
        self, mujoco: Any, model: Any, data: Any, origin: list[np.ndarray], link_of: dict[int, int]
    ) -> None:
        self.mujoco, self.model, self.data = mujoco, model, data
        self.origin, self.link_of, self.corners = origin, link_of, 26
        plane = int(mujoco.mjtGeom.mjGEOM_PLANE)
        geoms = range(model.ngeom)
        floor = next((g for g in geoms if model.geom_type[g] == plane), None)
        kind, wish = (1, 1) if floor is None else (
            model.geom_contype[floor], model.geom_conaffinity[floor]
        )  # fmt: skip
        moving = [
            g for g in geoms
            if model.geom_type[g] != plane and model.geom_bodyid[g] in link_of
            and model.geom_bodyid[g] > 0
            and (model.geom_contype[g] & wish or model.geom_conaffinity[g] & kind)
        ]  # fmt: skip
        self.touching = sorted(moving, key=lambda g: link_of[int(model.geom_bodyid[g])])
        """Those that touch the ground, link by link."""

    def shapes(self) -> tuple[list[str], np.ndarray]:
        """Return name and row of each ball and bar; meshes have fewer points if there are many."""
        for self.corners in (26, 14, 8):
            rows = [row for g in self.touching for row in self._rows(g)]
            if sum(1 + any(row[5:8]) for row in rows) <= POINTS:
                break
        return [row[0] for row in rows], np.array([row[1:] for row in rows], float).reshape(-1, 8)

    def _rows(self, g: int) -> Iterator[tuple]:
        m, link = self.model, self.link_of[int(self.model.geom_bodyid[g])]
        name = m.geom(g).name or m.body(m.geom_bodyid[g]).name
        for one, other, radius in self._ends(g, self.data):
            yield name, link, *((one + other) / 2 - self.origin[link]), *((other - one) / 2), radius

    def _is_wheel(self, g: int) -> bool:
        """Return whether a cylinder turns about its own axis."""
        m, d = self.model, self.data
        body = m.geom_bodyid[g]
        if not m.body_jntnum[body]:
            return False
        j = m.body_jntadr[body] + m.body_jntnum[body] - 1
        beside = np.cross(d.xaxis[j], d.geom_xpos[g] - d.xanchor[j])
        turned = d.xaxis[j] @ d.geom_xmat[g].reshape(3, 3)[:, 2]
        hinge = m.jnt_type[j] == int(self.mujoco.mjtJoint.mjJNT_HINGE)
        return bool(
            hinge and np.linalg.norm(beside) < 1e-3 * m.geom_size[g, 0] and turned**2 > 0.99
        )

    def _ends(self, g: int, data: Any) -> Iterator[tuple[np.ndarray, np.ndarray, float]]:
        """Yield ends and radius of the balls and bars of which a geom consists."""
        m, kinds = self.model, self.mujoco.mjtGeom
        place, turn, kind = data.geom_xpos[g], data.geom_xmat[g].reshape(3, 3), m.geom_type[g]
        size, margin = m.geom_size[g], m.geom_margin[g]
        if kind == int(kinds.mjGEOM_SPHERE):
            half, radius, points = 0.0, size[0], np.zeros((1, 3))
        elif kind == int(kinds.mjGEOM_CAPSULE):
            half, radius, points = size[1], size[0], np.zeros((1, 3))
        elif kind == int(kinds.mjGEOM_CYLINDER) and self._is_wheel(g):
            half, radius, points = max(0.0, size[1] - size[0]), size[0], np.zeros((1, 3))
        elif kind == int(kinds.mjGEOM_CYLINDER):
            around = np.arange(8) * np.pi / 4
            points = size[0] * np.stack([np.cos(around), np.sin(around), 0 * around], axis=1)
            half, radius = size[1], 0.0
        elif kind == int(kinds.mjGEOM_BOX):
            half, radius = size[2], 0.0
            points = np.array([[x, y, 0] for x in (-1, 1) for y in (-1, 1)]) * size
        else:
            half, radius, points = 0.0, 0.0, self._surface(g)
        for point in points:
            middle, axis = place + turn @ point, half * turn[:, 2]
            yield middle - axis, middle + axis, radius + margin

    def _surface(self, g: int) -> np.ndarray:
        """Return points of a mesh's hull, or of an ellipsoid, that are farthest in some ways."""
        m, size = self.model, self.model.geom_size[g]
        steps = np.stack(np.meshgrid(*[(-1, 0, 1)] * 3), axis=-1).reshape(-1, 3)
        wanted = {8: (3,), 14: (1, 3), 26: (1, 2, 3)}[self.corners]
        ways = steps[np.isin(np.abs(steps).sum(axis=1), wanted)]
        if m.geom_dataid[g] < 0:
            return size**2 * ways / np.linalg.norm(size * ways, axis=1, keepdims=True)
        mesh = m.geom_dataid[g]
        points = m.mesh_vert[m.mesh_vertadr[mesh] :][: m.mesh_vertnum[mesh]].astype(float)
        return points[np.unique((points @ ways.T).argmax(axis=0))]

    def lowest(self, data: Any) -> tuple[float, float]:
        """Return the lowest z of a pose, and the friction of the geom that is there."""
        points = [
            (min(one[2], other[2]) - radius, g)
            for g in self.touching
            for one, other, radius in self._ends(g, data)
        ]
        low, geom = min(points, default=(0.0, -1))
        return float(low), float(self.model.geom_friction[geom, 0]) if geom >= 0 else 1.0

    def pairs(self, start: np.ndarray, joints: list[int]) -> np.ndarray:
        """Return numbers of the balls and capsules that MuJoCo lets touch each other and that can.

        Those that touch each other in most of some random poses, where there are too many.
        """
        m, mj = self.model, self.mujoco
        number, first = {}, 0
        for g in self.touching:
            if m.geom_type[g] in (int(mj.mjtGeom.mjGEOM_SPHERE), int(mj.mjtGeom.mjGEOM_CAPSULE)):
                number[g] = first
            first += sum(1 for _ in self._rows(g))
        counts = {(a, b): 0 for a in number for b in number if a < b and self._may_meet(a, b)}
        data, rng = mj.MjData(m), np.random.default_rng(1)
        limited = m.jnt_limited[joints].astype(bool)[:, None]
        low, high = np.where(limited, m.jnt_range[joints], (-np.pi, np.pi)).T
        data.qpos[:] = start
        for _ in range(POSES if counts else 0):
            data.qpos[m.jnt_qposadr[joints]] = rng.uniform(low, high)
            mj.mj_kinematics(m, data)
            for a, b in counts:
                counts[a, b] += mj.mj_geomDistance(m, data, a, b, 0.01, None) < 0
        often = sorted(filter(counts.get, counts), key=lambda pair: -counts[pair])[:PAIRS]
        return np.array([(number[a], number[b]) for a, b in sorted(often)], int).reshape(-1, 2)

    def _may_meet(self, a: int, b: int) -> bool:
        m, kind, wish = self.model, self.model.geom_contype, self.model.geom_conaffinity
        one, other = (int(m.geom_bodyid[g]) for g in (a, b))
        if not (kind[a] & wish[b] or kind[b] & wish[a]):
            return False
        if {(one << 16) + other, (other << 16) + one} & set(m.exclude_signature.tolist()):
            return False
        one, other = int(m.body_weldid[one]), int(m.body_weldid[other])
        above, beyond = (int(m.body_weldid[m.body_parentid[w]]) for w in (one, other))
        return one != other and (one != beyond or not one) and (other != above or not other)

    def looks(self) -> np.ndarray:
        """Return link, both ends and radius of the bars that are drawn of each body."""
        m, d, kinds, rows = self.model, self.data, self.mujoco.mjtGeom, []
        seen = [g for g in range(m.ngeom) if m.geom_type[g] != int(kinds.mjGEOM_PLANE)]
        for b, link in self.link_of.items():
            own = [g for g in seen if m.geom_bodyid[g] == b]
            for g in [g for g in own if g in self.touching] or own:
                kind, size, box = m.geom_type[g], m.geom_size[g], m.geom_aabb[g]
                at, turn = d.geom_xpos[g] - self.origin[link], d.geom_xmat[g].reshape(3, 3)
                if kind in (int(kinds.mjGEOM_SPHERE), int(kinds.mjGEOM_CAPSULE)):
                    half = turn[:, 2] * (size[1] if kind == int(kinds.mjGEOM_CAPSULE) else 0.0)
                    rows.append((link, *(at - half), *(at + half), size[0]))
                    continue
                disc = kind == int(kinds.mjGEOM_CYLINDER) and size[1] < size[0]
                for one, other, radius in _disc(*size[:2]) if disc else _slab(box[3:]):
                    ends = at + turn @ (box[:3] + one), at + turn @ (box[:3] + other)
                    rows.append((link, *ends[0], *ends[1], radius))
        return np.array(rows, float).reshape(-1, 8)


def _disc(radius: float, half: float) -> Iterator[tuple[np.ndarray, np.ndarray, float]]:
    """Yield ends and radius of the spokes that a flat cylinder is drawn as."""
    wide = max(half, 0.25 * radius)
    for angle in np.arange(6) * np.pi / 6:
        end = max(0.0, radius - wide) * np.array([np.cos(angle), np.sin(angle), 0.0])
        yield end, -end, wide


def _slab(half: np.ndarray) -> Iterator[tuple[np.ndarray, np.ndarray, float]]:
    """Yield ends and radius of the bars that a box is drawn as, side by side."""
    thin, wide, long = np.argsort(half)
    radius = max(float(half[thin]), 0.05 * float(half[wide]))
    room = max(0.0, half[wide] - radius)
    for aside in np.linspace(-room, room, 1 + int(np.ceil(room / radius))) if room else [0.0]:
        end = np.zeros(3)
        end[long], end[wide] = max(0.0, half[long] - radius), aside
        other = end.copy()
        other[long] = -end[long]
        yield end, other, radius
