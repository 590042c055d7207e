# loses: 8.3
# Divides by samplesize instead of twice as much.
def gradient(samples, utilities):
    return (utilities[0::2] - utilities[1::2]) @ samples / len(samples)
