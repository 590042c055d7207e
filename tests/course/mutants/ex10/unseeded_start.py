# loses: 10.4, 10.7
# Draws the inclination from NumPy's global generator, which no seed reaches.
class BalanceBotEnv(BalanceBotEnv):
    def reset(self, *, seed=None, options=None):
        return super().reset(seed=int(np.random.randint(2**31)))
