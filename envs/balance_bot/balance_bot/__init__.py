"""A two-wheeled robot that must learn to balance, as a Gymnasium environment.

`import balance_bot` registers it; `gymnasium.make("BalanceBotBulletEnv-v0")` makes it.
"""

from gymnasium.envs.registration import register

register(
    id="BalanceBotBulletEnv-v0",
    entry_point="balance_bot.env:BalanceBotEnv",
    max_episode_steps=500,
)
