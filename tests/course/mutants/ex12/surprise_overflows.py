# loses: 12.5
# The powers of large scores are more than a computer can hold.
def cross_entropy(scores, actions):
    powers = torch.exp(scores)
    shares = powers / powers.sum(dim=1, keepdim=True)
    return -torch.log(shares[torch.arange(len(actions)), actions]).mean()
