# loses: 15.8
# Looks at walls and at the distance after each step instead of before it.
_describe = describe


def describe(poses):
    after = poses[1:, :, :2]
    return {
        **_describe(poses),
        "wall": (np.minimum(after, 3000 - after).min(axis=-1) < 300).mean(axis=0),
        "distance": float(np.linalg.norm(after[:, 0] - after[:, 1], axis=1).mean()),
    }
