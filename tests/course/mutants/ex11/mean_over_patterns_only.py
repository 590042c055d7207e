# loses: 11.2
# The gradient is divided by the patterns, but not by the outputs.
_gradient_by_hand = gradient_by_hand


def gradient_by_hand(inputs, targets, *parameters):
    found = _gradient_by_hand(inputs, targets, *parameters)
    loss = found.pop("loss")
    return {"loss": loss, **{name: g * targets.shape[1] for name, g in found.items()}}
