# loses: 8.3
# Adds the two utilities of a sample instead of subtracting them.
def gradient(samples, utilities):
    return (utilities[0::2] + utilities[1::2]) @ samples / len(utilities)
