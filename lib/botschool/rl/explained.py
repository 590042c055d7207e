"""Say what each hyperparameter of reinforcement learning does, and where it matters."""

from __future__ import annotations

TRAINING, ROLLOUTS, REPLAY = "all", "PPO", "SAC"
"""Groups: every algorithm; those that learn from rollouts; those that keep a buffer of old steps.

A default is that of the algorithm that names the group (of PPO for all), or of the one in the text.
"""

EXPLAINED: tuple[tuple[str, str, str, str, str], ...] = (
    (TRAINING, "--steps", "1000000", "length of the training, all environments together",
     "too short a training is the most frequent reason for failure"),
    (TRAINING, "--envs", "8", "environments that act side by side",
     "episodes that differ much want many"),
    (TRAINING, "normalize", "true",
     "scales observations and rewards by their running mean and spread",
     "angles beside speeds, returns in the hundreds; CartPole does better without"),
    (TRAINING, "learning_rate", "0.0003", "length of each step along a gradient",
     "everywhere, so vary it first: if too large, the policy collapses; if too small, it stays; "
     "'linear 0.001' falls to 0"),
    (TRAINING, "gamma", "0.99", "a reward k steps later counts gamma^k",
     "near 1 for late rewards (MountainCar); less for quick reactions (Pendulum) learns faster"),
    (TRAINING, "net_arch", "[64, 64]", "hidden neurons, layer by layer",
     "rarely; many observations want wider layers"),
    (TRAINING, "activation_fn", "tanh", "function of the hidden neurons: tanh, relu, elu or gelu",
     "rarely"),
    (ROLLOUTS, "n_steps", "2048", "steps of each environment in a rollout, between two updates",
     "long enough to see what an action led to: 1000 for walkers, 32 for CartPole"),
    (ROLLOUTS, "batch_size", "64",
     "steps in a minibatch, each of which makes one step of the optimiser",
     "noise: larger ones are steadier and fewer"),
    (ROLLOUTS, "n_epochs", "10", "how often a rollout is gone through",
     "few steps to spend: more epochs use them better, until the policy moves too far (approx_kl)"),
    (ROLLOUTS, "gae_lambda", "0.95",
     "how far later TD errors count: 0 trusts the critic, 1 the rewards",
     "1 where the critic is bad, less where returns are noisy"),
    (ROLLOUTS, "clip_range", "0.2", "how far the ratio of probabilities may leave 1",
     "unstable trainings want less"),
    (ROLLOUTS, "clip_range_vf", "", "the same for the critic's predictions; empty: no limit",
     "rarely; it depends on the size of the rewards"),
    (ROLLOUTS, "ent_coef", "0", "weight of the entropy, which keeps the policy undecided",
     "rare rewards, where a policy decides too early; 0 for walkers, 0.01 for games"),
    (ROLLOUTS, "vf_coef", "0.5", "weight of the critic's loss",
     "where policy and critic share layers, as with images"),
    (ROLLOUTS, "max_grad_norm", "0.5", "longer gradients are shortened to this length",
     "large losses, such as those of rewards that are not normalised"),
    (ROLLOUTS, "normalize_advantage", "true", "gives the advantages of a batch mean 0 and spread 1",
     "rewards of unusual size"),
    (ROLLOUTS, "target_kl", "", "an update stops at 1.5 times this divergence; empty: never",
     "many epochs, unstable trainings; 0.01 to 0.05"),
    (ROLLOUTS, "log_std_init", "0", "the first ln of the deviation of Gaussian actions",
     "continuous actions: -2 begins with small movements"),
    (ROLLOUTS, "ortho_init", "true", "draws orthogonal first weights", "rarely"),
    (REPLAY, "buffer_size", "1000000", "old steps that are kept to learn from",
     "memory, with images"),
    (REPLAY, "learning_starts", "100", "steps at random before learning begins",
     "10000 for walkers: varied steps to begin with"),
    (REPLAY, "batch_size", "256", "old steps in one update (DQN: 32)", "rarely"),
    (REPLAY, "tau", "0.005", "how fast the target network follows (DQN: 1, all at once)",
     "stability"),
    (REPLAY, "train_freq", "1", "steps between two updates (DQN: 4)",
     "time: more steps are faster"),
    (REPLAY, "gradient_steps", "1", "gradients in one update; -1: as many as there were steps",
     "few steps to spend: more use them better, and take longer"),
    (REPLAY, "ent_coef", "auto", "weight of the entropy (SAC, TQC); auto: it is learnt", "rarely"),
    (REPLAY, "action_noise", "", "deviation of the noise on actions (TD3, DDPG), which explores",
     "always there: 0.1 is usual, and without it neither explores"),
    (REPLAY, "policy_delay", "2", "the policy learns once in so many updates of TD3's critic",
     "rarely"),
    (REPLAY, "exploration_fraction", "0.1",
     "share of DQN's training in which random actions grow rare",
     "rare rewards want more"),
    (REPLAY, "exploration_final_eps", "0.05", "share of random actions (DQN) that remains",
     "rarely"),
    (REPLAY, "target_update_interval", "10000", "steps between two copies to DQN's target network",
     "short trainings want far less"),
)  # fmt: skip
"""Group, hyperparameter, default, what it does, where it matters."""

OF = {
    TRAINING: "every algorithm",
    ROLLOUTS: "PPO, A2C, TRPO",
    REPLAY: "SAC, TQC, TD3, DDPG, DQN, QR-DQN",
}
"""Group -> the algorithms in it."""
