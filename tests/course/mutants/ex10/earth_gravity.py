# loses: 10.4, 10.7
# Gravity 9.81 downwards, as on earth, but not as in the text.
class BalanceBotEnv(BalanceBotEnv):
    def reset(self, *, seed=None, options=None):
        answer = super().reset(seed=seed)
        pybullet.setGravity(0, 0, -9.81, physicsClientId=self.client)
        return answer
