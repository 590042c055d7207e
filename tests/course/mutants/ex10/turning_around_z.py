# loses: 10.3, 10.7
# Observes the angular velocity around the upright axis.
class BalanceBotEnv(BalanceBotEnv):
    def observe(self):
        seen = super().observe()
        seen[1] = pybullet.getBaseVelocity(self.robot, self.client)[1][2]
        return seen
