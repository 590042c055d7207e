# loses: 13.6
# Adds the entropy to the loss instead of subtracting it.
_total_loss = total_loss


def total_loss(policy_loss, value_loss, entropies, ent_coef, vf_coef):
    return _total_loss(policy_loss, value_loss, entropies, -ent_coef, vf_coef)
