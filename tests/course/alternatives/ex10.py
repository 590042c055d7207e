"""Right solutions of exercise 10 in other styles; building.py describes how a case is written."""


# %% best_of_the_training
# OpenAI-ES in place of a population; PPO whose best policy on the way is kept.
def evolve(seed):
    robot, rng = Robot("BalanceBotBulletEnv-v0", nhiddens=0), np.random.default_rng(seed)
    scale, centre = np.array([0.1, 3.0, 1.5, 0.2]), np.zeros(4)
    for generation in range(14):
        e = rng.standard_normal((6, 4))
        both = np.concatenate([centre + e, centre - e]) * scale
        fitness = robot.evaluate(both, seed + generation, episodes=1, maxsteps=500)
        ranks = np.argsort(np.argsort(fitness)) / 11 - 0.5
        centre = centre + 0.9 * (ranks[:6] - ranks[6:]) @ e / 2
    return centre * scale


def train(seed):
    import torch
    from stable_baselines3 import PPO
    from stable_baselines3.common.callbacks import BaseCallback

    torch.manual_seed(seed)

    class KeepTheBest(BaseCallback):
        best, layers = -np.inf, None

        def _on_step(self):
            return True

        def _on_rollout_start(self):
            if self.num_timesteps < 6000:
                return
            robot = gymnasium.make("BalanceBotBulletEnv-v0")
            total = 0.0
            for episode in range(4):
                observation, ended = robot.reset(seed=1000 * episode + seed)[0], False
                while not ended:
                    action, _ = self.model.predict(observation, deterministic=True)
                    observation, reward, terminated, truncated, _ = robot.step(action)
                    total += reward
                    ended = terminated or truncated
            if total > self.best:
                self.best, self.layers = total, actor_layers(self.model)

    keeper = KeepTheBest()
    model = PPO(
        "MlpPolicy", gymnasium.make("BalanceBotBulletEnv-v0"), seed=seed, device="cpu", n_steps=512,
        learning_rate=1e-3, gamma=0.98, gae_lambda=0.9,
    )  # fmt: skip
    model.learn(16_384, callback=keeper)
    return [[weights.tolist(), biases.tolist()] for weights, biases in keeper.layers]


# %% frames_by_recursion
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


# %% loops
# Loops and lists, comparisons in place of clip, both motors at once, a steady-state strategy.
import math


def describe(urdf):
    root = ElementTree.fromstring(urdf)
    masses, centres, frames, joints = {}, {}, {}, []
    for element in root:
        if element.tag == "link":
            name = element.attrib["name"]
            inertial = element.find("inertial")
            masses[name] = float(inertial.find("mass").attrib["value"])
            origin = inertial.find("origin")
            text = "0 0 0" if origin is None else origin.attrib.get("xyz", "0 0 0")
            centres[name] = [float(each) for each in text.split()]
            frames.setdefault(name, [0.0, 0.0, 0.0])
        elif element.tag == "joint":
            origin, axis = element.find("origin"), element.find("axis")
            offset = "0 0 0" if origin is None else origin.get("xyz", default="0 0 0")
            around = "1 0 0" if axis is None else axis.get("xyz", default="1 0 0")
            joint = dict(element.attrib)
            joint["parent"] = element.find("parent").attrib["link"]
            joint["child"] = element.find("child").attrib["link"]
            joint["axis"] = [float(each) for each in around.split(" ")]
            joints.append(joint)
            at = frames[joint["parent"]]
            frames[joint["child"]] = [
                a + float(o) for a, o in zip(at, offset.split(), strict=False)
            ]
    total = math.fsum(masses.values())
    centre = [0.0, 0.0, 0.0]
    for name, mass in masses.items():
        for i in range(3):
            centre[i] += mass / total * (frames[name][i] + centres[name][i])
    return {"links": masses, "joints": joints, "mass": total, "centre": centre}


