# ---
# jupyter:
#   jupytext:
#     text_representation:
#       extension: .py
#       format_name: percent
#   kernelspec:
#     display_name: Python 3
#     language: python
#     name: python3
# ---

# %% [markdown]
# # Exercise 11. Back-propagation
#
# The text is `README.md`. Fill in the functions one after another. `botschool grade 11` grades
# them, `botschool grade 11.1` one task.

# %%
"""Exercise 11: a network that learns from examples; its gradient by hand and by torch."""

import numpy as np
import torch
from torch import nn

# %% [markdown]
# A *training set* is a pair of arrays: `inputs` with one pattern in each row, `targets` with what
# the network should answer, in the same row. They can have any number of rows and columns.
#
# ## Task 11.1. The network
#
# Hidden neurons with the logistic function (torch calls it `torch.sigmoid`), and linear outputs.
# `nn.Linear(a, b)` is a layer of b neurons that each see a inputs, weights and biases included.


# %%
class Network(nn.Module):
    """inputs -> hidden neurons (logistic) -> outputs (linear).

    The layers are `self.hidden` and `self.output`, made by nn.Linear.
    """

    def __init__(self, inputs: int, hiddens: int, outputs: int) -> None:
        super().__init__()
        raise NotImplementedError("task 11.1: make the two layers")

    def features(self, patterns: torch.Tensor) -> torch.Tensor:
        """The activations of the hidden neurons, shape (patterns, hiddens)."""
        raise NotImplementedError("task 11.1: compute the hidden neurons")

    def forward(self, patterns: torch.Tensor) -> torch.Tensor:
        """The outputs, shape (patterns, outputs); network(patterns) calls this."""
        raise NotImplementedError("task 11.1: compute the outputs")


# %% [markdown]
# ## Task 11.2. The gradient by hand
#
# Only NumPy and the formulas of `README.md`: torch and complex numbers are refused, and differences
# of the loss, (L(w + h) - L(w)) / h, are not exact enough. X holds the inputs (n rows), T the
# targets (m columns). The four gradients:
#
# $$\frac{\partial L}{\partial W_2} = D_2^\top H \qquad
# \frac{\partial L}{\partial b_2} = \textstyle\sum_{rows} D_2 \qquad
# \frac{\partial L}{\partial W_1} = D_1^\top X \qquad
# \frac{\partial L}{\partial b_1} = \sum_{rows} D_1$$


# %%
def gradient_by_hand(
    inputs: np.ndarray,
    targets: np.ndarray,
    w1: np.ndarray,
    b1: np.ndarray,
    w2: np.ndarray,
    b2: np.ndarray,
) -> dict:
    """The loss and its gradient.

    Shapes: inputs (n, i), targets (n, m), w1 (h, i), b1 (h,), w2 (m, h), b2 (m,). Returns a dict
    with "loss", a number, and "w1", "b1", "w2", "b2": the gradient with respect to each, in the
    shape of each.
    """
    raise NotImplementedError("task 11.2: go forward, then backward")


# %% [markdown]
# ## Task 11.3. The gradient by torch
#
# torch keeps a record of what is computed from tensors that were made with `requires_grad=True`.
# `loss.backward()` goes through this record backward, and leaves the gradient in the `.grad` of
# each of them. So write only the forward part.


# %%
def gradient_by_torch(
    inputs: np.ndarray,
    targets: np.ndarray,
    w1: np.ndarray,
    b1: np.ndarray,
    w2: np.ndarray,
    b2: np.ndarray,
) -> dict:
    """The same as `gradient_by_hand`, by torch's backward(); NumPy arrays in and out.

    In double precision, torch.tensor(w1, dtype=torch.float64, requires_grad=True), both functions
    agree to many digits; single precision will do.
    """
    raise NotImplementedError("task 11.3: let torch find the gradient")


# %% [markdown]
# ## Task 11.4. The loop
#
# An *epoch* is one pass through the training set. In each: clear the old gradient, compute the
# outputs and the loss, go backward, step downhill. The optimiser is
# `torch.optim.SGD(network.parameters(), lr=learning_rate, momentum=momentum)`.


# %%
def train(
    network: nn.Module,
    inputs: torch.Tensor,
    targets: torch.Tensor,
    epochs: int,
    learning_rate: float,
    momentum: float,
) -> list[float]:
    """Trains the network, one step in each epoch, on the mean squared error of all patterns.

    inputs (n, i) and targets (n, m) are tensors. The network is changed. Returns the loss of each
    epoch, as it was before the step: a list of `epochs` numbers.
    """
    raise NotImplementedError("task 11.4: train the network")


# %% [markdown]
# ## Task 11.5. Exclusive or
#
# The classic training set: four corners of a square, of which opposite ones belong together.
#
# | input | target |
# |---|---|
# | 0, 0 | 0 |
# | 0, 1 | 1 |
# | 1, 0 | 1 |
# | 1, 1 | 0 |
#
# No straight line separates the two kinds, so no single neuron can tell them apart. Two hidden
# neurons can, but training may get stuck. Then begin anew.
#
# Here and in task 11.8 the network must be trained, step by step along gradients (`train`, or those
# of task 11.2).


# %%
def learn(inputs: torch.Tensor, targets: torch.Tensor, hiddens: int, seed: int) -> Network:
    """A trained network, of which every output is within 0.05 of its target.

    Gets XOR, or corners of another square with other targets, or of a cube. The weights follow
    from the seed. A network that is stuck is replaced by a new one. Seconds are enough.
    """
    raise NotImplementedError("task 11.5: train until it is learnt")


