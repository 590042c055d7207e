# loses: 10.10
# Returns the network as PPO initialises it.
def train(seed):
    from stable_baselines3 import PPO

    return actor_layers(PPO("MlpPolicy", "BalanceBotBulletEnv-v0", seed=seed, device="cpu"))
