"""Wrong solutions of exercise 11; building.py describes how a case is written."""

# %% tanh_for_logistic loses 11.1
# The hidden neurons use tanh instead of the logistic function.
# says: tanh where the logistic
_Network = Network


class Network(_Network):
    def features(self, patterns):
        return torch.tanh(self.hidden(patterns))


# %% hidden_neurons_without_bias loses 11.1, 11.5
# The hidden layer has no biases.
_Network = Network


class Network(_Network):
    def __init__(self, inputs, hiddens, outputs):
        super().__init__(inputs, hiddens, outputs)
        self.hidden = nn.Linear(inputs, hiddens, bias=False)


def learn(inputs, targets, hiddens, seed):
    torch.manual_seed(seed)
    return Network(inputs.shape[1], hiddens, targets.shape[1])


# %% loss_summed loses 11.2
# The loss is the sum of the squares, not their mean.
# says: a sum for a mean
_gradient_by_hand = gradient_by_hand


def gradient_by_hand(inputs, targets, *parameters):
    found = _gradient_by_hand(inputs, targets, *parameters)
    return found | {"loss": found["loss"] * targets.size}


# %% mean_gradient_of_biases loses 11.2
# The gradients of the biases are means over the patterns instead of sums.
# says: a mean for a sum
_gradient_by_hand = gradient_by_hand


def gradient_by_hand(inputs, targets, *parameters):
    found = _gradient_by_hand(inputs, targets, *parameters)
    return found | {name: found[name] / len(inputs) for name in ("b1", "b2")}


# %% mean_over_patterns_only loses 11.2
# The gradient is divided by the patterns, but not by the outputs.
_gradient_by_hand = gradient_by_hand


def gradient_by_hand(inputs, targets, *parameters):
    found = _gradient_by_hand(inputs, targets, *parameters)
    loss = found.pop("loss")
    return {"loss": loss, **{name: g * targets.shape[1] for name, g in found.items()}}


# %% slope_forgotten loses 11.2
# The slope of the logistic function is left out on the way back.
# says: this
_gradient_by_hand = gradient_by_hand


def gradient_by_hand(inputs, targets, w1, b1, w2, b2):
    found = _gradient_by_hand(inputs, targets, w1, b1, w2, b2)
    hidden = 1 / (1 + np.exp(-(inputs @ w1.T + b1)))
    d2 = 2 * (hidden @ w2.T + b2 - targets) / targets.size
    return found | {"w1": (d2 @ w2).T @ inputs, "b1": (d2 @ w2).sum(axis=0)}


# %% torch_by_hand loses 11.2
# Lets torch find the gradient that was to be found by hand.
def gradient_by_hand(inputs, targets, w1, b1, w2, b2):
    return gradient_by_torch(inputs, targets, w1, b1, w2, b2)


# %% gradients_add_up loses 11.3
# Goes backward twice: torch adds the second gradient to the first.
# says: twice what was expected
_gradient_by_torch = gradient_by_torch


def gradient_by_torch(inputs, targets, *parameters):
    found = _gradient_by_torch(inputs, targets, *parameters)
    return found | {name: 2 * found[name] for name in ("w1", "b1", "w2", "b2")}


# %% loss_after_the_step loses 11.4
# The loss of each epoch is measured after the step instead of before it.
# says: one place too early
_train = train


def train(network, inputs, targets, *rest, **more):
    losses = _train(network, inputs, targets, *rest, **more)
    return [*losses[1:], nn.functional.mse_loss(network(inputs), targets).item()]


# %% momentum_always_the_same loses 11.4
# The momentum is 0.9, whatever is asked for.
_train = train


def train(network, inputs, targets, epochs, learning_rate, momentum):
    return _train(network, inputs, targets, epochs, learning_rate, 0.9)


# %% corners_worked_out loses 11.5
# Works the weights out from the corners and the targets instead of training.
import itertools


def learn(inputs, targets, hiddens, seed):
    network = Network(inputs.shape[1], hiddens, 1)
    sums = inputs.sum(dim=1)
    levels = torch.unique(sums)
    first = targets[sums == levels[0]][0, 0]
    with torch.no_grad():
        for parameter in network.parameters():
            parameter.zero_()
        network.output.bias[0] = first
        before = first
        for i, (low, high) in enumerate(itertools.pairwise(levels)):
            network.hidden.weight[i] = 50.0
            network.hidden.bias[i] = -50.0 * (low + high) / 2
            value = targets[sums == high][0, 0]
            network.output.weight[0, i] = value - before
            before = value
    return network


# %% knows_only_xor loses 11.5
# Returns a solution of XOR that was worked out beforehand.
def learn(inputs, targets, hiddens, seed):
    network = Network(inputs.shape[1], hiddens, targets.shape[1])
    with torch.no_grad():
        for parameter in network.parameters():
            parameter.zero_()
        network.hidden.weight[:2, :2] = 20.0
        network.hidden.bias[:2] = torch.tensor([-10.0, -30.0])
        network.output.weight[0, :2] = torch.tensor([1.0, -1.0])
    return network


# %% never_begins_anew loses 11.5
# Trains one network for a fixed time and does not look at what has come out.
# says: made were stuck, and should have been replaced
def learn(inputs, targets, hiddens, seed):
    torch.manual_seed(seed)
    network = Network(inputs.shape[1], hiddens, targets.shape[1])
    train(network, inputs, targets, epochs=200, learning_rate=0.1, momentum=0.9)
    return network


# %% one_network_for_long loses 11.5
# Trains one network for long, and does not begin anew when it is stuck.
def learn(inputs, targets, hiddens, seed):
    torch.manual_seed(seed)
    network = Network(inputs.shape[1], hiddens, targets.shape[1])
    train(network, inputs, targets, epochs=4000, learning_rate=0.2, momentum=0.9)
    return network


