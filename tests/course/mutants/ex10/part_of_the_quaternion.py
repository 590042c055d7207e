# loses: 10.3, 10.7
# Takes the first number of the quaternion for the angle.
class BalanceBotEnv(BalanceBotEnv):
    def observe(self):
        seen = super().observe()
        seen[0] = pybullet.getBasePositionAndOrientation(self.robot, self.client)[1][0]
        return seen
