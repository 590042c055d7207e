"""Regression by back-propagation, whole and in one file. Read it from top to bottom.

A network with one hidden layer learns to answer each input pattern with its target. At intervals it
prints the activations of all neurons, and at the end a picture shows what it has learnt.

    python lib/walkthroughs/regression.py
    python lib/walkthroughs/regression.py --training_set parity --nhiddens 5
    python lib/walkthroughs/regression.py --training_set disc --nhiddens 6 --batch_size 10
    python lib/walkthroughs/regression.py --training_set wave --nhiddens 10 --batch_size 10

Rumelhart, Hinton and Williams, Learning representations by back-propagating errors, 1986.
"""

from __future__ import annotations

import itertools
from dataclasses import dataclass
from pathlib import Path

import numpy as np
import torch
from shared import new_folder, read_hyperparameters, run
from torch import nn

from botschool.config import hyper
from botschool.course import draw_features

SETS = {
    "xor": "4 corners of a square",
    "parity": "8 corners of a cube",
    "disc": "200 points of a square, inside or outside of a disc",
    "wave": "60 numbers, each with two targets",
}


# 1. Hyperparameters ---------------------------------------------------------------------------
@dataclass
class Hyperparameters:
    """Hyperparameters; the defaults are those of XOR."""

    training_set: str = hyper("xor", "what to learn", choices=SETS)
    seed: int = hyper(1, "decides the first weights and the order of the patterns", low=0)
    nhiddens: int = hyper(2, "hidden neurons", low=1, high=1000)
    epochs: int = hyper(2000, "passes through the training set, at most", low=1)
    batch_size: int = hyper(1, "patterns in a minibatch: one step is made for each", low=1)
    learning_rate: float = hyper(0.1, "length of a step, per unit of the gradient", above=0)
    momentum: float = hyper(0.9, "share of the last step that is added to the next", low=0, high=1)
    enough: float = hyper(0.0001, "training ends when the mean squared error is below", low=0)
    print_every: int = hyper(50, "epochs between two looks at the network", low=1)


# 2. Training sets -----------------------------------------------------------------------------
def training_set(name: str, seed: int) -> tuple[torch.Tensor, torch.Tensor]:
    """Return inputs (patterns, inputs) and targets (patterns, outputs). Add your own here."""
    rng = np.random.default_rng(seed)
    if name == "xor":
        inputs = np.array([[0, 0], [0, 1], [1, 0], [1, 1]])
        targets = np.array([[0], [1], [1], [0]])
    elif name == "parity":
        inputs = np.array(list(itertools.product((0, 1), repeat=3)))
        targets = inputs.sum(axis=1, keepdims=True) % 2
    elif name == "disc":
        inputs = rng.uniform(-0.5, 1.5, (200, 2))
        targets = np.linalg.norm(inputs - 0.5, axis=1, keepdims=True) < 0.6
    else:
        inputs = np.linspace(-2, 2, 60)[:, None]
        targets = np.concatenate([np.sin(2 * inputs), np.cos(3 * inputs)], axis=1)
    return torch.tensor(inputs, dtype=torch.float32), torch.tensor(targets, dtype=torch.float32)


# 3. The network -------------------------------------------------------------------------------
class Network(nn.Module):
    """inputs -> hidden neurons (logistic) -> outputs (linear)."""

    def __init__(self, inputs: int, nhiddens: int, outputs: int) -> None:
        super().__init__()
        self.hidden = nn.Linear(inputs, nhiddens)
        self.output = nn.Linear(nhiddens, outputs)

    def features(self, patterns: torch.Tensor) -> torch.Tensor:
        """Return the activations of the hidden neurons, shape (patterns, nhiddens)."""
        return torch.sigmoid(self.hidden(patterns))

    def forward(self, patterns: torch.Tensor) -> torch.Tensor:
        """Return the outputs, shape (patterns, outputs)."""
        return self.output(self.features(patterns))


# 4. A look at it ------------------------------------------------------------------------------
@torch.no_grad()  # no gradients are needed here
def show_network(network: Network, inputs: torch.Tensor, targets: torch.Tensor) -> None:
    """Print the activations for the first patterns, input -> hidden -> output, and the parameters.

    A tensor becomes numbers by .numpy(); a parameter, whose history torch records, by
    .detach().numpy().
    """
    hidden, outputs = network.features(inputs), network(inputs)
    for i in range(min(8, len(inputs))):
        layers = (words(each[i].numpy()) for each in (inputs, hidden, outputs))
        error = words((targets[i] - outputs[i]).numpy())
        print("    " + "  ->  ".join(layers) + f"    error {error}")
    if len(inputs) > 8:
        print(f"    ... and {len(inputs) - 8} more")
    if sum(parameter.numel() for parameter in network.parameters()) <= 40:
        for name, parameter in network.named_parameters():
            print(f"    {name:14s} {words(parameter.detach().numpy().ravel())}")