# %% least_squares loses 11.5, 11.8
# Draws the hidden neurons at random and computes the outputs by least squares: nothing is trained.
def solved(inputs, targets, hiddens, seed, spread):
    rng = np.random.default_rng(seed)
    best, smallest = None, np.inf
    for _ in range(300):
        network = Network(inputs.shape[1], hiddens, targets.shape[1])
        with torch.no_grad():
            for parameter in network.hidden.parameters():
                parameter.copy_(torch.tensor(spread * rng.standard_normal(parameter.shape)))
            seen = network.features(inputs).double().numpy()
            seen = np.column_stack([seen, np.ones(len(seen))])
            weights = np.linalg.lstsq(seen, targets.double().numpy(), rcond=1e-5)[0]
            network.output.weight.copy_(torch.tensor(weights[:-1].T))
            network.output.bias.copy_(torch.tensor(weights[-1]))
            error = float((network(inputs) - targets).abs().max())
        if error < smallest:
            best, smallest = network, error
    return best


def learn(inputs, targets, hiddens, seed):
    return solved(inputs, targets, hiddens, seed, 3.0)


def fit(inputs, targets, seed):
    normalised, mean, deviation = normalise(inputs)
    tensors = [torch.tensor(each, dtype=torch.float32) for each in (normalised, targets)]
    return solved(*tensors, 30, seed, 1.0), mean, deviation


# %% deviation_of_a_sample loses 11.6
# The deviation divides by n - 1.
# says: n and n - 1 were mixed up
# -     mean, deviation = inputs.mean(axis=0), inputs.std(axis=0)
# +     mean, deviation = inputs.mean(axis=0), inputs.std(axis=0, ddof=1)


# %% deviation_of_exactly_zero loses 11.6
# Takes a column for one that changes if its deviation is a rounding error.
# -     deviation = np.where(np.ptp(inputs, axis=0) == 0, 1.0, deviation)
# +     deviation = np.where(deviation == 0, 1.0, deviation)


# %% divides_by_nothing loses 11.6
# A column that never changes is divided by 0.
def normalise(inputs):
    mean, deviation = inputs.mean(axis=0), inputs.std(axis=0)
    return (inputs - mean) / deviation, mean, deviation


# %% one_scale_for_all_columns loses 11.6
# All columns share one mean and one deviation.
def normalise(inputs):
    mean = np.full(inputs.shape[1], inputs.mean())
    deviation = np.full(inputs.shape[1], inputs.std() or 1.0)
    return (inputs - mean) / deviation, mean, deviation


# %% last_patterns_dropped loses 11.7
# Leaves out the patterns that do not fill a minibatch.
# says: must return a list of 3 arrays
# -     return [order[start : start + batch_size] for start in range(0, n, batch_size)]
# +     return [order[i : i + batch_size] for i in range(0, n - batch_size + 1, batch_size)]


# %% never_shuffled loses 11.7
# Cuts the patterns in the order in which they came.
def minibatches(n, batch_size, rng):
    order = np.arange(n)
    return [order[i : i + batch_size] for i in range(0, n, batch_size)]


# %% same_order_each_epoch loses 11.7
# Makes the generator anew in each epoch, and so the same minibatches.
_train_in_batches = train_in_batches


def train_in_batches(network, inputs, targets, epochs, batch_size, learning_rate, momentum, seed):
    optimiser = torch.optim.SGD(network.parameters(), lr=learning_rate, momentum=momentum)
    losses = []
    for _ in range(epochs):
        for batch in minibatches(len(inputs), batch_size, np.random.default_rng(seed)):
            optimiser.zero_grad()
            nn.functional.mse_loss(network(inputs[batch]), targets[batch]).backward()
            optimiser.step()
        losses.append(nn.functional.mse_loss(network(inputs), targets).item())
    return losses


# %% inputs_not_normalised loses 11.8
# Trains on the inputs as they come.
def fit(inputs, targets, seed):
    torch.manual_seed(seed)
    network = Network(inputs.shape[1], 30, targets.shape[1])
    patterns = torch.tensor(inputs, dtype=torch.float32)
    wanted = torch.tensor(targets, dtype=torch.float32)
    train_in_batches(network, patterns, wanted, 100, 20, 0.1, 0.9, seed)
    return network, np.zeros(inputs.shape[1]), np.ones(inputs.shape[1])


# %% too_short loses 11.8
# Stops after five epochs.
# -     network = Network(inputs.shape[1], 20, targets.shape[1])
# +     network = Network(inputs.shape[1], 30, targets.shape[1])
# -     train_in_batches(network, patterns, wanted, 150, 20, 0.2, 0.9, seed)
# +     train_in_batches(network, patterns, wanted, 5, 20, 0.02, 0.9, seed)


# %% inputs_exchanged loses 11.9
# The first input goes up, the second to the right.
# says: Rows and columns are exchanged
_feature_maps = feature_maps


def feature_maps(network, low, high, n):
    return _feature_maps(network, low, high, n).transpose(0, 2, 1)


# %% pixels_without_end loses 11.9
# The grid stops one step before its upper end.
_feature_maps = feature_maps


def feature_maps(network, low, high, n):
    return _feature_maps(network, low, high - (high - low) / n, n)


# %% central_differences loses 11.2
# The gradient is a quotient of differences of the loss, not what the formulas give.
# says: Quotients of differences
def gradient_by_hand(inputs, targets, w1, b1, w2, b2):
    given = {"w1": w1, "b1": b1, "w2": w2, "b2": b2}

    def loss(w1, b1, w2, b2):
        hidden = 1 / (1 + np.exp(-(inputs @ w1.T + b1)))
        return np.mean((hidden @ w2.T + b2 - targets) ** 2)

    found = {"loss": loss(**given)}
    for name, array in given.items():
        slope = np.zeros_like(array)
        for place in np.ndindex(array.shape):
            h = np.zeros_like(array)
            h[place] = 1e-5
            more, less = ({**given, name: array + s * h} for s in (1, -1))
            slope[place] = (loss(**more) - loss(**less)) / 2e-5
        found[name] = slope
    return found


# %% formulas_for_torch loses 11.3
# The gradient is not the one of backward(): formulas or differences gave it.
# says: not what torch's backward
def gradient_by_torch(inputs, targets, w1, b1, w2, b2):
    tensor = torch.tensor(w1, requires_grad=True)
    tensor.sum().backward()
    return gradient_by_hand(inputs, targets, w1, b1, w2, b2)


