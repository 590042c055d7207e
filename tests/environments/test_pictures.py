"""Pictures, rewards and observations that environments give in other forms than they should."""

import gymnasium
import numpy as np
import pytest

import botschool
from botschool.errors import BotschoolError
from botschool.problems.pictures import picture
from tiny_envs import Tiny

RED = np.tile(np.uint8([200, 0, 50]), (4, 6, 1))
GREY = np.full((4, 6), 90, np.uint8)


@pytest.mark.parametrize(
    ("given", "drawn"),
    [
        (RED, RED),
        (np.dstack([RED, np.full((4, 6), 7, np.uint8)]), RED),
        (RED.transpose(2, 0, 1), RED),
        (RED / 255, RED),
        (RED.astype(float), RED),
        (RED.astype(np.int64).tolist(), RED),
        (GREY, np.dstack([GREY] * 3)),
        (GREY[:, :, None], np.dstack([GREY] * 3)),
        (GREY[None] / 255.0, np.dstack([GREY] * 3)),
        (GREY > 0, np.full((4, 6, 3), 255)),
    ],
)
def test_pictures_of_many_forms(given, drawn):
    frame = picture(given, "any")
    assert frame.dtype == np.uint8
    np.testing.assert_allclose(frame, drawn, atol=1)


@pytest.mark.parametrize(
    ("given", "says"),
    [
        (None, "gave None"),
        ("x = 3", "gave x = 3 (str)"),
        ([RED] * 5, "shape (5, 4, 6, 3) (list)"),
        (np.zeros((5, 6, 2)), "shape (5, 6, 2)"),
    ],
)
def test_others_are_named(given, says):
    with pytest.raises(BotschoolError) as raised:
        picture(given, "Mine-v0")
    assert says in str(raised.value) and "Mine-v0 draws no pictures" in str(raised.value)


class Otherwise(Tiny):
    """Tiny, which gives its reward, its observation and its pictures in another form."""

    def __init__(self, form=None, fps=10, grows=False, render_mode=None):
        super().__init__(render_mode=render_mode)
        self.form, self.grows, self.pictures = form, grows, 0
        self.metadata = self.metadata | {"render_fps": fps}

    def step(self, action):
        observation, reward, *ends = super().step(action)
        forms = {
            "array": (observation, np.array([reward])),
            "column": (observation[:, None], reward),
            "text": (observation, str(reward)),
            "list": (observation, [reward]),
            "two": (observation, np.array([reward, 1])),
        }
        return *forms.get(self.form, (observation, reward)), *ends

    def render(self):
        self.pictures += self.grows
        return np.zeros((32 + 2 * self.pictures, 32, 3), np.uint8)


gymnasium.register("Otherwise-v0", Otherwise, max_episode_steps=12)


def otherwise(options=""):
    return botschool.problem({"environment": "Otherwise-v0", "options": options}, hidden=2)


@pytest.mark.parametrize("form", ["array", "column"])
def test_one_element_counts_as_its_value(form):
    problem = otherwise(f"form='{form}'")
    assert problem.evaluate(problem.initial()) == otherwise().evaluate(problem.initial())


@pytest.mark.parametrize(("form", "kind"), [("text", "str"), ("list", "list"), ("two", "ndarray")])
def test_other_rewards_are_named_by_their_type(form, kind):
    problem = otherwise(f"form='{form}'")
    with pytest.raises(BotschoolError, match=rf"a reward of .* \({kind}, not a number\)") as raised:
        problem.evaluate(problem.initial())
    assert "stepsize" not in str(raised.value)


@pytest.mark.parametrize("fps", ["'30'", -3])
def test_a_rate_that_is_no_number_is_said(fps, capsys, tmp_path):
    problem = otherwise(f"fps={fps}")
    assert f"render_fps of Otherwise-v0 is {fps}".replace(
        "'", ""
    ) in capsys.readouterr().err.replace("'", "")
    assert problem.film(problem.initial(), tmp_path / "a.gif").stat().st_size > 0


def test_pictures_that_grow_are_refused(tmp_path):
    problem = otherwise("grows=True")
    with pytest.raises(BotschoolError, match="different sizes"):
        problem.film(problem.initial(), tmp_path / "a.gif")
    assert not list(tmp_path.iterdir())


@pytest.mark.parametrize(
    "options",
    [{"slope": 0.1}, {"slope": np.float64(0.1), "vary": "ground, mass"}, {"alive": 1, "step": 0.2}],
)
def test_a_face_takes_the_options_of_files(options):
    env = gymnasium.make("botschool/SpatialAnt-v5", **options)
    spelled = ", ".join(f"{name}={value!r}" for name, value in options.items())
    same = gymnasium.make("botschool/SpatialAnt-v5", options=spelled.replace("np.float64", ""))
    for made in (env, same):
        made.reset(seed=1)
    for action in np.random.default_rng(1).uniform(-1, 1, (40, 8)).astype(np.float32):
        ours, theirs = env.step(action), same.step(action)
        assert ours[0].tolist() == theirs[0].tolist() and ours[1] == theirs[1]


@pytest.mark.parametrize(
    ("name", "options", "says"),
    [
        ("botschool/SpatialAnt-v5", {"slop": 0.1}, "did you mean slope"),
        ("botschool/SpatialAnt-v5", {"slope": "steep"}, "a number from -1 to 1"),
        ("botschool/SwingUp-v0", {"slope": 0.1}, "takes no options"),
        ("botschool/SwingUp-v0", {"noise": 0.1}, "takes no options"),
    ],
)
def test_wrong_options_of_a_face_are_refused(name, options, says):
    with pytest.raises(BotschoolError, match=says):
        gymnasium.make(name, **options)
