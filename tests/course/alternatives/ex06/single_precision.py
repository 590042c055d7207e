# Single precision, preallocated arrays, one einsum for all gates, families as a matrix.
def think(brain, observation, memory):
    gates, readout, bias = (np.float32(brain[name]) for name in ("gates", "readout", "bias"))
    cells, outputs = np.float32(memory)
    z = np.hstack([observation, outputs]).astype(np.float32)
    net = np.einsum("gui,i->gu", gates, z) + np.float32([[1], [0], [0], [0]])
    forget, enter, leave = 1 / (1 + np.exp(-net[:3]))
    new = np.empty((2, UNITS), dtype=np.float32)
    new[0] = cells * forget + enter * np.tanh(net[3])
    new[1] = leave * np.tanh(new[0])
    return np.tanh(readout.dot(new[1]) + bias), new


def episode(brain, start, cylinder, seed, remember=keep, maxsteps=500):
    arena = arenas.make("discrim", max_steps=maxsteps)
    arena.reset(seed)
    arena.robots[0, :] = start
    arena.objects[0, 0:2] = cylinder
    arena.sense()
    poses = np.zeros((maxsteps + 1, 3))
    seen = np.zeros((maxsteps, INPUTS))
    memories = np.zeros((maxsteps + 1, 2, UNITS), dtype=np.float32)
    actions, rewards = np.zeros((maxsteps, 2)), np.zeros(maxsteps)
    poses[0], t = arena.robots[0], 0
    while t < maxsteps and not arena.done:
        seen[t] = arena.observation
        actions[t], after = think(brain, seen[t], memories[t])
        arena.action = actions[t]
        rewards[t] = arena.step()
        memories[t + 1] = remember(t, memories[t], after)
        t += 1
        poses[t] = arena.robots[0]
    return {
        "poses": poses[: t + 1],
        "observations": seen[:t],
        "memories": memories[:t],
        "actions": actions[:t],
        "rewards": rewards[:t],
    }


def grid(places, headings):
    y, x, angle = np.meshgrid(
        np.linspace(270, 350, places),
        np.linspace(150, 250, places),
        np.linspace(0, 2 * np.pi, headings, endpoint=False),
        indexing="ij",
    )
    return np.stack([x.ravel(), y.ravel(), angle.ravel()], axis=1).astype(np.float32)


def describe(poses, rewards, cylinder):
    poses, rewards = np.float32(poses), np.asarray(rewards)
    near = np.flatnonzero(rewards > 0)
    search = near[0] if len(near) else rewards.size
    step = np.diff(poses, axis=0)
    heading = np.stack([np.cos(poses[:, 2]), np.sin(poses[:, 2])], axis=1)
    turn = np.unwrap(poses[:, 2])
    speed = (step[:, :2] * heading[:-1]).sum(axis=1)
    wall = np.abs(poses[:-1, :2] - 200).max(axis=1) > 200 - 72.5
    to = np.float32(cylinder) - poses[1:, :2]
    cross = heading[1:, 0] * to[:, 1] - heading[1:, 1] * to[:, 0]
    side = cross / np.linalg.norm(to, axis=1)
    pace = np.linalg.norm(step[:, :2], axis=1)
    average = lambda values: np.float32(values.mean()) if values.size else np.float32(0)
    return {
        "search": search,
        "speed": average(speed[:search]),
        "turning": average(np.diff(turn)[:search]),
        "wall": average(wall[:search].astype(np.float32)),
        "pace": average(pace[near]),
        "side": average(side[near]),
    }


def standardise(table):
    centred = table - table.mean(axis=0)
    spread = np.sqrt((centred**2).mean(axis=0))
    return np.float32(centred / np.maximum(spread, 1e-9))


def families(table, threshold):
    rows = standardise(table)
    member = np.eye(len(rows), dtype=np.float32)  # one row for each family
    apart = np.sqrt(((rows[:, None, :] - rows[None, :, :]) ** 2).sum(axis=2))
    while len(member) > 1:
        sizes = member.sum(axis=1)
        mean_apart = member @ apart @ member.T / np.outer(sizes, sizes)
        np.fill_diagonal(mean_apart, np.inf)
        i, j = np.unravel_index(np.argmin(mean_apart), mean_apart.shape)
        if mean_apart[i, j] >= threshold:
            break
        member[i] += member[j]
        member = np.delete(member, j, axis=0)
    member = member[np.argsort(member.argmax(axis=1))]
    return member.argmax(axis=0)


def forget(step, before, after):
    return 0.0 * before


def freeze(since):
    def way(step, before, after):
        return np.where(step < since, after, before)

    return way


def memory_test(brain, starts, cylinder, seed, since, maxsteps=500):
    def worth(way):
        runs = [episode(brain, s, cylinder, seed + i, way, maxsteps) for i, s in enumerate(starts)]
        return np.mean([run["rewards"].sum() for run in runs])

    return {"keep": worth(keep), "forget": worth(forget), "freeze": worth(freeze(since))}


def reactions(brain, observation, memories):
    return np.array([think(brain, observation, memory)[0] for memory in memories], np.float32)