# %% central_differences_for_torch loses 11.3
# The gradient is not the one of backward(): formulas or differences gave it.
# says: go backward instead
def gradient_by_torch(inputs, targets, w1, b1, w2, b2):
    def loss(w1, b1, w2, b2):
        hidden = 1 / (1 + np.exp(-(inputs @ w1.T + b1)))
        return np.mean((hidden @ w2.T + b2 - targets) ** 2)

    names, parameters = ("w1", "b1", "w2", "b2"), [w1.copy(), b1.copy(), w2.copy(), b2.copy()]
    found = {"loss": loss(*parameters)}
    for name, array in zip(names, parameters, strict=True):
        found[name] = np.zeros_like(array)
        for place in np.ndindex(array.shape):
            kept, each = array[place], []
            for step in (-2e-4, -1e-4, 1e-4, 2e-4):
                array[place] = kept + step
                each.append(loss(*parameters))
            array[place] = kept
            found[name][place] = (each[0] - 8 * each[1] + 8 * each[2] - each[3]) / 12e-4
    return found


# %% gradients_never_cleared loses 11.4
# The gradient of the epoch before is never cleared, so gradients add up.
# says: gradients of the epochs add up
_train = train


def train(network, inputs, targets, epochs, learning_rate, momentum):
    optimiser = torch.optim.SGD(network.parameters(), lr=learning_rate, momentum=momentum)
    losses = []
    for _ in range(epochs):
        loss = nn.functional.mse_loss(network(inputs), targets)
        loss.backward()
        optimiser.step()
        losses.append(loss.item())
    return losses


# %% loss_of_the_sum loses 11.4
# The loss is the sum of the squared errors over the outputs, not their mean.
def train(network, inputs, targets, epochs, learning_rate, momentum):
    optimiser = torch.optim.SGD(network.parameters(), lr=learning_rate, momentum=momentum)
    losses = []
    for _ in range(epochs):
        optimiser.zero_grad()
        loss = ((network(inputs) - targets) ** 2).sum(dim=1).mean()
        loss.backward()
        optimiser.step()
        losses.append(loss.item())
    return losses


# %% cleared_before_the_step loses 11.4
# The step finds no gradient: backward is missing, too late, or cleared before the step.
# says: this
# -         loss.backward()
# -         optimiser.step()
# -         losses.append(loss.item())
# +         loss.backward()
# +         optimiser.zero_grad()
# +         optimiser.step()
# +         losses.append(loss.item())


# %% solved_and_trained_for_show loses 11.5, 11.8
# The outputs are computed by least squares; afterwards forty steps of length 0 are made.
# says: steps along them did not lead
def solved(inputs, targets, hiddens, seed):
    rng = np.random.default_rng(seed)
    inputs, targets = np.asarray(inputs, dtype=float), np.asarray(targets, dtype=float)
    network = Network(inputs.shape[1], hiddens, targets.shape[1])
    train(network, torch.tensor(inputs).float(), torch.tensor(targets).float(), 20, 0.01, 0.0)
    best = np.inf
    for _ in range(3000):
        w1 = rng.normal(scale=4, size=(hiddens, inputs.shape[1]))
        b1 = -(w1 * rng.uniform(inputs.min(axis=0), inputs.max(axis=0), w1.shape)).sum(axis=1)
        hidden = 1 / (1 + np.exp(-(inputs @ w1.T + b1)))
        seen = np.hstack([hidden, np.ones((len(hidden), 1))])
        w2 = np.linalg.lstsq(np.vstack([seen, 1e-4 * np.eye(seen.shape[1])]),
                             np.vstack([targets, np.zeros((seen.shape[1], targets.shape[1]))]),
                             rcond=None)[0]  # fmt: skip
        error = np.abs(seen @ w2 - targets).max()
        if error < best:
            best, found = error, (w1, b1, w2[:-1].T, w2[-1])
        if best < 0.01 or hiddens > 10:
            break
    with torch.no_grad():
        for layer, values in zip(network.parameters(), found, strict=True):
            layer.copy_(torch.tensor(values))
    train(network, torch.tensor(inputs).float(), torch.tensor(targets).float(), 40, 0.0, 0.0)
    return network


def learn(inputs, targets, hiddens, seed):
    for attempt in range(10):
        network = solved(inputs, targets, hiddens, seed + 1000 * attempt)
        with torch.no_grad():
            if (network(inputs) - targets).abs().max() < 0.04:
                break
    return network


def fit(inputs, targets, seed):
    normalised, mean, deviation = normalise(inputs)
    return solved(normalised, targets, 40, seed), mean, deviation


# %% one_seed_for_all loses 11.5
# The weights do not follow from the seed: they are the same for every seed.
# says: the same weights as with seed
_learn = learn


def learn(inputs, targets, hiddens, seed):
    return _learn(inputs, targets, hiddens, 1)


# %% inputs_are_overwritten loses 11.6
# The mean is subtracted in the array of the inputs, which belongs to the caller.
# says: changed the inputs
# -     return (inputs - mean) / deviation, mean, deviation
# +     inputs -= mean
# +     inputs /= deviation
# +     return inputs, mean, deviation


# %% batches_never_cleared loses 11.7
# The gradient of the minibatch before is never cleared, so gradients add up.
# -         for batch in minibatches(len(inputs), batch_size, rng):
# -             optimiser.zero_grad()
# +         for batch in minibatches(len(inputs), batch_size, rng):


# %% logistic_outputs loses 11.1
# The outputs are logistic, too: none can be below 0 or above 1.
# -         return self.output(self.features(patterns))
# +         return torch.sigmoid(self.output(self.features(patterns)))


# %% features_before_the_logistic loses 11.1
# The features are the sums before the logistic function.
# -         return torch.sigmoid(self.hidden(patterns))
# -         ### END SOLUTION
# -
# -     def forward(self, patterns: torch.Tensor) -> torch.Tensor:
# -         """The outputs, shape (patterns, outputs); network(patterns) calls this."""
# -         ### BEGIN SOLUTION task 11.1: compute the outputs
# -         return self.output(self.features(patterns))
# +         return self.hidden(patterns)
# +         ### END SOLUTION
# +
# +     def forward(self, patterns: torch.Tensor) -> torch.Tensor:
# +         """The outputs, shape (patterns, outputs); network(patterns) calls this."""
# +         ### BEGIN SOLUTION task 11.1: compute the outputs
# +         return self.output(torch.sigmoid(self.features(patterns)))


