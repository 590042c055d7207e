# loses: 9.6
# Evolves every replication with the same seed.
_evolve_both = evolve_both


def evolve_both(robot, steps, seeds):
    return _evolve_both(robot, steps, [seeds[0]] * len(seeds))
