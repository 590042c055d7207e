# loses: 14.1
# Trains every variation with the defaults.
_train_variations = train_variations


def train_variations(environment, variations, *arguments, **options):
    return _train_variations(environment, {name: {} for name in variations}, *arguments, **options)
