# loses: 11.1, 11.5
# The hidden layer has no biases.
_Network = Network


class Network(_Network):
    def __init__(self, inputs, hiddens, outputs):
        super().__init__(inputs, hiddens, outputs)
        self.hidden = nn.Linear(inputs, hiddens, bias=False)


def learn(inputs, targets, hiddens, seed):
    torch.manual_seed(seed)
    return Network(inputs.shape[1], hiddens, targets.shape[1])
