# loses: 14.1
# Repeats the training with the same seed, which repeats the same numbers.
_train_variations = train_variations


def train_variations(environment, variations, seeds, *arguments, **options):
    records = _train_variations(environment, variations, [seeds[0]] * len(seeds), *arguments)
    count = len(seeds)
    return [{**record, "seed": seeds[i % count]} for i, record in enumerate(records)]