# %% error_turned_around loses 11.2
# The error is targets minus outputs, so each gradient has the wrong sign.
# says: this
# -     error = hidden @ w2.T + b2 - targets
# +     error = targets - hidden @ w2.T - b2


# %% half_the_squared_error loses 11.2
# The factor 2 of the square's derivative is missing.
# says: this
# -     d2 = 2 * error / error.size
# +     d2 = error / error.size


# %% slope_of_the_sum loses 11.2
# The slope is that of tanh, 1 - h^2, not that of the logistic function.
# says: this
# -     d1 = d2 @ w2 * hidden * (1 - hidden)
# +     d1 = d2 @ w2 * (1 - hidden**2)


# %% sum_for_the_mean loses 11.3
# The loss adds up the squared errors instead of taking their mean.
# says: this
# -     loss = torch.mean((outputs - torch.tensor(targets, dtype=torch.float64)) ** 2)
# +     loss = torch.sum((outputs - torch.tensor(targets, dtype=torch.float64)) ** 2)


# %% loss_of_the_last_epoch loses 11.4
# Returns the last loss for every epoch.
# -         losses.append(loss.item())
# -     return losses
# -     ### END SOLUTION
# +         losses.append(loss.item())
# +     return losses[-1:] * epochs
# +     ### END SOLUTION


# %% adam_for_sgd loses 11.4
# Trains with Adam, which adapts its steps, and not with the plain gradient and momentum.
# -     optimiser = torch.optim.SGD(network.parameters(), lr=learning_rate, momentum=momentum)
# -     losses = []
# -     for _ in range(epochs):
# -         optimiser.zero_grad()
# +     optimiser = torch.optim.Adam(network.parameters(), lr=learning_rate)
# +     losses = []
# +     for _ in range(epochs):
# +         optimiser.zero_grad()


# %% nesterov loses 11.4
# The momentum is Nesterov's, which looks ahead.
# -     optimiser = torch.optim.SGD(network.parameters(), lr=learning_rate, momentum=momentum)
# -     losses = []
# -     for _ in range(epochs):
# -         optimiser.zero_grad()
# +     optimiser = torch.optim.SGD(
# +         network.parameters(), lr=learning_rate, momentum=momentum, nesterov=momentum > 0
# +     )
# +     losses = []
# +     for _ in range(epochs):
# +         optimiser.zero_grad()


# %% one_mean_for_all_columns loses 11.6
# All columns share the mean of all numbers.
# says: this
# -     mean, deviation = inputs.mean(axis=0), inputs.std(axis=0)
# +     mean, deviation = np.full(inputs.shape[1], inputs.mean()), inputs.std(axis=0)


# %% scaled_to_one loses 11.6
# Divides by the range of the column, not by the deviation.
# says: this
# -     deviation = np.where(np.ptp(inputs, axis=0) == 0, 1.0, deviation)
# +     deviation = np.where(np.ptp(inputs, axis=0) == 0, 1.0, np.ptp(inputs, axis=0))


# %% batches_of_equal_size loses 11.7
# The patterns are cut into as many batches of nearly equal size.
# says: this
# -     return [order[start : start + batch_size] for start in range(0, n, batch_size)]
# +     return np.array_split(order, -(-n // batch_size))


# %% loss_of_the_last_batch loses 11.7
# Returns the loss of each epoch's last minibatch, not that of the whole training set.
# -             losses.append(nn.functional.mse_loss(network(inputs), targets).item())
# +             losses.append(loss.item())


# %% momentum_begins_anew loses 11.7
# The momentum begins anew in each epoch: the optimiser is made again.
# -     for _ in range(epochs):
# -         for batch in minibatches(len(inputs), batch_size, rng):
# +     for _ in range(epochs):
# +         optimiser = torch.optim.SGD(network.parameters(), lr=learning_rate, momentum=momentum)
# +         for batch in minibatches(len(inputs), batch_size, rng):


