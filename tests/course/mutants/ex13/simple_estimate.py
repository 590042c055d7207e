# loses: 13.5
# The mean of minus the logarithm, which is right only on average.
def approx_kl(log_prob, old_log_prob):
    return float(np.mean(old_log_prob - log_prob))