# %% [markdown]
# ## Task 11.6. Normalisation
#
# Shift and scale each column to mean 0 and standard deviation 1.


# %%
def normalise(inputs: np.ndarray) -> tuple[np.ndarray, np.ndarray, np.ndarray]:
    """The inputs with mean 0 and standard deviation 1 in each column, the mean, the deviation.

    inputs has the shape (n, i) and stays as it is, mean and deviation have (i,). The deviation is
    that of NumPy (which divides by n). A column that never changes gets the deviation 1, and so
    becomes 0; mind that rounding may make a number such as 1e-17 of its deviation, and that a
    column of a very small unit does change.
    """
    raise NotImplementedError("task 11.6: normalise each column")


# %% [markdown]
# ## Task 11.7. Minibatches
#
# Shuffle the patterns in each epoch, cut them into minibatches, and step after each.


# %%
def minibatches(n: int, batch_size: int, rng: np.random.Generator) -> list[np.ndarray]:
    """The numbers 0 to n - 1, shuffled and cut into arrays of batch_size; the last may be smaller.

    The order is that of one call of rng.permutation(n).
    """
    raise NotImplementedError("task 11.7: shuffle and cut")


def train_in_batches(
    network: nn.Module,
    inputs: torch.Tensor,
    targets: torch.Tensor,
    epochs: int,
    batch_size: int,
    learning_rate: float,
    momentum: float,
    seed: int,
) -> list[float]:
    """As `train`, but with a step for each minibatch.

    np.random.default_rng(seed) makes the minibatches of all epochs, one epoch after another.
    Returns the loss over the whole training set after each epoch.
    """
    raise NotImplementedError("task 11.7: train in minibatches")


# %% [markdown]
# ## Task 11.8. Any training set
#
# All of it together, for data that you have not seen: a few hundred patterns of one to three
# inputs, in any units, and one or two targets of ordinary size (about -3 to 3). What counts is how
# well the network does on *other* patterns of the same kind.


# %%
def fit(inputs: np.ndarray, targets: np.ndarray, seed: int) -> tuple:
    """A network for this training set; returns (network, mean, deviation).

    It is used as network((inputs - mean) / deviation), on patterns that it was not trained on, and
    must explain 90 % of the variance of each of their targets. Choose the number of hidden neurons
    and the hyperparameters yourself. Seconds are enough.
    """
    raise NotImplementedError("task 11.8: normalise, then train in minibatches")


# %% [markdown]
# ## Task 11.9. What the hidden neurons see
#
# Activate the network on a grid of points of the input plane: each hidden neuron gives a picture,
# its *feature*.


# %%
def feature_maps(network: nn.Module, low: float, high: float, n: int) -> np.ndarray:
    """The hidden activations over the input plane, a NumPy array of shape (hiddens, n, n).

    Element [k, row, column] is neuron k's activation for the first input x[column] and the second
    input x[row], where x = np.linspace(low, high, n). network.features(patterns) gives the
    activations.
    """
    raise NotImplementedError("task 11.9: draw the features over the input plane")


# %% [markdown]
# ## Features and losses
#
# `botschool show 11` runs this part.

# %%
if __name__ == "__main__":
    from botschool.course import draw_bands, draw_features

    corners = torch.tensor([[0.0, 0.0], [0.0, 1.0], [1.0, 0.0], [1.0, 1.0]])
    xor = torch.tensor([[0.0], [1.0], [1.0], [0.0]])
    rng = np.random.default_rng(1)
    points = torch.tensor(rng.uniform(-0.5, 1.5, (300, 2)), dtype=torch.float32)
    disc = ((points - 0.5).norm(dim=1, keepdim=True) < 0.6).float()
    torch.manual_seed(1)
    for_disc = Network(2, 6, 1)
    train_in_batches(for_disc, points, disc, 300, 10, 0.1, 0.9, seed=1)
    rows = {}
    for title, network, inputs, targets in (
        ("XOR, 2 hidden neurons", learn(corners, xor, 2, seed=1), corners, xor),
        ("XOR, 5 hidden neurons", learn(corners, xor, 5, seed=1), corners, xor),
        ("a disc, 6 hidden neurons", for_disc, points, disc),
    ):
        maps = feature_maps(network, -0.5, 1.5, 120)
        weights, bias = (p.detach().numpy()[0] for p in network.output.parameters())
        output = np.tensordot(weights, maps, axes=1) + bias
        rows[title] = (inputs.numpy(), targets.numpy()[:, 0], output, maps, weights)
    draw_features("features.png", rows, -0.5, 1.5)

    raw = rng.normal([1000, 0.02], [20, 0.005], (200, 2))
    normalised, _, _ = normalise(raw)
    wanted = torch.tensor(np.sin(2 * normalised[:, :1]) * normalised[:, 1:], dtype=torch.float32)
    curves = {}
    for name, data, batch_size in (
        ("raw, minibatches of 10", raw, 10),
        ("normalised, all 200 at once", normalised, 200),
        ("normalised, minibatches of 10", normalised, 10),
    ):
        patterns, losses = torch.tensor(data, dtype=torch.float32), []
        for seed in (1, 2, 3):
            torch.manual_seed(seed)
            network = Network(2, 20, 1)
            losses.append(
                train_in_batches(network, patterns, wanted, 100, batch_size, 0.05, 0.9, seed)
            )
        logarithms = np.log10(losses)
        curves[name] = (logarithms.mean(axis=0), logarithms.std(axis=0, ddof=1))
    labels = ("epoch", "mean squared error (its logarithm to base 10)")
    draw_bands("losses.png", np.arange(1, 101), curves, "3 networks each", labels)
