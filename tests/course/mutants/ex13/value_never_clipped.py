# loses: 13.3
# Ignores the clipping.
_value_loss = value_loss


def value_loss(values, old_values, returns, clip_range_vf=None):
    return _value_loss(values, old_values, returns)