# %% returns_no_normalisation loses 11.8
# Trains on normalised inputs, and returns the mean and the deviation of other ones.
# -     return network, mean, deviation
# +     return network, np.zeros_like(mean), np.ones_like(deviation)
# %% outputs_without_bias loses 11.1
# The outputs have no biases.
# -         self.output = nn.Linear(hiddens, outputs)
# +         self.output = nn.Linear(hiddens, outputs, bias=False)
# %% hidden_rectified loses 11.1
# The hidden neurons are rectified instead of logistic.
# -         return torch.sigmoid(self.hidden(patterns))
# +         return torch.relu(self.hidden(patterns))
# %% slope_of_the_outputs loses 11.2
# The outputs are taken for logistic on the way back, though they are linear.
# -     d2 = 2 * error / error.size
# +     outputs = error + targets
# +     d2 = 2 * error * outputs * (1 - outputs) / error.size
# %% mean_over_outputs_only loses 11.2
# The gradient is divided by the number of outputs, but not by the patterns.
# -     d2 = 2 * error / error.size
# +     d2 = 2 * error / error.shape[1]
# %% slope_at_the_sums loses 11.2
# The slope is taken of the sums before the logistic function, not of the activations.
# -     d1 = d2 @ w2 * hidden * (1 - hidden)
# +     sums = inputs @ w1.T + b1
# +     d1 = d2 @ w2 * sums * (1 - sums)
# %% root_of_the_loss loses 11.3
# The loss is the root of the mean squared error.
# -     loss.backward()
# -     gradients = (each.grad.numpy() for each in (w1, b1, w2, b2))
# +     loss = torch.sqrt(loss)
# +     loss.backward()
# +     gradients = (each.grad.numpy() for each in (w1, b1, w2, b2))
# %% logistic_outputs_by_torch loses 11.3
# The outputs go through the logistic function, too.
# -     outputs = hidden @ w2.T + b2
# +     outputs = torch.sigmoid(hidden @ w2.T + b2)
# %% learning_rate_falls loses 11.4
# The learning rate falls from epoch to epoch.
# -     for _ in range(epochs):
# -         optimiser.zero_grad()
# -         loss = nn.functional.mse_loss(network(inputs), targets)
# -         loss.backward()
# -         optimiser.step()
# -         losses.append(loss.item())
# +     for _ in range(epochs):
# +         optimiser.zero_grad()
# +         loss = nn.functional.mse_loss(network(inputs), targets)
# +         loss.backward()
# +         optimiser.step()
# +         for group in optimiser.param_groups:
# +             group["lr"] *= 0.99
# +         losses.append(loss.item())
# %% optimiser_anew_in_each_epoch loses 11.4
# The momentum has no effect: it is not handed on, or each epoch's new optimiser forgets it.
# -     for _ in range(epochs):
# -         optimiser.zero_grad()
# -         loss = nn.functional.mse_loss(network(inputs), targets)
# +     for _ in range(epochs):
# +         optimiser = torch.optim.SGD(network.parameters(), lr=learning_rate, momentum=momentum)
# +         optimiser.zero_grad()
# +         loss = nn.functional.mse_loss(network(inputs), targets)
# %% dampened_momentum loses 11.4
# The momentum is dampened: the gradient counts by 1 - momentum.
# -     optimiser = torch.optim.SGD(network.parameters(), lr=learning_rate, momentum=momentum)
# -     losses = []
# -     for _ in range(epochs):
# -         optimiser.zero_grad()
# +     optimiser = torch.optim.SGD(
# +         network.parameters(), lr=learning_rate, momentum=momentum, dampening=momentum
# +     )
# +     losses = []
# +     for _ in range(epochs):
# +         optimiser.zero_grad()
# %% mean_of_the_whole_table loses 11.6
# The mean and the deviation are those of all columns together.
# -     mean, deviation = inputs.mean(axis=0), inputs.std(axis=0)
# +     columns = inputs.shape[1]
# +     mean, deviation = np.full(columns, inputs.mean()), np.full(columns, inputs.std())
# %% variance_instead loses 11.6
# Divides by the variance instead of the standard deviation.
# -     mean, deviation = inputs.mean(axis=0), inputs.std(axis=0)
# +     mean, deviation = inputs.mean(axis=0), inputs.var(axis=0)
# %% order_sorted_in_batches loses 11.7
# The numbers in each batch are sorted.
# -     return [order[start : start + batch_size] for start in range(0, n, batch_size)]
# +     return [np.sort(order[start : start + batch_size]) for start in range(0, n, batch_size)]
# %% losses_of_the_last_batch loses 11.7
# Returns the loss of the last batch of each epoch instead of that of the whole training set.
# -             losses.append(nn.functional.mse_loss(network(inputs), targets).item())
# +             losses.append(nn.functional.mse_loss(network(inputs[batch]), targets[batch]).item())


# %% outputs_added_up_by_torch loses 11.3
# The squares of a pattern's outputs are added up; the mean goes over the outputs, too.
# says: this
# -     loss = torch.mean((outputs - torch.tensor(targets, dtype=torch.float64)) ** 2)
# +     loss = ((outputs - torch.tensor(targets, dtype=torch.float64)) ** 2).sum(dim=1).mean()


# %% mean_of_the_minibatches loses 11.7
# Returns the mean of the losses of the minibatches, while the network was still changing.
# says: this
# -         with torch.no_grad():
# -             losses.append(nn.functional.mse_loss(network(inputs), targets).item())
# +         losses.append(float(np.mean(found)))
# -         for batch in minibatches(len(inputs), batch_size, rng):
# +         found = []
# +         for batch in minibatches(len(inputs), batch_size, rng):
# -             loss = nn.functional.mse_loss(network(inputs[batch]), targets[batch])
# -             loss.backward()
# +             loss = nn.functional.mse_loss(network(inputs[batch]), targets[batch])
# +             found.append(loss.item())
# +             loss.backward()


# %% loss_before_the_epoch loses 11.7
# Returns the loss before each epoch instead of after it.
# says: this
# -         for batch in minibatches(len(inputs), batch_size, rng):
# +         with torch.no_grad():
# +             losses.append(nn.functional.mse_loss(network(inputs), targets).item())
# +         for batch in minibatches(len(inputs), batch_size, rng):
# -         with torch.no_grad():
# -             losses.append(nn.functional.mse_loss(network(inputs), targets).item())
# -     return losses
# +     return losses


# %% cleared_once_an_epoch loses 11.7
# The gradients are cleared once an epoch, so those of its minibatches add up.
# says: this
# -         for batch in minibatches(len(inputs), batch_size, rng):
# -             optimiser.zero_grad()
# +         optimiser.zero_grad()
# +         for batch in minibatches(len(inputs), batch_size, rng):


# %% softmax_for_the_features loses 11.1
# The hidden neurons share out a sum of 1 (softmax) instead of each having its own logistic value.
# says: this
# -         return torch.sigmoid(self.hidden(patterns))
# +         return torch.softmax(self.hidden(patterns), dim=1)


# %% smallest_and_range loses 11.6
# Subtracts the smallest value and divides by the range: mean and deviation are asked for.
# says: this
# -     mean, deviation = inputs.mean(axis=0), inputs.std(axis=0)
# +     mean, deviation = inputs.min(axis=0), np.ptp(inputs, axis=0)


# %% outputs_for_features loses 11.9
# Gives the outputs of the network instead of the activations of its hidden neurons.
# says: this
# -         return network.features(patterns).numpy().T.reshape(-1, n, n)
# +         return network(patterns).numpy().T.reshape(-1, n, n)


# %% targets_in_another_order loses 11.7
# A minibatch's targets are not those of its inputs: they stand in another order.
# says: this
# -             loss = nn.functional.mse_loss(network(inputs[batch]), targets[batch])
# -             loss.backward()
# +             loss = nn.functional.mse_loss(network(inputs[batch]), targets[np.sort(batch)])
# +             loss.backward()


# %% logistic_twice loses 11.1
# The features go through the logistic function once more on their way to the outputs.
# says: this
# -         return self.output(self.features(patterns))
# +         return self.output(torch.sigmoid(self.features(patterns)))


# %% slope_at_the_activations loses 11.2
# The slope is computed at the activations instead of the net inputs: sigma(h) (1 - sigma(h)).
# says: this
# -     d1 = d2 @ w2 * hidden * (1 - hidden)
# +     again = 1 / (1 + np.exp(-hidden))
# +     d1 = d2 @ w2 * again * (1 - again)


