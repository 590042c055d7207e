# loses: 9.3
# Returns the reward as a further component.
_components_v0 = components_v0


def components_v0(trajectory):
    parts = _components_v0(trajectory)
    return {**parts, "reward": sum(parts.values())}
