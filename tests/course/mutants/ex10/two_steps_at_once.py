# loses: 10.6, 10.7
# Lets the simulation make two steps for each action.
class BalanceBotEnv(BalanceBotEnv):
    def step(self, action):
        self.drive(action)
        pybullet.stepSimulation(self.client)
        return super().step(np.zeros(1))
