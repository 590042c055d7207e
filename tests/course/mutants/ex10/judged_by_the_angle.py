# loses: 10.6, 10.7
# Ends the episode when the body leans by more than 45 degrees.
class BalanceBotEnv(BalanceBotEnv):
    def fallen(self):
        return bool(abs(self.observe()[0]) > np.pi / 4)
