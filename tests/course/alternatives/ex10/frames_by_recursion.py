# Frames by recursion, spaces from lists, numpy's own floats, another form of the package.
import json


def describe(urdf):
    root = ElementTree.XML(urdf)
    found = {joint.find("child").get("link"): joint for joint in root.iter("joint")}
    zero = np.zeros(3)

    def frame(name):
        if name not in found:
            return zero
        joint = found[name]
        offset = numbers_of(joint.find("origin"), "xyz", [0, 0, 0])
        return frame(joint.find("parent").get("link")) + offset

    links = root.findall("./link")
    masses = np.array([link.find("./inertial/mass").get("value") for link in links], dtype=float)
    places = np.array(
        [
            frame(link.get("name")) + numbers_of(link.find("inertial/origin"), "xyz", [0, 0, 0])
            for link in links
        ]
    )
    return {
        "mass": masses.sum(),
        "centre": np.average(places, axis=0, weights=masses),
        "links": {link.get("name"): mass for link, mass in zip(links, masses, strict=False)},
        "joints": [
            {
                **{key: joint.get(key) for key in ("name", "type")},
                **{key: joint.find(key).get("link") for key in ("parent", "child")},
                "axis": tuple(numbers_of(joint.find("axis"), "xyz", [1, 0, 0])),
            }
            for joint in root.findall("joint")
        ],
    }


class BalanceBotEnv(BalanceBotEnv):
    def __init__(self, render_mode=None):
        super().__init__(render_mode)
        limits = np.array([np.pi, float("inf"), FASTEST])
        self.observation_space = gymnasium.spaces.Box(-limits, limits, (3,), np.float32)
        self.action_space = gymnasium.spaces.Box(-1, 1, (1,), dtype=np.float32)

    def drive(self, action):
        speed = self.speed + np.minimum(np.maximum(np.float64(action[0]), -1), 1)
        self.speed = min(FASTEST, max(-FASTEST, speed))
        for wheel in range(2):
            pybullet.setJointMotorControl2(
                self.robot, wheel, pybullet.VELOCITY_CONTROL,
                targetVelocity=self.speed * (1 - 2 * wheel), physicsClientId=self.client,
            )  # fmt: skip

    def reward(self):
        return np.float64(1.0) - 0.05 * np.abs(self.speed)

    def fallen(self):
        position, _ = pybullet.getBasePositionAndOrientation(self.robot, self.client)
        return bool(np.less(position[2], LOWEST))


def register_robot():
    gymnasium.envs.registration.register(
        "BalanceBotBulletEnv-v0", entry_point=lambda **given: BalanceBotEnv(**given),
        max_episode_steps=500,
    )  # fmt: skip


def package_files():
    lines = ["[build-system]", "requires = ['setuptools >= 64']"]
    lines += ["build-backend = 'setuptools.build_meta'", "", "[project]", 'name = "balance-bot"']
    lines += ["version = '1'", 'dependencies = ["numpy>=1.24", "pybullet", "gymnasium"]', ""]
    lines += ["[tool.setuptools]", f"packages = {json.dumps(['balance_bot'])}", ""]
    lines += ["[tool.setuptools.package-data]", 'balance_bot = ["*.urdf"]']
    init = "from gymnasium.envs.registration import register\n\n"
    init += 'register("BalanceBotBulletEnv-v0", "balance_bot.env:BalanceBotEnv", '
    init += "max_episode_steps=500)\n"
    return {"balance_bot/__init__.py": init, "pyproject.toml": "\n".join(lines)}
