"""What the figure of exercise 14 needs: each problem with evolution's settings and with PPO's."""

from typing import Any

from botschool.page.exercise import robot
from botschool.page.training import page_data, settings_of
from botschool.rl.native import files

CORE = "classic"
PROBLEMS = {
    "cartpole": ("CartPole-v1", "cartpole_openaies.ini"),
    "pendulum": ("Pendulum-v1", "pendulum.ini"),
    "acrobot": ("Acrobot-v1", "acrobot.ini"),
}


def data() -> dict[str, Any]:
    """Return each problem's experiment, post-evaluated in 20 episodes as PPO is, and training."""
    found = {}
    for name, (env, experiment) in PROBLEMS.items():
        settings = settings_of(env, 1)
        agent = page_data(settings, files.make(settings))
        kept = {key: agent[key] for key in ("scene", "networks", "experiment")}
        found[name] = robot(experiment, pepisodes=20)
        found[f"{name}_agent"] = kept | {"seed": 1}
    return found