# %% always_the_same_network loses 11.5
# Each new network has the weights of the first one, since torch's seed is set again.
# says: learns from the same first weights
# -     torch.manual_seed(seed)
# -     while True:
# +     while True:
# +         torch.manual_seed(seed)


# %% mean_error_for_the_largest loses 11.5
# Stops when the mean squared error is below 0.05, though single outputs are farther away.
# says: what counts is the distance
# -                 if (network(inputs) - targets).abs().max() < 0.03:
# +                 if ((network(inputs) - targets) ** 2).mean() < 0.05:


# %% running_mean_of_gradients loses 11.4
# The gradient enters the running sum weakened by 1 - momentum, from the first step on.
# says: from the first step on
def train(network, inputs, targets, epochs, learning_rate, momentum):
    velocities = [torch.zeros_like(p) for p in network.parameters()]
    losses = []
    for _ in range(epochs):
        loss = ((network(inputs) - targets) ** 2).mean()
        gradients = torch.autograd.grad(loss, list(network.parameters()))
        share = 1 - momentum
        with torch.no_grad():
            for p, v, g in zip(network.parameters(), velocities, gradients, strict=True):
                v.mul_(momentum).add_(share * g)
                p.sub_(learning_rate * v)
        losses.append(float(loss))
    return losses


# %% tiny_number_added_to_deviations loses 11.6
# A tiny number is added to the deviations, so that none of them is 0.
# says: not a tiny number
# -     deviation = np.where(np.ptp(inputs, axis=0) == 0, 1.0, deviation)
# +     deviation = deviation + 1e-8


# %% small_unit_for_never_changing loses 11.6
# Takes a column of a small unit for one that never changes.
# says: this
# -     deviation = np.where(np.ptp(inputs, axis=0) == 0, 1.0, deviation)
# +     deviation = np.where(deviation < 1e-3, 1.0, deviation)


# %% biases_of_the_last_pattern loses 11.2
# The gradients of the biases are those of the last pattern: they are set, not added up.
# says: this
# -         "b1": d1.sum(axis=0),
# +         "b1": d1[-1],
# -         "b2": d2.sum(axis=0),
# +         "b2": d2[-1],


# %% one_pattern_less_in_the_divisor loses 11.2
# Divides by (n - 1) m, one pattern too few.
# says: this
# -     d2 = 2 * error / error.size
# +     divisor = (len(error) - 1) * error.shape[1]
# +     d2 = 2 * error / divisor
# -         "loss": np.mean(error**2),
# +         "loss": np.sum(error**2) / divisor,


# %% losses_of_the_minibatches loses 11.7
# The loss of an epoch is the mean of its minibatches' losses, each before its step.
# says: this
# -         for batch in minibatches(len(inputs), batch_size, rng):
# +         total = 0.0
# +         for batch in minibatches(len(inputs), batch_size, rng):
# -             optimiser.step()
# -         with torch.no_grad():
# -             losses.append(nn.functional.mse_loss(network(inputs), targets).item())
# +             optimiser.step()
# +             total += loss.item() * len(batch)
# +         losses.append(total / len(inputs))


# %% mean_of_the_losses_so_far loses 11.4
# Gives the mean of the losses so far, not that of each epoch.
# says: this
# -         losses.append(loss.item())
# -     return losses
# +         losses.append(loss.item())
# +     return [sum(losses[: i + 1]) / (i + 1) for i in range(epochs)]


# %% loss_of_the_first_epoch loses 11.4
# Gives the loss of the first epoch for each epoch.
# says: this|Every epoch has the same loss
# -         losses.append(loss.item())
# -     return losses
# +         losses.append(loss.item())
# +     return [losses[0]] * epochs


# %% a_step_for_each_pattern loses 11.4
# Makes a step for each pattern: one for all of them in each epoch is asked for.
# says: this
# -         optimiser.zero_grad()
# -         loss = nn.functional.mse_loss(network(inputs), targets)
# -         loss.backward()
# -         optimiser.step()
# -         losses.append(loss.item())
# -     return losses
# +         losses.append(nn.functional.mse_loss(network(inputs), targets).item())
# +         for pattern, target in zip(inputs, targets, strict=True):
# +             optimiser.zero_grad()
# +             nn.functional.mse_loss(network(pattern), target).backward()
# +             optimiser.step()
# +     return losses


# %% one_loss_more loses 11.4
# Gives one loss more, that after the last step.
# says: this
# -         losses.append(loss.item())
# -     return losses
# +         losses.append(loss.item())
# +     return [*losses, nn.functional.mse_loss(network(inputs), targets).item()]


# %% absolute_errors_trained loses 11.4
# Trains on the mean absolute error, not on the mean square.
# says: this
# -         loss = nn.functional.mse_loss(network(inputs), targets)
# -         loss.backward()
# -         optimiser.step()
# -         losses.append(loss.item())
# -     return losses
# +         loss = nn.functional.l1_loss(network(inputs), targets)
# +         loss.backward()
# +         optimiser.step()
# +         losses.append(loss.item())
# +     return losses


# %% divided_by_the_hidden_neurons loses 11.2
# What goes back to the hidden neurons is divided by their number: it is no mean over them.
# says: this
# -     d1 = d2 @ w2 * hidden * (1 - hidden)
# +     d1 = d2 @ w2 * hidden * (1 - hidden) / hidden.shape[1]


# %% own_weights_left_out loses 11.2
# The weights of the outputs are left out on the way back: each hidden neuron gets the sum of D2.
# says: this
# -     d1 = d2 @ w2 * hidden * (1 - hidden)
# +     d1 = d2.sum(axis=1, keepdims=True) * hidden * (1 - hidden)


# %% as_many_batches_as_their_size loses 11.7
# Makes batch_size minibatches: batch_size is how many patterns are in each.
# says: this
# -     return [order[start : start + batch_size] for start in range(0, n, batch_size)]
# +     return np.array_split(order, batch_size)


# %% every_so_many_in_a_batch loses 11.7
# Every so many numbers of the order make a minibatch, not those beside each other.
# says: this
# -     return [order[start : start + batch_size] for start in range(0, n, batch_size)]
# +     many = -(-n // batch_size)
# +     return [order[start::many] for start in range(many)]


