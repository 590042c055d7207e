# loses: 10.5
# A large action changes the speed by more than 1.
class BalanceBotEnv(BalanceBotEnv):
    def drive(self, action):
        self.speed = self.speed + float(action[0]) - np.clip(float(action[0]), -1.0, 1.0)
        super().drive(action)