class BalanceBotEnv(BalanceBotEnv):
    def __init__(self, render_mode=None):
        self.render_mode, self.client = render_mode, connect(render_mode)
        self.robot, self.speed = None, 0.0
        high = [math.pi, math.inf, FASTEST]
        low = [-each for each in high]
        box = gymnasium.spaces.Box
        self.observation_space = box(np.float32(low), np.float32(high), dtype=np.float32)
        self.action_space = box(low=np.array([-1], "f"), high=np.array([1], "f"))

    def observe(self):
        state = pybullet.getBasePositionAndOrientation(self.robot, physicsClientId=self.client)
        turning = pybullet.getBaseVelocity(self.robot, physicsClientId=self.client)[1]
        angles = pybullet.getEulerFromQuaternion(state[1])
        return np.float32([angles[0], turning[0], self.speed])

    def reset(self, *, seed=None, options=None):
        gymnasium.Env.reset(self, seed=seed)
        here = {"physicsClientId": self.client}
        pybullet.resetSimulation(**here)
        pybullet.setTimeStep(1 / 100, **here)
        pybullet.setGravity(0, 0, -10, **here)
        pybullet.loadURDF(PLANE, **here)
        lean = float(self.np_random.uniform(low=-0.3, high=0.3, size=1)[0])
        half = lean / 2
        self.robot = pybullet.loadURDF(
            str(robot_file("balance_bot.urdf")),
            basePosition=[0, 0, 0.001],
            baseOrientation=[math.sin(half), 0, 0, math.cos(half)],
            flags=pybullet.URDF_USE_INERTIA_FROM_FILE,
            **here,
        )
        self.speed = 0
        return self.observe(), {}

    def drive(self, action):
        change = float(action[0])
        if change > 1:
            change = 1
        if change < -1:
            change = -1
        self.speed += change
        if abs(self.speed) > FASTEST:
            self.speed = math.copysign(FASTEST, self.speed)
        pybullet.setJointMotorControlArray(
            self.robot, [0, 1], controlMode=pybullet.VELOCITY_CONTROL,
            targetVelocities=[self.speed, -self.speed], physicsClientId=self.client,
        )  # fmt: skip

    def reward(self):
        if self.speed >= 0:
            return 1 - self.speed / 20
        return 1 + self.speed / 20

    def fallen(self):
        return not pybullet.getBasePositionAndOrientation(self.robot, self.client)[0][2] >= LOWEST

    def step(self, action):
        self.drive(action)
        pybullet.stepSimulation(physicsClientId=self.client)
        observation, reward, fallen = self.observe(), self.reward(), self.fallen()
        if self.render_mode == "human":
            self.render()
        return observation, reward, fallen, False, {}


def register_robot():
    if "BalanceBotBulletEnv-v0" not in gymnasium.registry:
        gymnasium.register("BalanceBotBulletEnv-v0", BalanceBotEnv, max_episode_steps=500)


def evolve(seed):
    robot = Robot("BalanceBotBulletEnv-v0", nhiddens=0)
    rng = np.random.default_rng(seed)
    population = rng.normal(0, [0.2, 5.0, 3.0, 0.3], (16, 4))
    for generation in range(9):
        fitness = robot.evaluate(population, 100 * seed + generation, episodes=1, maxsteps=500)
        order = sorted(range(16), key=lambda i: -fitness[i])
        parents = population[order[:8]]
        population = np.concatenate([parents, parents + rng.normal(0, [0.1, 1, 0.5, 0.05], (8, 4))])
    fitness = robot.evaluate(population, seed, episodes=4, maxsteps=500)
    return population[fitness.argmax()].tolist()


# %% by_the_tree
# A dict of parents, numbers from a table of defaults; the spaces keep their limits as arrays.
def describe(urdf):
    root = ElementTree.fromstring(urdf)
    offset = {root.find("link").get("name"): np.zeros(3)}
    joints = []
    for joint in root.iter("joint"):
        names = {key: joint.find(key).attrib["link"] for key in ("parent", "child")}
        move = numbers_of(joint.find("./origin"), "xyz", [0, 0, 0])
        offset[names["child"]] = offset[names["parent"]] + np.array(move, dtype=float)
        axis = np.array(numbers_of(joint.find("./axis"), "xyz", [1, 0, 0]), dtype=float).tolist()
        joints.append({**names, "name": joint.get("name"), "type": joint.get("type"), "axis": axis})
    masses, sums = {}, np.zeros(4)
    for link in root.iter("link"):
        name = link.get("name")
        mass = float(link.find("inertial").find("mass").get("value"))
        place = offset[name] + numbers_of(link.find("inertial").find("origin"), "xyz", [0, 0, 0])
        masses[name] = mass
        sums += mass * np.array([1, *place])
    return {"centre": sums[1:] / sums[0], "mass": float(sums[0]), "joints": joints, "links": masses}


class BalanceBotEnv(BalanceBotEnv):
    def observe(self):
        _, turn = pybullet.getBasePositionAndOrientation(self.robot, physicsClientId=self.client)
        turning = pybullet.getBaseVelocity(self.robot, physicsClientId=self.client)[1]
        x, y, z, w = turn
        lean = np.arctan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))
        return np.array([lean, turning[0], self.speed]).astype("float32")


