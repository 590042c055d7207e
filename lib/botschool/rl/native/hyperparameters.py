"""Check the hyperparameters of native PPO; names and defaults are Stable-Baselines3's."""

from __future__ import annotations

from dataclasses import dataclass, field, fields
from typing import Any

from botschool import _core
from botschool.errors import BotschoolError
from botschool.inifile import nearest, shown
from botschool.rl.parameters import OF_POLICY, RANGES, linear

MOST_LAYERS, WIDEST = 7, 4096
"""Hidden layers of a network at most."""


@dataclass
class Hyperparameters:
    """Hyperparameters, checked at construction. Raises BotschoolError."""

    learning_rate: float | str = 3e-4
    """Step size of Adam; "linear X" falls from X to 0."""
    n_steps: int = 2048
    """Steps of each environment between two updates."""
    batch_size: int = 64
    """Steps in a minibatch."""
    n_epochs: int = 10
    """Passes of an update through its data."""
    gamma: float = 0.99
    gae_lambda: float = 0.95
    clip_range: float | str | None = 0.2
    """How far the ratio of probabilities may leave 1; None: no clipping (A2C, REINFORCE)."""
    clip_range_vf: float | str | None = None
    """How far the critic's prediction may move in an update; None: without limit."""
    normalize_advantage: bool = True
    ent_coef: float = 0.0
    vf_coef: float = 0.5
    max_grad_norm: float = 0.5
    """Longer gradients are shortened to this length; 0: never."""
    target_kl: float | None = None
    """An update stops at 1.5 times this KL divergence; None: never."""
    net_arch: Any = field(default_factory=lambda: [64, 64])
    """Hidden neurons layer by layer, or {"pi": [...], "vf": [...]}."""
    share_layers: bool = False
    """Whether policy and critic share the hidden layers of net_arch."""
    activation_fn: str = "tanh"
    """tanh or relu."""
    log_std_init: float = 0.0
    """Initial logarithm of the Gaussian's standard deviations."""
    ortho_init: bool = True
    """Orthogonal initial weights instead of uniform ones."""

    def __post_init__(self) -> None:
        for name in ("n_steps", "batch_size", "n_epochs"):
            _whole(name, getattr(self, name))
        for name in ("normalize_advantage", "share_layers", "ortho_init"):
            if not isinstance(getattr(self, name), bool):
                raise _wrong(name, getattr(self, name), "true or false")
        for name in NUMBERS:
            setattr(self, name, _number(name, getattr(self, name)))
        if self.activation_fn not in ("tanh", "relu"):
            raise _wrong("activation_fn", self.activation_fn, "tanh or relu")
        self.layers()

    @classmethod
    def of(cls, chosen: dict[str, Any]) -> Hyperparameters:
        """Return checked hyperparameters. Raises BotschoolError that suggests the nearest name."""
        known = [each.name for each in fields(cls)]
        for name in chosen:
            if name not in known:
                hint = nearest(name, [*known, "normalize"])
                end = "" if hint.endswith("?") else "."
                raise BotschoolError(f"PPO has no hyperparameter {shown(name)}; {hint}{end}")
        return cls(**chosen)

    def layers(self) -> tuple[list[int], list[int], list[int]]:
        """Return the sizes of the shared layers, of the policy's own and of the critic's own."""
        arch = self.net_arch
        pair = (arch.get("pi", []), arch.get("vf", [])) if isinstance(arch, dict) else (arch, arch)
        for part in pair:
            good = isinstance(part, list) and len(part) <= MOST_LAYERS
            if not good or any(type(n) is not int or not 1 <= n <= WIDEST for n in part):
                most = f"up to {MOST_LAYERS} layers of at most {WIDEST} neurons"
                raise _wrong("net_arch", arch, f"{OF_POLICY['net_arch']}, {most}")
        if self.share_layers:
            if isinstance(arch, dict):
                raise _wrong("net_arch", arch, "one list of layers where they are shared")
            return list(arch), [], []
        return [], list(pair[0]), list(pair[1])

    def core(
        self, seed: int, n_envs: int, normalize: bool, threads: int
    ) -> _core.PolicyGradientHyperparameters:
        """Return the same hyperparameters as the C++ record."""
        h = _core.PolicyGradientHyperparameters()
        h.seed, h.n_envs, h.normalize, h.threads = seed, n_envs, normalize, threads
        h.shared, h.pi, h.vf = self.layers()
        h.relu = self.activation_fn == "relu"
        h.target_kl = self.target_kl or 0.0
        for name in SAME:
            setattr(h, name, getattr(self, name))
        return h


SAME = (
    "n_steps", "batch_size", "n_epochs", "gamma", "gae_lambda", "ent_coef", "vf_coef",
    "max_grad_norm", "normalize_advantage", "log_std_init", "ortho_init",
)  # fmt: skip
SCHEDULED = ("learning_rate", "clip_range", "clip_range_vf")
MAY_BE_NONE = ("clip_range", "clip_range_vf", "target_kl")
NUMBERS = (*SCHEDULED, "gamma", "gae_lambda", "ent_coef", "vf_coef", "max_grad_norm", "target_kl",
           "log_std_init")  # fmt: skip


def at(value: float | str | None, progress: float) -> float:
    """Return a hyperparameter's value (None is 0) at a share `progress` of the training."""
    falling = linear(value)
    return float(value or 0.0) if falling is None else falling * (1.0 - progress)


def _whole(name: str, value: Any) -> None:
    if type(value) is not int or not 1 <= value < 2**31:
        raise _wrong(name, value, "a whole number of at least 1")


def _number(name: str, value: Any) -> Any:
    if value is None and name in MAY_BE_NONE:
        return None
    falling = linear(value) if name in SCHEDULED else None
    number = value if falling is None else falling
    low, high = RANGES.get(name, (None, None))
    if name == "clip_range_vf":
        low = 0
    if type(number) not in (int, float) or not abs(number) < 1e30:
        words = "a number or 'linear X'" if name in SCHEDULED else "a number"
        raise _wrong(name, value, words)
    if (low is not None and number < low) or (high is not None and number > high):
        limits = f"from {low:g} to {high:g}" if high else f"at least {low}"
        raise _wrong(name, value, limits)
    return value if falling is not None else float(value)


def _wrong(name: str, value: Any, words: str) -> BotschoolError:
    return BotschoolError(f"{name} is {shown(value)}, but must be {words}.")
