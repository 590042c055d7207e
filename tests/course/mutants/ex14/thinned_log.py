# loses: 14.2
# Leaves the size guidance out, so that long logs lose values at random.
def read_indicators(folder):
    log = EventAccumulator(folder)
    log.Reload()
    indicators = {}
    for name in log.Tags()["scalars"]:
        entries = [entry for entry in log.Scalars(name) if not np.isnan(entry.value)]
        indicators[name] = {
            "steps": np.array([entry.step for entry in entries]),
            "values": np.array([entry.value for entry in entries]),
        }
    return indicators
