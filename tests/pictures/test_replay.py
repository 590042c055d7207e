"""Replays: what the page holds, and what it does in a browser."""

import base64
import json
import re
import zlib

import numpy as np
import pytest

from botschool.problems.transition import Transition
from botschool.render import replay
from botschool.render.scenes import make_scene
from running import write_experiment

STEPS = 40


def circling(name, steps=STEPS, seed=0):
    """An episode of the arena's robots, which drive in circles, with made-up readings."""
    scene = make_scene(name)
    rng = np.random.default_rng(seed)
    side, robots = scene.side, len(scene.looks)
    seen = sum(look.observations for look in scene.looks)
    for step in range(1, steps + 1):
        angles = step / 10 + np.pi * np.arange(robots)
        poses = np.column_stack(
            [side * (0.5 + 0.3 * np.cos(angles)), side * (0.5 + 0.3 * np.sin(angles)), angles + 1.6]
        )
        objects = [] if name == "ErPredprey" else [side / 2, side / 2]
        state = np.array([*poses.ravel(), *objects, step])
        observation, action = rng.uniform(0, 1, seen), rng.uniform(-1, 1, 2 * robots)
        reward = float(step == steps)
        yield Transition(step, reward, reward, observation, action, state[:-1] / side, state)


def arena(path, name="ErDiscrim", episodes=2):
    played = (circling(name, STEPS + episode, episode) for episode in range(episodes))
    scene = make_scene(name)
    replay.write_replay(path, name, "a robot", played, 10.0, (1, 1), scene)
    return path


def held(path):
    """The JSON in a page."""
    [text] = re.findall(r'<script id="data"[^>]*>(.*?)</script>', path.read_text("utf-8"), re.S)
    return json.loads(text)


def unpacked(table):
    halves = np.frombuffer(zlib.decompress(base64.b64decode(table["data"])), np.uint8)
    low, high = halves.reshape(2, len(table["low"]), table["rows"]).astype(np.uint16)
    levels = np.cumsum(low + 256 * high, axis=1, dtype=np.uint16)
    return (np.array(table["low"]) + levels.T * np.array(table["step"])).reshape(table["rows"], -1)


# The file


@pytest.mark.parametrize("name", ["ErDiscrim", "ErPredprey"])
def test_a_page_holds_what_the_scene_draws(name, tmp_path):
    data = held(arena(tmp_path / "a.html", name))
    assert [len(episode["totals"]) for episode in data["episodes"]] == [STEPS, STEPS + 1]
    scene = make_scene(name)
    for seed, episode in enumerate(data["episodes"]):
        moments = list(circling(name, STEPS + seed, seed))
        drawn = np.array(
            [scene.numbers(m.state, m.action, m.observation, m.reward) for m in moments]
        )
        kept = unpacked(episode["numbers"])
        assert kept.shape == (STEPS + seed, scene.count)
        np.testing.assert_allclose(kept, drawn, atol=0.05)
    assert len(data["scene"]["shapes"]) == len(scene.shapes)


def test_no_text_ends_the_data_and_nothing_comes_from_elsewhere(tmp_path):
    path = tmp_path / "a.html"
    title = '</script><img src="x">'
    replay.write_replay(
        path, title, "&", [circling("ErDiscrim")], 10.0, (1, 1), make_scene("ErDiscrim")
    )
    assert held(path)["title"] == title
    assert re.findall(r"(?:https?:)?//[a-z]", path.read_text("utf-8")) == []


# The command


def test_the_command_writes_a_page(command, tmp_path):
    file, path = write_experiment(tmp_path), tmp_path / "a.html"
    code, said, _ = command("es", "-f", file, "-p", "--replay", path)
    assert code == 0 and f"replay: {path}" in said
    data = held(path)
    assert data["title"] == "CartPole-v1" and len(data["episodes"]) == 3
    fitness = [float(number) for number in re.findall(r"fitness (\S+)", said)]
    assert [round(episode["fitness"], 2) for episode in data["episodes"]] == fitness
    assert data["groups"] == [["inputs", 4], ["hidden", 3], ["outputs", 2]]
    changes = np.ptp(unpacked(data["episodes"][0]["activations"]), axis=0)
    assert (changes > 0).all()