# %% steps_of_the_first_minibatch loses 11.7
# Only the first minibatch of each epoch makes a step.
# says: this
# -             optimiser.step()
# -         with torch.no_grad():
# +             optimiser.step()
# +             break
# +         with torch.no_grad():


# %% loss_of_the_first_epoch_in_batches loses 11.7
# Gives the loss before the first epoch for each epoch.
# says: this|Every epoch has the same loss
_train_in_batches = train_in_batches


def train_in_batches(network, inputs, targets, *rest, **more):
    first = nn.functional.mse_loss(network(inputs), targets).item()
    return [first for _ in _train_in_batches(network, inputs, targets, *rest, **more)]


# %% highest_row_first loses 11.9
# The rows go from the high end down: row 0 belongs to the low end.
# says: this
_feature_maps = feature_maps


def feature_maps(network, low, high, n):
    return _feature_maps(network, low, high, n)[:, ::-1].copy()


# %% neurons_on_the_last_axis loses 11.9
# The neurons are on the last axis: they come first.
# says: this
_feature_maps = feature_maps


def feature_maps(network, low, high, n):
    return np.moveaxis(_feature_maps(network, low, high, n), 0, -1).copy()


# %% both_inputs_alike loses 11.9
# Both inputs are that of the column: the second one is that of the row.
# says: this
# -     patterns = torch.stack([first.ravel(), second.ravel()], dim=1)
# +     patterns = torch.stack([first.ravel(), first.ravel()], dim=1)


# %% first_neuron_only loses 11.9
# All maps are that of the first hidden neuron.
# says: this
_feature_maps = feature_maps


def feature_maps(network, low, high, n):
    return np.repeat(_feature_maps(network, low, high, n)[:1], network.hidden.out_features, axis=0)


# %% deviation_0_of_what_never_changes loses 11.6
# A column that never changes gets the deviation 0: 1 is asked for.
# says: this
def normalise(inputs):
    mean, deviation = inputs.mean(axis=0), inputs.std(axis=0)
    deviation[np.ptp(inputs, axis=0) == 0] = 0.0
    return (inputs - mean) / np.where(deviation == 0, 1.0, deviation), mean, deviation


# %% reshaped_without_transposing loses 11.9
# Reshapes the activations without transposing them first: neurons and pixels are mixed up.
# says: this
# -         return network.features(patterns).numpy().T.reshape(-1, n, n)
# +         return network.features(patterns).numpy().reshape(-1, n, n)


# %% one_pattern_squeezed loses 11.1
# With one pattern the outputs lose their first dimension (squeeze): (1, outputs) is asked for.
# says: this
# -         return self.output(self.features(patterns))
# +         return self.output(self.features(patterns)).squeeze(0)


# %% targets_in_a_row loses 11.3
# With one output the targets lose a dimension (squeeze), so each output is compared with all targets.
# says: this
# -     loss = torch.mean((outputs - torch.tensor(targets, dtype=torch.float64)) ** 2)
# +     loss = torch.mean((outputs - torch.tensor(targets, dtype=torch.float64).squeeze()) ** 2)


# %% tiny_unit_for_constant loses 11.6
# Takes a column of a very small unit for one that never changes.
# -     deviation = np.where(np.ptp(inputs, axis=0) == 0, 1.0, deviation)
# +     deviation = np.where(deviation < 1e-6, 1.0, deviation)


# %% single_output_for_all_targets loses 11.8
# Makes a network with one output, whatever the number of targets: the targets share it.
# says: one for each of the 2
# -     network = Network(inputs.shape[1], 20, targets.shape[1])
# -     patterns = torch.tensor(normalised, dtype=torch.float32)
# +     network = Network(inputs.shape[1], 20, 1)
# +     patterns = torch.tensor(normalised, dtype=torch.float32)


# %% errors_of_the_last_output loses 11.2
# The hidden neurons get the error of the last output only: add up those of all outputs.
# says: this
import numpy as np


def gradient_by_hand(inputs, targets, w1, b1, w2, b2):
    n, m = targets.shape
    h = 1.0 / (1.0 + np.exp(-(np.dot(inputs, w1.T) + b1)))
    y = np.dot(h, w2.T) + b2
    slope = h * (1.0 - h)
    g_w2, g_b2 = np.zeros(w2.shape), np.zeros(b2.shape)
    for j in range(m):
        delta = 2.0 * (y[:, j] - targets[:, j]) / (n * m)
        g_w2[j] = np.dot(delta, h)
        g_b2[j] = delta.sum()
        back = np.outer(delta, w2[j]) * slope
    return {
        "loss": ((y - targets) ** 2).sum() / (n * m),
        "w1": np.dot(back.T, inputs),
        "b1": back.sum(axis=0),
        "w2": g_w2,
        "b2": g_b2,
    }


# %% bias_without_the_slope loses 11.2
# The gradient of the hidden biases lacks the slope of the logistic function.
# says: this
# -         "b1": d1.sum(axis=0),
# +         "b1": (d2 @ w2).sum(axis=0),


# %% backward_output_by_output loses 11.3
# Calls backward for the error of each output: the gradients add up, but the loss is their mean.
# says: this
import torch


def gradient_by_torch(inputs, targets, w1, b1, w2, b2):
    def tensor(array, grad=False):
        return torch.tensor(array, dtype=torch.float64, requires_grad=grad)

    x, t = tensor(inputs), tensor(targets)
    parameters = {
        "w1": tensor(w1, True),
        "b1": tensor(b1, True),
        "w2": tensor(w2, True),
        "b2": tensor(b2, True),
    }
    h = torch.sigmoid(x @ parameters["w1"].T + parameters["b1"])
    losses = []
    for j in range(t.shape[1]):
        y = h @ parameters["w2"][j] + parameters["b2"][j]
        loss = ((y - t[:, j]) ** 2).mean()
        loss.backward(retain_graph=True)
        losses.append(loss.item())
    result = {name: p.grad.numpy() for name, p in parameters.items()}
    result["loss"] = sum(losses) / len(losses)
    return result


# %% best_weights_loaded loses 11.4
# Puts back the weights of the epoch with the lowest loss: those after the last step are asked for.
# says: this
import copy

