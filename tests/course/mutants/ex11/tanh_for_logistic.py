# loses: 11.1
# The hidden neurons use tanh instead of the logistic function.
_Network = Network


class Network(_Network):
    def features(self, patterns):
        return torch.tanh(self.hidden(patterns))
