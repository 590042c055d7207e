"""Laboratory 3."""

import numpy as np

from lab_answers import WHY, which

PREDICTIONS = {"best-cartpole": "4", "best-pendulum": "100", "fresh-20": -300, "why": WHY}
HONEST = [("Ada", {}), ("Bo", {"best-cartpole": "100"}), ("Cy", {"fresh-20": -900})]
PARTS = 20
MEASURE = """
def measure(run):
    post = run["stat"][:, 2]
    solved = (post >= 475).any()
    first = (post >= 475).argmax() + 1 if solved else len(post)
    return {"reported": post[-1], "fresh": play_again(run, seed=1, episodes=100).mean(),
            "evaluations": first * run["experiment"]["algo"]["popsize"], "solved": int(solved)}
"""
SHOWN = "Pendulum"
DRAWN = ("fresh", "individuals", "mean return in new episodes")


def conclusions(place, data):
    few, many = "4 individuals", "100 individuals"
    cart, p_cart = which(
        data["CartPole 4"]["evaluations"], data["CartPole 100"]["evaluations"], (many, few)
    )
    pendulum, p_pendulum = which(
        data["Pendulum 4"]["fresh"], data["Pendulum 100"]["fresh"], (few, many)
    )
    luck = [v["reported"] - v["fresh"] for n, v in data.items() if n.startswith("Pendulum")]
    return {
        "cartpole": cart,
        "p-cartpole": p_cart,
        "pendulum": pendulum,
        "p-pendulum": p_pendulum,
        "lost": f"{np.concatenate(luck).mean():.2f}",
    }
