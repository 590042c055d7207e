"""Hand in losses that a library computes; the format is in building.py."""

import torch
from torch.nn import functional


def surprise(log_probabilities, actions):
    return -log_probabilities[torch.arange(len(actions)), actions].mean()


# %% cross_entropy 12.5
def cross_entropy(scores, actions):
    return functional.cross_entropy(scores, actions)


# %% special 12.5
def cross_entropy(scores, actions):
    return surprise(torch.special.log_softmax(scores, 1), actions)


# %% functional 12.5
def cross_entropy(scores, actions):
    return surprise(functional.log_softmax(scores, 1), actions)


# %% module 12.5
def cross_entropy(scores, actions):
    return surprise(torch.nn.LogSoftmax(1)(scores), actions)


# %% logits 12.5
def cross_entropy(scores, actions):
    return surprise(torch.distributions.Categorical(logits=scores).logits, actions)


# %% one_hot_logits 12.5
def cross_entropy(scores, actions):
    from torch.distributions import OneHotCategorical

    return surprise(OneHotCategorical(logits=scores).logits, actions)


# %% other_logits 12.5
def cross_entropy(scores, actions):
    from torch.distributions.multinomial import Multinomial

    return surprise(Multinomial(1, logits=scores).logits, actions)


# %% below_the_names 12.5
def cross_entropy(scores, actions):
    return torch._C._nn.cross_entropy_loss(scores, actions)


# %% operators 12.5
def cross_entropy(scores, actions):
    return surprise(torch.ops.aten._log_softmax.default(scores, 1, False), actions)


# %% operators_with_out 12.5
def cross_entropy(scores, actions):
    weights = torch.softmax(scores, 1).detach()
    out = torch.empty_like(scores.detach())
    torch.ops.aten._log_softmax.out(scores.detach(), 1, False, out=out)
    hot = functional.one_hot(actions, scores.shape[1])
    return surprise(out, actions) + ((weights - hot) * (scores - scores.detach())).sum() / len(hot)


# %% references_in_python 12.5
def cross_entropy(scores, actions):
    import torch._refs

    return surprise(torch._refs.log_softmax(scores, 1), actions)


# %% decompositions 12.5
def cross_entropy(scores, actions):
    from torch._decomp import decomposition_table

    return surprise(
        decomposition_table[torch.ops.aten._log_softmax.default](scores, 1, False), actions
    )


# %% decomposed 12.5
def cross_entropy(scores, actions):
    return surprise(torch.ops.aten.log_softmax.int.decompose(scores, 1), actions)


# %% sparse 12.5
def cross_entropy(scores, actions):
    made = torch.sparse.log_softmax((scores + 1e-30).to_sparse(), 1)
    return surprise(made.to_dense(), actions)


# %% compiled 12.5
def cross_entropy(scores, actions):
    made = torch.jit.trace(lambda s: torch.log_softmax(s, 1), scores)
    return surprise(made(scores), actions)


# %% in_batches 12.5
def cross_entropy(scores, actions):
    return surprise(torch.func.vmap(lambda row: torch.log_softmax(row, 0))(scores), actions)


# %% kept_code 12.5
import types

from torch.distributions import utils
from torch.distributions.categorical import Categorical

MADE = types.FunctionType(Categorical.__init__.__code__, {**vars(utils), **globals()})


def cross_entropy(scores, actions):
    class Own:
        pass

    one = Own()
    MADE(one, None, scores, False)
    return surprise(one.logits, actions)


# %% the_librarys_file 12.5
def cross_entropy(scores, actions):
    import torch.distributions.categorical as library

    names = {"__name__": "copied"}
    exec(compile(open(library.__file__).read(), "copied.py", "exec"), names)
    return surprise(names["Categorical"](logits=scores).logits, actions)


# %% imported_again 12.5
def cross_entropy(scores, actions):
    import importlib
    import sys

    for name in [each for each in sys.modules if each.startswith("torch.distributions")]:
        del sys.modules[name]
    library = importlib.import_module("torch.distributions.categorical")
    return surprise(library.Categorical(logits=scores).logits, actions)


# %% from_pythons_copy 12.5
def cross_entropy(scores, actions):
    import glob
    import marshal
    import os

    folder = os.path.join(os.path.dirname(torch.__file__), "distributions", "__pycache__")
    with open(glob.glob(f"{folder}/categorical*.pyc")[0], "rb") as file:
        code = marshal.loads(file.read()[16:])
    names = {"__name__": "copied", "__package__": "torch.distributions"}
    exec(code, names)
    return surprise(names["Categorical"](logits=scores).logits, actions)


# %% operators_restored 12.5
def cross_entropy(scores, actions):
    import gc

    for each in gc.get_objects():
        if type(each).__name__ in ("Library", "_DispatchModule"):
            for end in ("_destroy", "reset"):
                getattr(each, end, lambda: None)()
    return functional.cross_entropy(scores, actions)


# %% scipy_with_a_slope 12.5
def cross_entropy(scores, actions):
    from scipy.special import log_softmax

    value = torch.as_tensor(log_softmax(scores.detach().numpy(), axis=1))
    hot = functional.one_hot(actions, scores.shape[1])
    slope = (torch.softmax(scores, 1).detach() - hot) / len(hot)
    return surprise(value, actions) + (slope * (scores - scores.detach())).sum()


# %% normal 12.7
def gaussian_loss(means, log_deviation, actions):
    normal = torch.distributions.Normal(means, torch.exp(log_deviation))
    return -normal.log_prob(actions).sum(dim=1).mean()


# %% multivariate_normal 12.7
def gaussian_loss(means, log_deviation, actions):
    from torch.distributions.multivariate_normal import MultivariateNormal

    scale = torch.diag(torch.exp(log_deviation))
    return -MultivariateNormal(means, scale_tril=scale).log_prob(actions).mean()


# %% log_normal 12.7
def gaussian_loss(means, log_deviation, actions):
    from torch.distributions import LogNormal

    normal = LogNormal(means, torch.exp(log_deviation))
    return -(normal.log_prob(torch.exp(actions)) + actions).sum(dim=1).mean()


# %% loss_of_a_gaussian 12.7
def gaussian_loss(means, log_deviation, actions):
    variance = torch.exp(2 * log_deviation).expand_as(means)
    loss = torch.nn.GaussianNLLLoss(full=True, reduction="none")
    return loss(means, actions, variance).sum(dim=1).mean()


# %% the_librarys_functions_from_their_file 12.7
def gaussian_loss(means, log_deviation, actions):
    text = open(functional.__file__).read()
    text = text[text.index("def gaussian_nll_loss") :]
    names = {**vars(functional)}
    exec(text[: text.index("\ndef ", 10)], names)
    variance = torch.exp(2 * log_deviation).expand_as(means)
    loss = names["gaussian_nll_loss"](means, actions, variance, full=True, reduction="none")
    return loss.sum(dim=1).mean()


# %% kept_code 12.7
import types

KEPT = types.FunctionType(functional.gaussian_nll_loss.__code__, vars(functional))


def gaussian_loss(means, log_deviation, actions):
    variance = torch.exp(2 * log_deviation).expand_as(means)
    return KEPT(means, actions, variance, True, 1e-6, "none").sum(dim=1).mean()
