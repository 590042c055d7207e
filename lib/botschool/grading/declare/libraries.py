"""List library functions that are the answer to a task, so that students write it themselves.

A grader gives these lists to `Exercise.task(refused=...)`, and the exercise's text says so. Other
forbidden ways need other questions in the grader: it recognises finite differences in place of a
gradient, for example, because they become wrong as soon as the loss is large beside the gradient
(exercise 11).
"""

_SB3 = "stable_baselines3.common"
_DISTRIBUTIONS = "torch.distributions"
_OPENAI_ES = "botschool.evolution.algorithms.openaies"

BACKPROPAGATION = ("torch.autograd:backward", "torch.autograd:grad")
CROSS_ENTROPY = (
    "torch:log_softmax",
    "torch:Tensor.log_softmax",
    *(f"torch.nn.functional:{name}" for name in ("cross_entropy", "nll_loss", "log_softmax")),
    f"{_DISTRIBUTIONS}.categorical:Categorical.log_prob",
)
GAUSSIAN_DENSITY = (
    "torch.nn.functional:gaussian_nll_loss",
    f"{_DISTRIBUTIONS}.normal:Normal.log_prob",
    f"{_DISTRIBUTIONS}.multivariate_normal:MultivariateNormal.log_prob",
    f"{_SB3}.distributions:DiagGaussianDistribution.log_prob",
)
ENTROPY = (
    f"{_SB3}.distributions:CategoricalDistribution.entropy",
    f"{_SB3}.distributions:DiagGaussianDistribution.entropy",
    f"{_DISTRIBUTIONS}.categorical:Categorical.entropy",
    f"{_DISTRIBUTIONS}.independent:Independent.entropy",
    f"{_DISTRIBUTIONS}.normal:Normal.entropy",
    f"{_DISTRIBUTIONS}.multivariate_normal:MultivariateNormal.entropy",
)
ADVANTAGES = (f"{_SB3}.buffers:RolloutBuffer.compute_returns_and_advantage",)
EXPLAINED_VARIANCE = (f"{_SB3}.utils:explained_variance",)
UPDATES_MADE = ("botschool.rl.reference:updates_made",)
OPENAI_ES = (
    *(f"{_OPENAI_ES}:{name}" for name in ("ranks", "gradient", "adam", "climb")),
    f"{_OPENAI_ES}:OpenAIES.ask",
    f"{_OPENAI_ES}:OpenAIES.tell",
)
TRAINING = (
    f"{_SB3}.on_policy_algorithm:OnPolicyAlgorithm.learn",
    f"{_SB3}.off_policy_algorithm:OffPolicyAlgorithm.learn",
    "botschool.rl.training:train",
    "botschool.evolution.run:Run.advance",
)
