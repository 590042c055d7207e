# loses: 10.6
# The speed costs in one direction, and is rewarded in the other.
class BalanceBotEnv(BalanceBotEnv):
    def reward(self):
        return 1.0 - 0.05 * self.speed
