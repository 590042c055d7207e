# OpenAI-ES in place of a population; PPO whose best policy on the way is kept.
def evolve(seed):
    robot, rng = Robot("BalanceBotBulletEnv-v0", nhiddens=0), np.random.default_rng(seed)
    scale, centre = np.array([0.1, 3.0, 1.5, 0.2]), np.zeros(4)
    for generation in range(14):
        e = rng.standard_normal((6, 4))
        both = np.concatenate([centre + e, centre - e]) * scale
        fitness = robot.evaluate(both, seed + generation, episodes=1, maxsteps=500)
        ranks = np.argsort(np.argsort(fitness)) / 11 - 0.5
        centre = centre + 0.9 * (ranks[:6] - ranks[6:]) @ e / 2
    return centre * scale


def train(seed):
    import torch
    from stable_baselines3 import PPO
    from stable_baselines3.common.callbacks import BaseCallback

    torch.manual_seed(seed)

    class KeepTheBest(BaseCallback):
        best, layers = -np.inf, None

        def _on_step(self):
            return True

        def _on_rollout_start(self):
            if self.num_timesteps < 6000:
                return
            robot = gymnasium.make("BalanceBotBulletEnv-v0")
            total = 0.0
            for episode in range(4):
                observation, ended = robot.reset(seed=1000 * episode + seed)[0], False
                while not ended:
                    action, _ = self.model.predict(observation, deterministic=True)
                    observation, reward, terminated, truncated, _ = robot.step(action)
                    total += reward
                    ended = terminated or truncated
            if total > self.best:
                self.best, self.layers = total, actor_layers(self.model)

    keeper = KeepTheBest()
    model = PPO(
        "MlpPolicy", gymnasium.make("BalanceBotBulletEnv-v0"), seed=seed, device="cpu", n_steps=512,
        learning_rate=1e-3, gamma=0.98, gae_lambda=0.9,
    )  # fmt: skip
    model.learn(16_384, callback=keeper)
    return [[weights.tolist(), biases.tolist()] for weights, biases in keeper.layers]
