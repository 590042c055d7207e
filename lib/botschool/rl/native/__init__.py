"""Train on native problems by policy gradients in C++ (lib/policy_gradient). Needs no torch.

    from botschool.rl.native import PPO

    ppo = PPO("CartPole-v1", seed=1, n_envs=16, n_steps=32, n_epochs=20, learning_rate=0.001)
    ppo.learn(50_000)
    returns, lengths = ppo.play(range(20))          # new episodes, without exploration

You can also run the same training step by step:

    rollout = ppo.collect()                         # arrays (n_steps, n_envs), see Rollout
    batch = ppo.minibatch(rows)                     # samples of the rollout, by number
    loss = ppo.loss(batch)                          # losses, ratios, gradients
    ppo.step(loss.gradient)                         # one step of Adam
    ppo.update()                                    # or all epochs and minibatches at once

The result depends only on problem, seed and hyperparameters, not on threads, instruction set or
machine. docs/specification.md, "Policy gradients", has the rules. lib/walkthroughs/ppo.py is the
same algorithm in PyTorch, written to be read.
"""

from botschool.rl.native.hyperparameters import Hyperparameters
from botschool.rl.native.ppo import PPO, Loss, Minibatch, Rollout
from botschool.rl.native.problem import native_problem

__all__ = ["PPO", "Hyperparameters", "Loss", "Minibatch", "Rollout", "native_problem"]
