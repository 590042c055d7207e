# loses: 12.5
# Calls torch's own cross-entropy.
from torch.nn.functional import cross_entropy as ready_made


def cross_entropy(scores, actions):
    return ready_made(scores, actions)