import torch


def train(network, inputs, targets, epochs, learning_rate, momentum):
    optimizer = torch.optim.SGD(network.parameters(), lr=learning_rate, momentum=momentum)
    losses, lowest, best = [], float("inf"), None
    for _ in range(epochs):
        optimizer.zero_grad()
        loss = torch.nn.functional.mse_loss(network(inputs), targets)
        losses.append(loss.item())
        if losses[-1] < lowest:
            lowest, best = losses[-1], copy.deepcopy(network.state_dict())
        loss.backward()
        optimizer.step()
    if best is not None:
        network.load_state_dict(best)
    return losses


# %% shuffles_what_is_shuffled loses 11.7
# Shuffles the patterns that the epoch before has shuffled: the order of each epoch is that of the training set as it was given.
# says: this
import numpy as np
import torch


def train_in_batches(network, inputs, targets, epochs, batch_size, learning_rate, momentum, seed):
    generator = np.random.default_rng(seed)
    sgd = torch.optim.SGD(network.parameters(), lr=learning_rate, momentum=momentum)
    mse = torch.nn.MSELoss()
    history = []
    for _ in range(epochs):
        batches = minibatches(len(inputs), batch_size, generator)
        order = np.concatenate(batches)
        inputs, targets = inputs[order], targets[order]
        start = 0
        for batch in batches:
            stop = start + len(batch)
            sgd.zero_grad()
            mse(network(inputs[start:stop]), targets[start:stop]).backward()
            sgd.step()
            start = stop
        with torch.no_grad():
            history.append(mse(network(inputs), targets).item())
    return history


# %% allclose_for_a_constant_column loses 11.6
# Asks np.allclose whether a column changes: large numbers that differ by little count as constant.
# says: only if all of its numbers are equal
import numpy as np


def normalise(inputs):
    mean, deviation = inputs.mean(axis=0), inputs.std(axis=0)
    for i in range(inputs.shape[1]):
        if np.allclose(inputs[:, i], inputs[0, i], atol=0):
            deviation[i] = 1.0
    return (inputs - mean) / deviation, mean, deviation


# %% quotient_of_exponentials loses 11.1
# Writes the logistic function as e^z / (1 + e^z), which is NaN for large z.
# says: this
import torch
from torch import nn


class Network(nn.Module):
    def __init__(self, inputs, hiddens, outputs):
        super().__init__()
        self.hidden = nn.Linear(inputs, hiddens)
        self.output = nn.Linear(hiddens, outputs)

    def features(self, patterns):
        z = self.hidden(patterns)
        return torch.exp(z) / (1 + torch.exp(z))

    def forward(self, patterns):
        h = self.features(patterns)
        return self.output(h)


# %% logistic_of_twice_z loses 11.3
# Takes (1 + tanh z) / 2 for the logistic function: it is that of 2 z.
# says: this
import numpy as np
import torch


def gradient_by_torch(inputs, targets, w1, b1, w2, b2):
    x = torch.from_numpy(np.asarray(inputs, dtype=np.float64))
    t = torch.from_numpy(np.asarray(targets, dtype=np.float64))
    params = {}
    for name, array in [("w1", w1), ("b1", b1), ("w2", w2), ("b2", b2)]:
        params[name] = torch.tensor(array, dtype=torch.float64, requires_grad=True)
    net = torch.nn.functional.linear(x, params["w1"], params["b1"])
    hidden = 0.5 * (1 + net.tanh())
    y = torch.nn.functional.linear(hidden, params["w2"], params["b2"])
    loss = torch.nn.MSELoss()(y, t)
    loss.backward()
    out = {name: p.grad.detach().numpy() for name, p in params.items()}
    out["loss"] = loss.item()
    return out


# %% hidden_of_the_last_pattern loses 11.2
# Uses the hidden neurons of the last pattern for all in the way back.
# says: this
import numpy as np


def gradient_by_hand(inputs, targets, w1, b1, w2, b2):
    n, m = targets.shape
    outputs = []
    for x in inputs:
        h = 1 / (1 + np.exp(-(w1 @ x + b1)))
        outputs.append(w2 @ h + b2)
    errors = np.array(outputs) - targets
    result = {"w1": np.zeros_like(w1), "b1": np.zeros_like(b1)}
    result |= {"w2": np.zeros_like(w2), "b2": np.zeros_like(b2)}
    for x, error in zip(inputs, errors, strict=False):
        delta2 = 2 * error / (n * m)
        delta1 = (w2.T @ delta2) * h * (1 - h)
        result["w2"] += np.outer(delta2, h)
        result["b2"] += delta2
        result["w1"] += np.outer(delta1, x)
        result["b1"] += delta1
    result["loss"] = float((errors**2).sum() / (n * m))
    return result


# %% constant_if_ends_are_equal loses 11.6
# Takes a column for one that never changes if its first and last values are equal.
# says: this
import numpy as np


def normalise(inputs):
    n, columns = inputs.shape
    mean, deviation = np.zeros(columns), np.ones(columns)
    result = np.zeros((n, columns))
    for c in range(columns):
        column = np.array(inputs[:, c], dtype=float)
        mean[c] = column.sum() / n
        if column[0] != column[-1]:
            deviation[c] = np.sqrt(((column - mean[c]) ** 2).sum() / n)
        result[:, c] = (column - mean[c]) / deviation[c]
    return result, mean, deviation


# %% mean_of_batch_losses loses 11.7
# Gives the mean of the losses of the minibatches for the loss of all patterns.
# says: this
import numpy as np
import torch


def train_in_batches(network, inputs, targets, epochs, batch_size, learning_rate, momentum, seed):
    rng = np.random.default_rng(seed)
    sgd = torch.optim.SGD(network.parameters(), lr=learning_rate, momentum=momentum)

    def error(batch):
        return torch.mean((network(inputs[batch]) - targets[batch]) ** 2)

    losses = []
    for _epoch in range(epochs):
        batches = minibatches(len(inputs), batch_size, rng)
        for batch in batches:
            sgd.zero_grad()
            error(batch).backward()
            sgd.step()
        with torch.no_grad():
            losses.append(float(np.mean([error(batch).item() for batch in batches])))
    return losses
