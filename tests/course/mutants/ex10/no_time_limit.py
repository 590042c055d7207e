# loses: 10.7
# Registers the environment without a limit of steps.
def register_robot():
    gymnasium.register(id="BalanceBotBulletEnv-v0", entry_point=BalanceBotEnv)
