"""Wrong solutions of exercise 10; building.py describes how a case is written."""

# %% default_axis_is_z loses 10.1
# Takes z for the axis of a joint that names none.
# says: turns around x
_describe = describe


def describe(urdf):
    root = ElementTree.fromstring(urdf)
    description = _describe(urdf)
    for joint, found in zip(root.findall("joint"), description["joints"], strict=True):
        if joint.find("axis") is None:
            found["axis"] = [0.0, 0.0, 1.0]
    return description


# %% inertial_origins_forgotten loses 10.1
# Takes the places of the joints for those of the centres: the inertial origins are forgotten.
_describe = describe


def describe(urdf):
    root = ElementTree.fromstring(urdf)
    for link in root.findall("link"):
        origin = link.find("inertial/origin")
        if origin is not None:
            origin.set("xyz", "0 0 0")
    return _describe(ElementTree.tostring(root, encoding="unicode"))


# %% limits_of_the_chapter loses 10.2
# Limits that the robot exceeds: pi rad/s and 5 rad/s.
# says: should be \[.*inf
class BalanceBotEnv(BalanceBotEnv):
    def __init__(self, render_mode=None):
        super().__init__(render_mode)
        limits = np.array([np.pi, np.pi, 5], dtype=np.float32)
        self.observation_space = gymnasium.spaces.Box(-limits, limits)


# %% part_of_the_quaternion loses 10.3, 10.7
# Takes the first number of the quaternion for the angle.
class BalanceBotEnv(BalanceBotEnv):
    def observe(self):
        seen = super().observe()
        seen[0] = pybullet.getBasePositionAndOrientation(self.robot, self.client)[1][0]
        return seen


# %% turning_around_z loses 10.3, 10.7
# Observes the angular velocity around the upright axis.
class BalanceBotEnv(BalanceBotEnv):
    def observe(self):
        seen = super().observe()
        seen[1] = pybullet.getBaseVelocity(self.robot, self.client)[1][2]
        return seen


# %% earth_gravity loses 10.4, 10.7
# Gravity 9.81 downwards, as on earth, but not as in the text.
class BalanceBotEnv(BalanceBotEnv):
    def reset(self, *, seed=None, options=None):
        answer = super().reset(seed=seed)
        pybullet.setGravity(0, 0, -9.81, physicsClientId=self.client)
        return answer


# %% same_start_always loses 10.4, 10.7
# Draws from a generator of its own with a fixed seed, so that all episodes begin alike.
class BalanceBotEnv(BalanceBotEnv):
    def reset(self, *, seed=None, options=None):
        return super().reset(seed=1)


# %% speed_not_reset loses 10.4, 10.7
# The wheels keep the target speed of the episode before.
# says: self.speed is 7, not 0
class BalanceBotEnv(BalanceBotEnv):
    def reset(self, *, seed=None, options=None):
        before = self.speed
        _, info = super().reset(seed=seed)
        self.speed = before
        return self.observe(), info


# %% unseeded_start loses 10.4, 10.7
# Draws the inclination from NumPy's global generator, which no seed reaches.
# says: do not come from the seed
class BalanceBotEnv(BalanceBotEnv):
    def reset(self, *, seed=None, options=None):
        return super().reset(seed=int(np.random.randint(2**31)))


# %% action_not_cut loses 10.5
# A large action changes the speed by more than 1.
# says: is not cut to -1 and 1
class BalanceBotEnv(BalanceBotEnv):
    def drive(self, action):
        self.speed = self.speed + float(action[0]) - np.clip(float(action[0]), -1.0, 1.0)
        super().drive(action)


# %% wheels_against_each_other loses 10.5, 10.7
# Both motors get the same target, so that the robot spins instead of driving.
class BalanceBotEnv(BalanceBotEnv):
    def drive(self, action):
        super().drive(action)
        pybullet.setJointMotorControl2(
            self.robot,
            1,
            pybullet.VELOCITY_CONTROL,
            targetVelocity=self.speed,
            physicsClientId=self.client,
        )


# %% reward_of_driving_forward loses 10.6
# The speed costs in one direction, and is rewarded in the other.
# says: see abs\(\)
class BalanceBotEnv(BalanceBotEnv):
    def reward(self):
        return 1.0 - 0.05 * self.speed


# %% judged_by_the_angle loses 10.6, 10.7
# Ends the episode when the body leans by more than 45 degrees.
# says: terminated is True, but with the centre of the body
class BalanceBotEnv(BalanceBotEnv):
    def fallen(self):
        return bool(abs(self.observe()[0]) > np.pi / 4)


# %% two_steps_at_once loses 10.6, 10.7
# Lets the simulation make two steps for each action.
class BalanceBotEnv(BalanceBotEnv):
    def step(self, action):
        self.drive(action)
        pybullet.stepSimulation(self.client)
        return super().step(np.zeros(1))


# %% no_time_limit loses 10.7
# Registers the environment without a limit of steps.
# says: had 600 steps, but should have 500
def register_robot():
    gymnasium.register(id="BalanceBotBulletEnv-v0", entry_point=BalanceBotEnv)


# %% robot_left_out loses 10.8
# The package gets installed without the robot's file, and loads PyBullet on import.
_package_files = package_files


def package_files():
    files = _package_files()
    project, init = files["pyproject.toml"], files["balance_bot/__init__.py"]
    project = project.replace('["*.urdf"]', '["*.xml"]')
    init = "from balance_bot.env import BalanceBotEnv\n" + init
    return {"pyproject.toml": project, "balance_bot/__init__.py": init}


# %% first_generation loses 10.9
# Returns a random controller.
def evolve(seed):
    return 0.1 * np.random.default_rng(seed).standard_normal(4)


# %% known_by_heart loses 10.9
# Returns weights that were found before, with a little noise, and evolves nothing.
def evolve(seed):
    noise = 0.01 * np.random.default_rng(seed).standard_normal(4)
    return np.array([0.0, -8.0, -3.0, 0.3]) + noise


# %% evolved_instead loses 10.10
# Hands in an evolved controller as a network of one layer.
def train(seed):
    bias, *weights = evolve(seed)
    return [[np.array([weights]), np.array([bias])]]


# %% untrained loses 10.10
# Returns the network as PPO initialises it.
def train(seed):
    from stable_baselines3 import PPO

    return actor_layers(PPO("MlpPolicy", "BalanceBotBulletEnv-v0", seed=seed, device="cpu"))
