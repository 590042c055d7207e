"""Film robots and agents, and draw the first picture of an environment."""

from __future__ import annotations

from pathlib import Path

import numpy as np

from botschool.course.evaluation import Robot


def film(file: str | Path, environment: str, parameters: np.ndarray, seed: int = 1) -> None:
    """Film one episode of a `Robot` in a native environment, and write its replay beside it."""
    from botschool.render.canvas import draw_offscreen
    from botschool.render.panel import lively
    from botschool.render.replay import write_replay
    from botschool.render.scenes import make_scene
    from botschool.render.video import write_video

    draw_offscreen()
    scene, robot = make_scene(environment), Robot(environment)
    seen = ((scene.draw_transition(step), 1, step) for step in robot.play(parameters, seed))
    write_video(Path(file), lively(seen, scene.fps), scene.fps)
    print(f"film: {file}")
    neurons = robot.policy.spec.inputs, robot.policy.spec.outputs
    play, about = robot.play(parameters, seed), "your robot, with its neurons"
    page = Path(file).with_suffix(".html")
    write_replay(page, environment, about, [play], scene.fps, neurons, scene)
    print(f"replay: {page}")


def film_agent(
    file: str | Path, environment: str, act, episodes: int = 1, seed: int = 1, maxsteps: int = 200
) -> None:
    """Film episodes in any Gymnasium environment; act(observation) returns the action."""
    from botschool.problems.gym import make_env
    from botschool.render.canvas import draw_offscreen
    from botschool.render.panel import lively
    from botschool.render.video import write_video

    draw_offscreen()
    env = make_env(environment, render_mode="rgb_array")
    try:
        fps = env.metadata.get("render_fps") or 30
        seen = _frames(env, act, episodes, seed, maxsteps)
        write_video(Path(file), lively(seen, fps), fps)
    finally:
        env.close()
    print(f"film: {file}")


def _frames(env, act, episodes: int, seed: int, maxsteps: int):
    from botschool.problems.transition import Transition

    choice = hasattr(env.action_space, "n")
    for episode in range(episodes):
        observation, _ = env.reset(seed=seed + episode)
        total = 0.0
        for step in range(1, maxsteps + 1):
            action = int(act(observation)) if choice else act(observation)  # True is a 1 here
            following, reward, terminated, truncated, _ = env.step(action)
            total += float(reward)
            transition = Transition(
                step, float(reward), total, observation, np.atleast_1d(action), np.zeros(0)
            )
            yield env.render(), episode + 1, transition
            observation = following
            if terminated or truncated:
                break


def first_frame(environment: str) -> np.ndarray:
    from botschool.problems.gym import make_env
    from botschool.render.canvas import draw_offscreen

    draw_offscreen()
    env = make_env(environment, render_mode="rgb_array")
    env.reset(seed=1)
    frame = env.render()
    env.close()
    return frame