def words(numbers: np.ndarray) -> str:
    return " ".join(f"{number:5.2f}" for number in numbers)


# 5. Learning ----------------------------------------------------------------------------------
def train(
    h: Hyperparameters,
    inputs: torch.Tensor,
    targets: torch.Tensor,
    look=lambda epoch, net, loss: None,
) -> tuple[Network, list[float]]:
    """Return a network trained from the seed, and its loss (mean squared error) before each epoch.

    look(epoch, network, loss) is called every print_every epochs, and at the end.
    """
    torch.manual_seed(h.seed)
    network = Network(inputs.shape[1], h.nhiddens, targets.shape[1])
    optimiser = torch.optim.SGD(network.parameters(), lr=h.learning_rate, momentum=h.momentum)
    losses: list[float] = []
    for epoch in range(h.epochs + 1):
        with torch.no_grad():
            losses.append(nn.functional.mse_loss(network(inputs), targets).item())
        done = losses[-1] < h.enough or epoch == h.epochs
        if done or epoch % h.print_every == 0:
            look(epoch, network, losses[-1])
        if done:
            break
        for batch in torch.randperm(len(inputs)).split(h.batch_size):
            optimiser.zero_grad()  # forget the last gradient
            loss = nn.functional.mse_loss(network(inputs[batch]), targets[batch])
            loss.backward()  # how does the loss change with each parameter?
            optimiser.step()  # change each parameter so that the loss falls
    return network, losses


# 6. The picture -------------------------------------------------------------------------------
@torch.no_grad()
def draw(file: Path, network: Network, inputs: torch.Tensor, targets: torch.Tensor, title: str):
    """Draw the features over the input plane if there are two inputs; else
    outputs beside targets.
    """
    if inputs.shape[1] == 2:
        low, high, n = -0.5, 1.5, 150
        x = torch.linspace(low, high, n)
        second, first = torch.meshgrid(x, x, indexing="ij")
        plane = torch.stack([first.ravel(), second.ravel()], dim=1)
        features = network.features(plane).numpy().T.reshape(-1, n, n)
        output = network(plane)[:, 0].numpy().reshape(n, n)
        weights = network.output.weight[0].numpy()
        row = (inputs.numpy(), targets[:, 0].numpy(), output, features, weights)
        draw_features(file, {title: row}, low, high)
        return
    from matplotlib.figure import Figure

    figure = Figure(figsize=(8, 4.5), layout="constrained")
    axes = figure.subplots()
    single = inputs.shape[1] == 1
    x = inputs[:, 0].numpy() if single else np.arange(len(inputs))
    for k, colour in zip(range(targets.shape[1]), itertools.cycle(("#0072b2", "#d55e00"))):
        axes.plot(x, targets[:, k], "o", color=colour, fillstyle="none", label=f"target {k + 1}")
        style = "-" if single else "x"
        axes.plot(x, network(inputs)[:, k], style, color=colour, label=f"output {k + 1}")
    axes.set(title=title, xlabel="input" if single else "pattern")
    axes.legend(frameon=False)
    axes.grid(alpha=0.3)
    axes.spines[["top", "right"]].set_visible(False)
    figure.savefig(file, dpi=100)
    print(f"picture: {file}")


def main() -> None:
    h = read_hyperparameters(Hyperparameters, __doc__)
    torch.set_num_threads(1)  # this network is too small for more threads
    inputs, targets = training_set(h.training_set, h.seed)
    print(
        f"{h.training_set}: {len(inputs)} patterns. The network has {inputs.shape[1]} inputs, "
        f"{h.nhiddens} hidden neurons and {targets.shape[1]} outputs.\n"
    )

    def look(epoch: int, network: Network, loss: float) -> None:
        print(f"epoch {epoch}, loss {loss:.5f}:   inputs -> hidden neurons -> outputs")
        show_network(network, inputs, targets)

    network, losses = train(h, inputs, targets, look)
    if losses[-1] < h.enough:
        print(f"\nLearnt in {len(losses) - 1} epochs.")
    else:
        print(f"\nThe loss is still {losses[-1]:.4f}: more epochs, more neurons, another seed?")
    folder = new_folder(f"regression_{h.training_set}")
    draw(folder / "learnt.png", network, inputs, targets, f"{h.training_set}, seed {h.seed}")


if __name__ == "__main__":
    run(main)
