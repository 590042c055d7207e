"""A user's own policies, named by --policy own_policies:Narrow."""

import torch
from stable_baselines3.common.policies import ActorCriticPolicy
from stable_baselines3.sac.policies import SACPolicy


class Narrow(ActorCriticPolicy):
    """One hidden neuron, and a gain of the observation."""

    def __init__(self, *arguments, **named):
        super().__init__(*arguments, **{"net_arch": [1]} | named)

    def _build(self, lr_schedule):
        self.gain = torch.nn.Parameter(torch.ones(1))  # here, before the optimizer is made
        super()._build(lr_schedule)

    def extract_features(self, *arguments, **named):
        return self.gain * super().extract_features(*arguments, **named)


class Soft(SACPolicy):
    """SAC's policy under another name."""


class Thing:
    """A class that is not a policy."""


number = 5
