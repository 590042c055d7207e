"""List what libraries have for a task, so that students write it themselves.

A grader gives these lists to `Exercise.task(refused=...)`, and the exercise's text says so. Modules
of botschool that an exercise does not use need no list: they do not exist (modules.py). The
forms of the names are those of botschool/grading/run/refused.py. Prefer whole modules, and below
them operators: what a name leads to has other names, too. Other forbidden ways need other questions
in the grader: it recognises finite differences in place of a gradient, for example, because they
become wrong as soon as the loss is large beside the gradient (exercise 11).
"""

from __future__ import annotations

from dataclasses import dataclass


@dataclass(frozen=True)
class Refused:
    """What a submission's process does not have."""

    names: tuple[str, ...] = ()
    """In the forms of botschool/grading/run/refused.py."""
    may_use: frozenset[str] | None = None
    """Modules of botschool that a submission may use, so that no others exist; None for all."""


_OPENAI_ES = "botschool.evolution.algorithms.openaies"
_TORCH_IN_PYTHON = ("torch._refs", "torch._decomp")
"""Torch's operators once more, in Python."""
_NATIVE_PPO = ("botschool.rl", "botschool._core:PolicyGradient")
_SB3 = ("stable_baselines3", "sb3_contrib")

BACKPROPAGATION = (
    "torch", "functorch", "torchvision", "torchaudio", "jax", "jaxlib", "tensorflow", "keras",
    "autograd", "sympy", "casadi", "tinygrad", "theano", "pytensor", "mxnet", *_SB3,
)  # fmt: skip
"""Whatever differentiates; a submission's process has none of it."""
CROSS_ENTROPY = (
    *(
        f"torch.ops.aten:{name}"
        for name in (
            "_log_softmax", "_log_softmax.out", "log_softmax.int", "log_softmax.Dimname",
            "log_softmax.int_out", "special_log_softmax", "_sparse_log_softmax",
            "_sparse_log_softmax.int", "_sparse_log_softmax.Dimname", "cross_entropy_loss",
            "nll_loss", "nll_loss.out", "nll_loss_nd", "nll_loss2d", "nll_loss2d.out",
            "nll_loss_forward", "nll_loss_forward.output", "nll_loss2d_forward",
            "nll_loss2d_forward.output", "binary_cross_entropy", "binary_cross_entropy.out",
            "binary_cross_entropy_with_logits", "binary_cross_entropy_with_logits.out",
            "soft_margin_loss", "soft_margin_loss.out",
        )
    ),
    "torch.distributions", *_TORCH_IN_PYTHON, "scipy.special._logsumexp", "sklearn", *_SB3,
)  # fmt: skip
GAUSSIAN_DENSITY = (
    "torch.nn.functional:gaussian_nll_loss",
    "torch.distributions",
    *_TORCH_IN_PYTHON,
    "scipy.stats",
    *_SB3,
)
ENTROPY = (
    *(f"scipy.special._ufuncs:{name}" for name in ("entr", "rel_entr", "kl_div")),
    "torch.special", "torch.distributions", "scipy.stats", *_NATIVE_PPO, *_SB3,
)  # fmt: skip
ADVANTAGES = (*_NATIVE_PPO, *_SB3)
EXPLAINED_VARIANCE = ("sklearn", *_NATIVE_PPO, *_SB3)
UPDATES_MADE = (*_NATIVE_PPO, *_SB3)
PPO_LOOP = (
    *(f"botschool.rl.native.ppo:PPO.{name}" for name in ("update", "learn")),
    "botschool._core:PolicyGradient.update",
    "botschool.rl.native.training",
    "botschool.rl.training",
    *_SB3,
)
OPENAI_ES = (
    *(f"{_OPENAI_ES}:{name}" for name in ("ranks", "gradient", "adam", "climb")),
    f"{_OPENAI_ES}:OpenAIES.tell",
    "botschool.evolution.algorithms.drawing:mirrored",
    *("torch", "tensorflow", "keras", "optax", "sklearn"),
)
"""With the libraries that have Adam."""
TRAINING = _SB3
