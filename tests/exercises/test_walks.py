"""Graders watch where steps along gradients lead the parameters of a network."""

import types

import numpy as np
import pytest

torch = pytest.importorskip("torch")

from botschool.grading.run.walks import watching  # noqa: E402


class Made(torch.nn.Module):
    def __init__(self):
        super().__init__()
        self.hidden, self.output = torch.nn.Linear(2, 2), torch.nn.Linear(2, 1)

    def forward(self, patterns):
        return self.output(torch.sigmoid(self.hidden(patterns)))


def own(inputs, targets, *parameters):
    return [0.1 * (each + 1) for each in parameters]


def module():
    return types.SimpleNamespace(Network=type("Network", (Made,), {}), own=own)


def descend(network, steps):
    optimiser = torch.optim.SGD(network.parameters(), lr=0.3)
    for _ in range(steps):
        optimiser.zero_grad()
        (network(torch.ones(4, 2)) - 5).square().mean().backward()
        optimiser.step()
    return [each.detach().numpy().copy() for each in network.parameters()]


def test_steps_lead_to_what_they_end_at_and_nowhere_else():
    torch.manual_seed(1)
    some = module()
    with watching(some, ("own",), 0) as walks:
        end = descend(some.Network(), 50)
    assert walks.gradients == 50
    assert walks.led_to(end)
    assert not walks.led_to([each + 10 for each in end])
    assert not walks.led_to(end[:2])  # of another size


def test_a_start_has_not_come_far():
    torch.manual_seed(1)
    some = module()
    with watching(some, (), 0) as walks:
        end = descend(some.Network(), 1)
    assert not walks.led_to(end)


def test_functions_of_the_module_compute_gradients_too():
    some = module()
    place = [np.ones((2, 2)), np.ones(2)]
    with watching(some, ("own", "missing"), 0) as walks:
        for _ in range(20):
            slopes = some.own(None, None, *place)
            place = [a - b for a, b in zip(place, slopes, strict=True)]
    assert walks.gradients == 20
    assert walks.led_to(place)


def test_a_network_that_begins_again_with_the_same_weights_is_seen():
    for seeds, repeated in (((1, 1), True), ((1, 2), False)):
        some = module()
        with watching(some, (), 0) as walks:
            for seed in seeds:
                torch.manual_seed(seed)
                descend(some.Network(), 2)
        assert walks.repeated == repeated


def test_the_first_networks_are_stuck():
    some, made = module(), []
    with watching(some, (), 1):
        made += [some.Network(), some.Network()]
    alike = [bool((each.hidden.weight == 0.1).all()) for each in made]
    assert alike == [True, False]
    assert "__init__" not in vars(some.Network)
