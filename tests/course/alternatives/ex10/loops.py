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
