"""Frames, panels, videos and windows, all without a display."""

import os
import subprocess
import sys

import gymnasium
import imageio.v3 as iio
import numpy as np
import pytest

from botschool import problems
from botschool.config import PolicyConfig
from botschool.errors import BotschoolError
from botschool.policies.policy import Policy
from botschool.render import panel, scenes, video, window
from botschool.render.scene import SCENES

STATES = {
    "CartPole-v0": [0.5, 0.0, 0.1, 0.0],
    "CartPole-v1": [0.5, 0.0, 0.1, 0.0],
    "Pendulum-v0": [0.5, 0.0],
    "Pendulum-v1": [0.5, 0.0],
    "Acrobot-v1": [0.3, 0.5, 0.0, 0.0],
    "MountainCarContinuous-v0": [-0.5, 0.0],
    "envSwingupCustom": [0.5, 0.0, 2.8, 0.0],
    "ErDpole": [0.5, 0.0, 0.3, 0.0, -0.4, 0.0],
}


def frames(number, height=60, width=80):
    for i in range(number):
        frame = np.full((height, width, 3), 255, np.uint8)
        frame[:, : 10 + i] = (200, 0, 0)
        yield frame


# scene.py


@pytest.mark.parametrize("name", STATES)
def test_every_native_problem_is_drawn_from_its_state(name):
    drawn = scenes.make_scene(name)
    state = np.array(STATES[name])
    frame = drawn.draw(state, np.array([0.5]))
    assert frame.dtype == np.uint8
    assert frame.ndim == 3 and frame.shape[2] == 3
    assert drawn.fps > 0
    moved = state.copy()
    moved[0] += 0.3
    assert (drawn.draw(moved, np.array([0.5])) != frame).any()
    assert (drawn.draw(state, np.array([0.5])) == frame).all()


HEADLESS = """
import os
from botschool.errors import BotschoolError
from botschool.render import scenes, window
before = dict(os.environ)
for name, size in (("CartPole-v1", 4), ("ErDpole", 6)):
    frame = scenes.make_scene(name).draw([0.0] * size)
    assert (frame != 255).any()
try:
    window.show(iter([frame]), 30, "x")
except BotschoolError as error:
    print(error)
scenes.make_scene("CartPole-v1").draw([0.0] * 4)
assert before == dict(os.environ)
"""


@pytest.mark.slow
@pytest.mark.skipif(sys.platform != "linux", reason="other systems always have a display")
def test_without_any_display_scenes_are_drawn_and_windows_refused():
    hidden = ("SDL_VIDEODRIVER", "DISPLAY", "WAYLAND_DISPLAY")
    environment = {name: value for name, value in os.environ.items() if name not in hidden}
    environment["PYTHONPATH"] = os.pathsep.join(sys.path)
    done = subprocess.run(
        [sys.executable, "-c", HEADLESS], env=environment, capture_output=True, text=True
    )
    assert done.returncode == 0, done.stderr
    assert done.stdout.count("\n") == 1 and "--video FILE.mp4" in done.stdout


# panel.py


@pytest.mark.parametrize("neurons", [2, 10, 200, 3000])
@pytest.mark.parametrize("size", [(400, 600), (101, 151)])
def test_the_panel_stands_at_the_right_and_sides_are_even(neurons, size):
    frame = np.full((*size, 3), 7, np.uint8)
    activations = np.linspace(-2.0, 2.0, neurons)
    out = panel.with_activations(frame, activations, 1, 1)
    assert out.shape[0] % 2 == 0 and out.shape[1] % 2 == 0
    assert (out[: size[0], : size[1]] == 7).all()
    above_the_scale = out[:-62, -panel.PANEL_WIDTH :]
    for first_or_last in (panel.NEGATIVE, panel.POSITIVE):
        assert (above_the_scale == first_or_last).all(axis=2).any()


# video.py


