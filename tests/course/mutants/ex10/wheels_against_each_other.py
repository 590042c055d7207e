# loses: 10.5, 10.7
# Both motors get the same target, so that the robot spins instead of driving.
class BalanceBotEnv(BalanceBotEnv):
    def drive(self, action):
        super().drive(action)
        pybullet.setJointMotorControl2(
            self.robot,
            1,
            pybullet.VELOCITY_CONTROL,
            targetVelocity=self.speed,
            physicsClientId=self.client,
        )
