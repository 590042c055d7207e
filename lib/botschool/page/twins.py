"""Describe for scenes.js how a picture's shapes move, as its scene in Python moves them."""

from __future__ import annotations

from typing import Any

from botschool.errors import BotschoolError
from botschool.problems.native import NativeProblem
from botschool.render.scene import Scene
from botschool.render.scenes.arenas import CAMERA_SECTORS, ArenaScene, DiscrimScene, PredpreyScene
from botschool.render.scenes.classic import AcrobotScene, CartScene, MountainCarScene, PendulumScene
from botschool.render.scenes.planar import PlanarScene
from botschool.render.scenes.spatial import SpatialScene


def twin(problem: NativeProblem, scene: Scene) -> dict[str, Any]:
    """Return the kind of the scene's twin and its constants. Raises BotschoolError without one."""
    for kind, made in (
        ("acrobot", AcrobotScene),
        ("pendulum", PendulumScene),
        ("mountaincar", MountainCarScene),
    ):
        if isinstance(scene, made):
            return {"kind": kind}
    if isinstance(scene, CartScene):
        poles = [[pole.angle, -1 if pole.clockwise else 1] for pole in scene.poles]
        pivot = scene.CART[1] / 4
        return {"kind": "cart", "poles": poles, "discrete": scene.discrete, "pivot": pivot}
    if isinstance(scene, PlanarScene):
        return {"kind": "planar"} | scene.body()
    if isinstance(scene, SpatialScene):
        return {"kind": "spatial"} | scene.body()
    if isinstance(scene, (DiscrimScene, PredpreyScene)):
        return {"kind": "arena", "side": scene.side} | _arena(scene)
    raise BotschoolError(f"{problem.name} has no picture in a page yet.")


def _arena(scene: ArenaScene) -> dict[str, Any]:
    robots = [
        {
            "observations": look.observations,
            "rays": len(model.directions),
            "camera": CAMERA_SECTORS if look.camera else 0,
            "radius": model.radius,
            "range": model.range,
        }
        for look, model in zip(scene.looks, scene.models, strict=True)
    ]
    found: dict[str, Any] = {"robots": robots}
    if isinstance(scene, DiscrimScene):
        found |= {"cylinder": True, "zone": scene.zone}
    if isinstance(scene, PredpreyScene):
        found["touching"] = sum(model.radius for model in scene.models)
    return found
