# loses: 13.3
# Clips the error instead of the movement.
_value_loss = value_loss


def value_loss(values, old_values, returns, clip_range_vf=None):
    if clip_range_vf is None:
        return _value_loss(values, old_values, returns)
    return float(np.mean(np.clip(returns - values, -clip_range_vf, clip_range_vf) ** 2))