# %% one_call_for_both_motors
# One call of PyBullet for both motors, a step that asks its parts in another order.
class BalanceBotEnv(BalanceBotEnv):
    def drive(self, action):
        change = max(-1.0, min(1.0, float(np.asarray(action).ravel()[0])))
        self.speed = max(-FASTEST, min(FASTEST, self.speed + change))
        pybullet.setJointMotorControlArray(
            self.robot, (0, 1), pybullet.VELOCITY_CONTROL,
            targetVelocities=(self.speed, -self.speed), physicsClientId=self.client,
        )  # fmt: skip

    def step(self, action):
        self.drive(action)
        pybullet.stepSimulation(physicsClientId=self.client)
        fallen, reward = bool(self.fallen()), float(self.reward())
        if self.render_mode not in (None, "rgb_array"):
            self.render()
        return self.observe(), reward, fallen, False, dict()

    def reward(self):
        return 1.0 - abs(0.05 * self.speed)

    def fallen(self):
        return pybullet.getBasePositionAndOrientation(self.robot, self.client)[0][2] < LOWEST


# %% registered_by_a_text
# The entry point is a function that hands everything on; another order in the package's files.
def register_robot():
    def made(render_mode=None):
        return BalanceBotEnv(render_mode=render_mode)

    gymnasium.register("BalanceBotBulletEnv-v0", made, max_episode_steps=500)


def package_files():
    project = {
        "project": ['name = "balance_bot"', 'version = "2.0"',
                    'dependencies = ["pybullet", "numpy>=1.26", "gymnasium[classic-control]>=1"]'],
        "build-system": ['build-backend = "setuptools.build_meta"',
                         'requires = ["setuptools>=70", "wheel"]'],
        "tool.setuptools": ['packages = ["balance_bot"]'],
        "tool.setuptools.package-data": ['balance_bot = ["*"]'],
    }  # fmt: skip
    lines = [line for name, rows in project.items() for line in (f"[{name}]", *rows, "")]
    init = (
        "from gymnasium import register\n\n"
        "register('BalanceBotBulletEnv-v0', 'balance_bot.env:BalanceBotEnv', "
        "max_episode_steps=500)\n"
    )
    return {"pyproject.toml": "\n".join(lines), "balance_bot/__init__.py": init}


# %% path_at_the_top_of_the_file
# The path of the robot is a constant of the module.
# -             str(robot_file("balance_bot.urdf")),
# +             ROBOT_FILE,
ROBOT_FILE = str(robot_file("balance_bot.urdf"))


# %% stops_as_soon_as_it_balances
# A hill climber that returns the first controller that has balanced four times; often the second.
def evolve(seed):
    robot = Robot("BalanceBotBulletEnv-v0", nhiddens=0)
    rng = np.random.default_rng(seed)
    best, most = np.zeros(4), -np.inf
    for trial in range(200):
        candidate = best + rng.normal(0, [0.3, 3.0, 3.0, 0.3])
        fitness = robot.evaluate([candidate], seed + trial, episodes=1, maxsteps=500)[0]
        if fitness > max(most, 440):
            more = robot.evaluate([candidate], 7000 + seed + trial, episodes=3, maxsteps=500)
            fitness = min(fitness, more[0])
        if fitness > most:
            best, most = candidate, fitness
        if most > 440:
            break
    return best


# %% plays_without_robot_evaluate
# Random search with gymnasium.make alone: one candidate after another, whose episodes it plays itself.
def evolve(seed):
    env, rng = gymnasium.make("BalanceBotBulletEnv-v0"), np.random.default_rng(seed)

    def length(candidate, first, episodes):
        total = 0
        for episode in range(episodes):
            observation, ended = env.reset(seed=first + episode)[0], False
            while not ended:
                action = np.clip([candidate[0] + candidate[1:] @ observation], -1, 1)
                observation, _, terminated, truncated, _ = env.step(action.astype(np.float32))
                ended, total = terminated or truncated, total + 1
        return total

    best, longest = np.zeros(4), 0
    for trial in range(400):
        candidate = rng.normal(0, [0.1, 6.0, 3.0, 0.2])
        if length(candidate, seed + trial, 1) == 500:
            steps = length(candidate, 1000 * seed, 10)
            best, longest = (candidate, steps) if steps > longest else (best, longest)
        if longest == 5000:
            break
    return best
