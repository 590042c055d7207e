# loses: 10.4, 10.7
# The wheels keep the target speed of the episode before.
class BalanceBotEnv(BalanceBotEnv):
    def reset(self, *, seed=None, options=None):
        before = self.speed
        _, info = super().reset(seed=seed)
        self.speed = before
        return self.observe(), info