def test_an_environment_in_python_replays_as_its_pictures(command, tmp_path):
    file, path = (
        write_experiment(tmp_path, "MountainCar-v0", policy={"maxsteps": 20}),
        tmp_path / "a.html",
    )
    assert command("es", "-f", file, "-p", "--replay", path, "--episodes", 1)[0] == 0
    data = held(path)
    [episode] = data["episodes"]
    assert data["scene"] is None and len(episode["totals"]) == 20
    assert 1 < len(episode["frames"]["steps"]) <= 20
    assert base64.b64decode(episode["frames"]["data"][0])[8:12] == b"WEBP"
    assert np.ptp(unpacked(episode["activations"]), axis=0).max() > 0


@pytest.mark.parametrize(
    ("arguments", "says"),
    [
        (["-p", "--replay", "a.htm"], ["a.htm", ".html"]),
        (["-p", "--replay", "no/a.html"], ["no folder"]),
        (["--replay", "a.html"], ["-p"]),
        (["-p", "--replay", "a.html", "--video", "a.mp4"], ["--video", "--replay"]),
    ],
)
def test_replays_that_are_refused(refused, tmp_path, monkeypatch, arguments, says):
    monkeypatch.chdir(tmp_path)
    refused("es", "-f", write_experiment(tmp_path / "x"), *arguments, says=says)
    assert [path.name for path in tmp_path.iterdir()] == ["x"]


# The page in a browser


@pytest.fixture
def page(browser, tmp_path):
    """Opens a page for a test, which must leave no errors and ask no network."""

    def opened(path, place="#step=1", **screen):
        browser.resize(**({"width": 1280, "height": 800} | screen))
        browser.open(path, place)
        return browser

    browser.errors.clear()
    browser.requests.clear()
    yield opened
    assert browser.errors == []
    assert {url.partition(":")[0] for url in browser.requests} <= {"file", "data", "about"}


def step(browser):
    return int(browser.run("byId('step').innerText").split("/")[0])


def episode(browser):
    return int(browser.run("byId('episode').innerText").split("/")[0])


def picture(browser):
    return browser.run("byId('scene').toDataURL()")


@pytest.mark.slow
@pytest.mark.parametrize("name", ["ErDiscrim", "ErPredprey"])
def test_the_page_plays_every_episode_and_stops(page, name, tmp_path):
    browser = page(arena(tmp_path / "a.html", name), place="")
    browser.wait("playing")
    first = picture(browser)
    browser.wait("time > 5")
    assert picture(browser) != first
    browser.press("ArrowUp")
    browser.press("ArrowUp")
    browser.press("ArrowUp")
    assert browser.run("byId('speed').innerText") == "8×"
    browser.wait("!playing")
    assert (episode(browser), step(browser)) == (2, STEPS + 1)
    assert browser.run("byId('total').innerText") == "1"


@pytest.mark.slow
def test_keys_steer_the_page(page, tmp_path):
    browser = page(arena(tmp_path / "a.html"))
    assert not browser.run("playing") and step(browser) == 1
    reached = []
    for key, modifiers in (
        ("ArrowRight", 0), ("ArrowRight", 8), ("ArrowLeft", 0), ("ArrowLeft", 8), ("End", 0),
        ("Home", 0),
    ):  # fmt: skip
        browser.press(key, modifiers=modifiers)
        reached.append(step(browser))
    assert reached == [2, 12, 11, 1, STEPS, 1]
    browser.press(" ", " ")
    browser.wait("time > 1")
    browser.press(" ", " ")
    assert not browser.run("playing")
    for key, number in (("PageDown", 2), ("PageUp", 1), ("2", 2)):
        browser.press(key, key if len(key) == 1 else "")
        browser.wait(f"episode === {number - 1} && time === 0")
    everything = picture(browser)
    browser.press("z", "z")
    assert picture(browser) != everything
    browser.press("?", "?")
    assert browser.run("byId('help').open")


def test_the_browser_reads_the_numbers_that_were_packed(page, tmp_path):
    browser = page(path := arena(tmp_path / "a.html"), "#step=7")
    numbers = unpacked(held(path)["episodes"][0]["numbers"])[6]
    np.testing.assert_allclose(browser.run("numbersAt(time)"), numbers, rtol=1e-6, atol=1e-6)
    half = browser.run("numbersAt(6.5)")
    assert half[0] == pytest.approx((numbers[0] + browser.run("numbersAt(7)")[0]) / 2)
