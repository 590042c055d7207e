"""The native learner gives the same bits on all instruction sets, with any threads, and resumed."""

import hashlib

import numpy as np
import pytest

from botschool import _core
from botschool.rl.native import PPO

KINDS = [
    ("CartPole-v1", {"n_envs": 20, "ent_coef": 0.01, "net_arch": [33, 20]}),
    ("Pendulum-v1", {"n_envs": 35, "normalize": True, "clip_range_vf": 0.2}),
    (
        "botschool/PlanarHopper-v5",
        {"n_envs": 17, "normalize": True, "share_layers": True, "activation_fn": "relu"},
    ),
    ("botschool/Discrim-v0", {"n_envs": 5, "target_kl": 0.01}),
]
GOLDEN = {
    "CartPole-v1": "99c2cd54c212b5c3",
    "Pendulum-v1": "32cc8ddba7a7a358",
    "botschool/PlanarHopper-v5": "c8aa91b3661641de",
    "botschool/Discrim-v0": "11dc817cb6428f02",
}
"""Hashes of trained parameters: those of every machine."""


def trained(env, options, instruction_set="", threads=1, updates=4):
    ppo = PPO(
        env, seed=11, n_steps=45, batch_size=150, n_epochs=3, learning_rate=0.003,
        instruction_set=instruction_set, threads=threads, **options,
    )  # fmt: skip
    for _ in range(updates):
        ppo.collect()
        ppo.update()
    return ppo


def digest(ppo):
    return hashlib.sha256(ppo.parameters.tobytes()).hexdigest()[:16]


@pytest.mark.parametrize(("env", "options"), KINDS)
def test_bits_are_the_same_everywhere(env, options):
    for instruction_set in _core.instruction_sets():
        assert digest(trained(env, options, instruction_set)) == GOLDEN[env], instruction_set
    for threads in (2, 3, 7):
        assert digest(trained(env, options, threads=threads)) == GOLDEN[env], f"{threads} threads"


@pytest.mark.parametrize(("env", "options"), KINDS)
def test_resumed_is_uninterrupted(env, options):
    whole = trained(env, options)
    half = trained(env, options, "baseline", updates=2)
    resumed = trained(env, options, updates=0)
    resumed.restore(half.state())
    for _ in range(2):
        resumed.collect()
        resumed.update()
    assert digest(resumed) == digest(whole)
    for name, column in vars(whole.rollout).items():
        np.testing.assert_array_equal(getattr(resumed.rollout, name), column, err_msg=name)
    for mine, theirs in zip(resumed.episodes, whole.episodes, strict=True):
        np.testing.assert_array_equal(mine, theirs)


def test_a_state_of_another_training_is_refused():
    state = trained(*KINDS[0], updates=1).state()
    other = trained(*KINDS[1], updates=0)
    with pytest.raises(ValueError, match="values"):
        other.restore(state)
    with pytest.raises(ValueError, match="not the state"):
        other.restore({})
