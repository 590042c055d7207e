# loses: 10.2
# Limits that the robot exceeds: pi rad/s and 5 rad/s.
class BalanceBotEnv(BalanceBotEnv):
    def __init__(self, render_mode=None):
        super().__init__(render_mode)
        limits = np.array([np.pi, np.pi, 5], dtype=np.float32)
        self.observation_space = gymnasium.spaces.Box(-limits, limits)