@pytest.mark.parametrize("suffix", video.VIDEO_SUFFIXES)
def test_a_video_holds_all_frames_at_even_size(tmp_path, suffix):
    path = tmp_path / f"a{suffix}"
    video.write_video(path, frames(12, height=61, width=81), fps=25)
    film = iio.imread(path)
    even = (61, 81) if suffix == ".gif" else (62, 82)
    assert film.shape == (12, *even, 3)
    red, white = film[0, 30, 4].astype(int), film[0, 30, 60].astype(int)
    assert red[0] > 150 and red[1] < 60 and white.min() > 230
    assert [path.name for path in tmp_path.iterdir()] == [f"a{suffix}"]


def test_an_mp4_plays_everywhere_at_the_asked_speed(tmp_path):
    video.write_video(tmp_path / "a.mp4", frames(10), fps=50)
    about = iio.immeta(tmp_path / "a.mp4")
    assert about["codec"] == "h264"
    assert about["pix_fmt"].startswith("yuv420p")
    assert about["fps"] == 50


@pytest.mark.parametrize(
    ("name", "number", "message"),
    [
        ("a.avi", 3, r"must end with one of \.mp4"),
        ("no/a.mp4", 3, "no folder"),
        ("a.mp4", 0, "no frames"),
    ],
)
def test_videos_that_cannot_be_written(tmp_path, name, number, message):
    with pytest.raises(BotschoolError, match=message):
        video.write_video(tmp_path / name, frames(number), fps=25)
    assert list(tmp_path.iterdir()) == []


@pytest.mark.parametrize("failure", [KeyboardInterrupt(), ConnectionResetError("worker died")])
def test_a_failing_episode_leaves_the_old_video(tmp_path, failure):
    (tmp_path / "a.mp4").write_text("old")

    def broken():
        yield from frames(3)
        raise failure

    with pytest.raises(type(failure)):
        video.write_video(tmp_path / "a.mp4", broken(), fps=25)
    assert [path.name for path in tmp_path.iterdir()] == ["a.mp4"]
    assert (tmp_path / "a.mp4").read_text() == "old"


# window.py


def test_a_window_shows_all_frames():
    shown = []

    def watched():
        for frame in frames(3):
            yield frame
            import pygame

            shown.append(pygame.surfarray.array3d(pygame.display.get_surface()).swapaxes(0, 1))

    assert window.show(watched(), fps=1000, title="test") is True
    np.testing.assert_array_equal(shown, list(frames(3)))


def pressing(after, *events):
    """Ten frames; after the given number of them, these events happen."""
    import pygame

    for i, frame in enumerate(frames(10)):
        if i == after:
            for event in events:
                pygame.event.post(event)
        pressing.seen = i + 1
        yield frame


def key(name):
    import pygame

    return pygame.event.Event(pygame.KEYDOWN, key=pygame.key.key_code(name))


@pytest.mark.parametrize("ending", ["escape", "q", "close"])
def test_a_window_ends_when_asked(ending):
    import pygame

    pygame.display.init()
    event = pygame.event.Event(pygame.QUIT) if ending == "close" else key(ending)
    assert window.show(pressing(4, event), fps=1000, title="test") is False
    assert pressing.seen == 5
    assert not pygame.display.get_init()


# what has no scene


@pytest.mark.parametrize("name", ["Pendulum-v1", "CartPole-v1", "Acrobot-v1"])
def test_a_native_problem_without_a_scene_is_drawn_by_gymnasium(name, monkeypatch):
    problem = problems.make(name)
    policy = Policy(name, problem.interface, PolicyConfig(nhiddens=3))
    own = scenes.scene_of(problem)
    monkeypatch.delitem(SCENES, problem.dynamics)
    assert own is not None and scenes.scene_of(problem) is None
    play = problem.play(policy, policy.initial(1), None, 1, 0, 8)
    steps = list(scenes.with_frames(problem, play))
    env = gymnasium.make(name, render_mode="rgb_array")
    env.reset(seed=1)
    env.unwrapped.state = np.array(steps[-1].state)
    assert np.array_equal(steps[-1].frame, env.render())
    assert (steps[0].frame != steps[-1].frame).any()
    env.close()
