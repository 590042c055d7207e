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
# says: this
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
# says: this
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


# %% places_in_the_parent loses 10.1
# The place of a joint is taken in its parent's frame alone: earlier links of the chain do not count.
# says: this
# -         frames[child] = frames[parent] + origin
# +         frames[child] = np.array(origin)


# %% axis_without_sign loses 10.1
# The axis of a joint has lost its sign.
# says: this
# -         axis = numbers_of(joint.find("axis"), "xyz", [1.0, 0.0, 0.0])
# +         axis = [abs(each) for each in numbers_of(joint.find("axis"), "xyz", [1.0, 0.0, 0.0])]


# %% mass_without_the_base loses 10.1
# The mass is that of the links that a joint moves: the first link does not count.
# says: this
# -     mass, moment = sum(links.values()), np.zeros(3)
# +     mass, moment = sum(list(links.values())[1:]), np.zeros(3)


# %% in_simulation_0 loses 10.3, 10.7
# Looks at the robot of simulation 0: the physicsClientId is missing.
# says: this
class BalanceBotEnv(BalanceBotEnv):
    def observe(self):
        _, orientation = pybullet.getBasePositionAndOrientation(self.robot)
        velocity = pybullet.getBaseVelocity(self.robot, self.client)[1]
        angle = pybullet.getEulerFromQuaternion(orientation)[0]
        return np.array([angle, velocity[0], self.speed], dtype=np.float32)


# %% speed_of_the_wheel loses 10.3, 10.7
# Observes the speed at which the wheel turns, not the one that it should have.
# says: this
class BalanceBotEnv(BalanceBotEnv):
    def observe(self):
        seen = super().observe()
        seen[2] = pybullet.getJointState(self.robot, 0, self.client)[1]
        return seen


# %% on_the_ground loses 10.4, 10.7
# The robot begins at the height 0.
# says: 30 steps later
class BalanceBotEnv(BalanceBotEnv):
    def reset(self, *, seed=None, options=None):
        _, info = super().reset(seed=seed)
        place, orientation = pybullet.getBasePositionAndOrientation(self.robot, self.client)
        pybullet.resetBasePositionAndOrientation(
            self.robot, [0, 0, place[2] - 0.001], orientation, physicsClientId=self.client
        )
        return self.observe(), info


# %% robots_pile_up loses 10.4, 10.7
# The old robot stays in the world: its simulation is not emptied. resetSimulation(number) takes the number for something else: write physicsClientId=number.
# says: this
# -         pybullet.resetSimulation(physicsClientId=self.client)


# %% own_inertia loses 10.4, 10.7
# PyBullet computes the inertias anew: the flag is missing.
# says: this
# -             flags=pybullet.URDF_USE_INERTIA_FROM_FILE,
# -             physicsClientId=self.client,
# -         )
# -         self.speed = 0.0
# +             physicsClientId=self.client,
# +         )
# +         self.speed = 0.0


# %% no_step_of_its_own loses 10.4, 10.7
# The time step stays PyBullet's own: none is set in this simulation (physicsClientId).
# says: this
# -         pybullet.setTimeStep(TIME_STEP, physicsClientId=self.client)


# %% starts_twice_as_steep loses 10.4, 10.7
# Begins with inclinations of up to 0.6.
# says: this
# -         inclination = self.np_random.uniform(-0.3, 0.3)
# +         inclination = 2 * self.np_random.uniform(-0.3, 0.3)


# %% changes_the_action loses 10.5
# Cuts the caller's own array: the action is another one after the call.
# says: changed the caller's array
class BalanceBotEnv(BalanceBotEnv):
    def drive(self, action):
        np.clip(action, -1.0, 1.0, out=action)
        super().drive(action)


# %% limited_on_one_side loses 10.5
# The speed is limited forwards, and not backwards.
# says: this
# -         self.speed = float(np.clip(self.speed + change, -FASTEST, FASTEST))
# +         self.speed = float(min(self.speed + change, FASTEST))


# %% remembers_the_uncut_speed loses 10.5
# The motors get the limited speed, but self.speed keeps growing.
# says: this
# -         self.speed = float(np.clip(self.speed + change, -FASTEST, FASTEST))
# -         for wheel, target in ((0, self.speed), (1, -self.speed)):
# +         self.speed = float(self.speed + change)
# +         cut = float(np.clip(self.speed, -FASTEST, FASTEST))
# +         for wheel, target in ((0, cut), (1, -cut)):


# %% rewarded_before_it_drives loses 10.6
# The reward is that of the speed before the action.
# says: this
# -         self.drive(action)
# -         pybullet.stepSimulation(self.client)
# +         reward = self.reward()
# +         self.drive(action)
# +         pybullet.stepSimulation(self.client)
# -         return self.observe(), self.reward(), self.fallen(), False, {}
# +         return self.observe(), reward, self.fallen(), False, {}


# %% window_not_drawn loses 10.6
# A window is never drawn: step does not call render.
# says: called self.render\(\) 0 times
# -         if self.render_mode == "human":
# -             self.render()
# -         return self.observe(), self.reward(), self.fallen(), False, {}
# +         return self.observe(), self.reward(), self.fallen(), False, {}


# %% counts_its_steps_itself loses 10.6
# The environment says by itself that 500 steps are over, which Gymnasium's time limit does.
# says: never cuts an episode
class BalanceBotEnv(BalanceBotEnv):
    def reset(self, *, seed=None, options=None):
        self.count = 0
        return super().reset(seed=seed)

    def step(self, action):
        self.count = getattr(self, "count", 0) + 1
        observation, reward, fallen, _, info = super().step(action)
        return observation, reward, fallen, self.count >= 500, info


# %% fallen_is_truncated loses 10.6, 10.7
# A fall is reported as truncated.
# says: this
# -         return self.observe(), self.reward(), self.fallen(), False, {}
# +         return self.observe(), self.reward(), False, self.fallen(), {}


# %% without_a_render_mode loses 10.7
# gymnasium.make cannot hand on a render_mode: the entry point takes none.
# says: render_mode
def register_robot():
    gymnasium.register(
        id="BalanceBotBulletEnv-v0", entry_point=lambda: BalanceBotEnv(), max_episode_steps=500
    )


# %% one_step_more loses 10.7
# Episodes end after 501 steps.
# says: 501
# -         id="BalanceBotBulletEnv-v0", entry_point=BalanceBotEnv, max_episode_steps=500
# +         id="BalanceBotBulletEnv-v0", entry_point=BalanceBotEnv, max_episode_steps=501


# %% no_such_backend loses 10.8
# The build backend is none that exists.
# says: build-backend is 'setuptools.build'
_package_files = package_files


def package_files():
    files = _package_files()
    files["pyproject.toml"] = files["pyproject.toml"].replace("build_meta", "build")
    return files


# %% needs_gym loses 10.8
# Depends on the old package gym, and not on gymnasium.
# says: must name gymnasium
_package_files = package_files


def package_files():
    files = _package_files()
    files["pyproject.toml"] = files["pyproject.toml"].replace("gymnasium>=1.0", "gym>=0.21")
    return files


# %% no_limit_in_the_package loses 10.8
# The package registers the environment without a limit of steps.
# says: was not cut
_package_files = package_files


def package_files():
    files = _package_files()
    init = files["balance_bot/__init__.py"].replace("    max_episode_steps=500,\n", "")
    return {**files, "balance_bot/__init__.py": init}


# %% by_heart_with_a_sign loses 10.9
# Tries known weights with both signs, and keeps the better ones.
# says: balances for 500 steps in
def evolve(seed):
    robot = Robot("BalanceBotBulletEnv-v0", nhiddens=0)
    known = np.array([0.0, -8.0, -3.0, 0.3])
    both = np.array([known, -known]) + 0.01 * np.random.default_rng(seed).standard_normal((2, 4))
    return both[robot.evaluate(both, seed, episodes=1, maxsteps=500).argmax()]


# %% evolves_from_known_weights loses 10.9
# Begins to evolve at weights that balance already, with the sign that fits.
# says: of 20 new|Begin with weights
def evolve(seed):
    robot = Robot("BalanceBotBulletEnv-v0", nhiddens=0)
    rng = np.random.default_rng(seed)
    known = np.array([0.0, -8.0, -3.0, 0.3])
    both = np.array([known, -known])
    centre = both[robot.evaluate(both, seed, episodes=1, maxsteps=500).argmax()]
    for generation in range(5):
        population = centre + 0.05 * rng.standard_normal((6, 4))
        fitness = robot.evaluate(population, seed + generation, episodes=1, maxsteps=500)
        centre = population[np.argsort(fitness)[-3:]].mean(axis=0)
    return centre


# %% seed_ignored loses 10.9
# Evolves with the seed 1 always.
# says: same first steps
_evolve = evolve


def evolve(seed):
    return _evolve(1)


# %% another_every_time loses 10.9
# The same seed gives another controller each time.
# says: something random does not come from the seed
_evolve = evolve


def evolve(seed):
    return _evolve(int(np.random.default_rng().integers(10_000)))


# %% imitates_before_it_trains loses 10.10
# Sets a network that was evolved before into PPO's policy; PPO then learns at a rate of nearly 0.
# says: too little to learn from
def train(seed):
    import torch
    from stable_baselines3 import PPO

    bias, *weights = evolve(seed)
    model = PPO(
        "MlpPolicy", "BalanceBotBulletEnv-v0", seed=seed, device="cpu", n_steps=256, n_epochs=1,
        learning_rate=1e-9,
    )  # fmt: skip
    first, second, last = [*model.policy.mlp_extractor.policy_net, model.policy.action_net][::2]
    with torch.no_grad():
        for layer in (first, second, last):
            layer.weight *= 0
            layer.bias *= 0
        first.weight[0] = torch.as_tensor(np.array(weights) / 100)
        second.weight[0, 0] = 1.0
        second.weight[1:] += 1e-3
        last.weight[0, 0] = 100.0
        last.bias[0] = bias
    model.learn(512)
    return actor_layers(model)


# %% ppo_of_another_seed loses 10.10
# PPO gets no seed: the same seed gives other networks.
# says: something random does not come from the seed
# -         seed=seed,
# -         device="cpu",
# -         n_steps=512,
# +         device="cpu",
# +         n_steps=512,


# %% origin_of_the_picture loses 10.1
# The centre of a link is read from the visual part, not from the inertial one.
# says: this
# -         inside = numbers_of(link.find("inertial/origin"), "xyz", [0.0, 0.0, 0.0])
# +         inside = numbers_of(link.find("visual/origin"), "xyz", [0.0, 0.0, 0.0])


# %% heavy_and_light_alike loses 10.1
# The centres of the links are not weighted by their masses.
# says: this
# -         moment += links[link.get("name")] * (frames[link.get("name")] + inside)
# -     return {"links": links, "joints": joints, "mass": mass, "centre": (moment / mass).tolist()}
# +         moment += frames[link.get("name")] + inside
# +     return {"links": links, "joints": joints, "mass": mass,
# +             "centre": (moment / len(links)).tolist()}


# %% continuous_joints_only loses 10.1
# Only joints of the type continuous are listed.
# says: this
# -         joints.append(
# +         (joints if joint.get("type") == "continuous" else []).append(


# %% joints_by_name loses 10.1
# The joints come in the order of their names, not in that of the file.
# says: this
# -     mass, moment = sum(links.values()), np.zeros(3)
# +     joints.sort(key=lambda each: each["name"])
# +     mass, moment = sum(links.values()), np.zeros(3)


# %% axis_of_length_1 loses 10.1
# The axis is made 1 long, though the file says otherwise.
# says: this
# -         axis = numbers_of(joint.find("axis"), "xyz", [1.0, 0.0, 0.0])
# +         axis = numbers_of(joint.find("axis"), "xyz", [1.0, 0.0, 0.0])
# +         axis = (np.array(axis) / np.linalg.norm(axis)).tolist()


# %% centre_rounded loses 10.1
# The centre of mass is rounded to two digits.
# says: this
# -     return {"links": links, "joints": joints, "mass": mass, "centre": (moment / mass).tolist()}
# +     return {"links": links, "joints": joints, "mass": mass,
# +             "centre": [round(x, 2) for x in (moment / mass).tolist()]}


# %% seen_from_the_first_centre loses 10.1
# The centre of mass is seen from that of the first link, not from its frame.
# says: this
# -     return {"links": links, "joints": joints, "mass": mass, "centre": (moment / mass).tolist()}
# +     first = numbers_of(root.find("link/inertial/origin"), "xyz", [0.0, 0.0, 0.0])
# +     return {"links": links, "joints": joints, "mass": mass,
# +             "centre": (moment / mass - first).tolist()}


# %% parents_move_along loses 10.1
# frames[child] is the parent's array and grows in place (+=), so that the parent's frame moves as well.
# says: this
# -         frames[child] = frames[parent] + origin
# +         frames[child] = frames[parent]
# +         frames[child] += origin


# %% double_spaces loses 10.2
# Both spaces are of type float64.
# says: holds float64, but float32
# -         limits = np.array([np.pi, np.inf, FASTEST], dtype=np.float32)
# -         self.observation_space = gymnasium.spaces.Box(-limits, limits)
# -         self.action_space = gymnasium.spaces.Box(-1.0, 1.0, shape=(1,))
# +         limits = np.array([np.pi, np.inf, FASTEST])
# +         self.observation_space = gymnasium.spaces.Box(-limits, limits, dtype=np.float64)
# +         self.action_space = gymnasium.spaces.Box(-1.0, 1.0, shape=(1,), dtype=np.float64)


# %% limit_of_25 loses 10.2
# The speed of the wheels is limited to 25 in the space, not to FASTEST.
# says: is \[-3.14159, -inf, -25. \], but should be \[-3.14159, -inf, -24.6
# -         limits = np.array([np.pi, np.inf, FASTEST], dtype=np.float32)
# +         limits = np.array([np.pi, np.inf, 25.0], dtype=np.float32)


# %% degrees_of_inclination loses 10.3, 10.7
# The inclination is in degrees, not in rad.
# says: this
# -         return np.array([inclination, turning[0], self.speed], dtype=np.float32)
# +         return np.array([np.degrees(inclination), turning[0], self.speed], dtype=np.float32)


# %% one_array_for_all loses 10.3, 10.7
# One array is filled anew and returned each time: observations from before change with it.
# says: this
# -         return np.array([inclination, turning[0], self.speed], dtype=np.float32)
# +         if not hasattr(self, "seen"):
# +             self.seen = np.zeros(3, dtype=np.float32)
# +         self.seen[:] = inclination, turning[0], self.speed
# +         return self.seen


# %% quaternion_begins_with_w loses 10.3, 10.7
# The quaternion is taken for (w, x, y, z), but PyBullet's is (x, y, z, w).
# says: this
# -         inclination, _, _ = pybullet.getEulerFromQuaternion(orientation)
# +         w, x, y, z = orientation
# +         inclination = np.arctan2(2 * (w * x + y * z), 1 - 2 * (x * x + y * y))


# %% twice_the_arc_sine loses 10.3
# Twice the arc sine of the quaternion's x is the inclination only if the robot turns around x alone.
# says: this
# -         inclination, _, _ = pybullet.getEulerFromQuaternion(orientation)
# +         inclination = 2 * np.arcsin(orientation[0])


# %% turning_around_the_bodys_x loses 10.3
# The angular velocity is that around the body's own x axis, not the world's.
# says: this
# -         return np.array([inclination, turning[0], self.speed], dtype=np.float32)
# +         turning = np.reshape(pybullet.getMatrixFromQuaternion(orientation), (3, 3)).T @ turning
# +         return np.array([inclination, turning[0], self.speed], dtype=np.float32)


# %% velocity_for_angular_velocity loses 10.3, 10.7
# The velocity is taken for the angular velocity, which is the second thing that getBaseVelocity returns.
# says: this
# -         _, turning = pybullet.getBaseVelocity(self.robot, self.client)
# +         turning, _ = pybullet.getBaseVelocity(self.robot, self.client)


# %% velocity_of_simulation_0 loses 10.3, 10.7
# The velocity is that of the robot of simulation 0: the physicsClientId is missing.
# says: this
# -         _, turning = pybullet.getBaseVelocity(self.robot, self.client)
# +         _, turning = pybullet.getBaseVelocity(self.robot)


# %% inclination_cut loses 10.3
# The inclination is cut to a quarter turn, but the body may lean by up to pi.
# says: this
# -         return np.array([inclination, turning[0], self.speed], dtype=np.float32)
# +         inclination = np.clip(inclination, -np.pi / 2, np.pi / 2)
# +         return np.array([inclination, turning[0], self.speed], dtype=np.float32)


# %% speed_as_a_share loses 10.3, 10.7
# The speed is told as a share of FASTEST.
# says: this
# -         return np.array([inclination, turning[0], self.speed], dtype=np.float32)
# +         return np.array([inclination, turning[0], self.speed / FASTEST], dtype=np.float32)


# %% seed_0_is_none loses 10.4
# Seed 0 is taken for no seed: ask whether it is None.
# says: this
# -         super().reset(seed=seed)
# +         super().reset(seed=seed if seed else None)


# %% no_seed_is_a_seed loses 10.4
# Without a seed all episodes begin alike: 0 is put in its place.
# says: this
# -         super().reset(seed=seed)
# +         super().reset(seed=seed or 0)


# %% observed_too_early loses 10.4
# The observation is made before the speed is set to 0.
# says: this
# -         self.speed = 0.0
# -         return self.observe(), {}
# +         observation = self.observe()
# +         self.speed = 0.0
# +         return observation, {}


# %% second_random_number loses 10.4, 10.7
# Two random numbers are drawn, and the second one is the inclination.
# says: this
# -         inclination = self.np_random.uniform(-0.3, 0.3)
# +         _, inclination = self.np_random.uniform(-0.3, 0.3, size=2)


# %% leans_to_one_side loses 10.4, 10.7
# The robot begins with inclinations from 0 to 0.3 only.
# says: this
# -         inclination = self.np_random.uniform(-0.3, 0.3)
# +         inclination = self.np_random.uniform(0, 0.3)


# %% old_robot_put_back loses 10.4, 10.7
# The world is not made anew: the robot of the last episode is put back, and its wheels go on turning.
# says: this
# -         pybullet.resetSimulation(physicsClientId=self.client)
# +         if self.robot is not None:
# +             pybullet.resetBasePositionAndOrientation(
# +                 self.robot, [0, 0, 0.301],
# +                 pybullet.getQuaternionFromEuler([inclination, 0, 0]), self.client)
# +             pybullet.resetBaseVelocity(self.robot, [0, 0, 0], [0, 0, 0], self.client)
# +             self.speed = 0.0
# +             return self.observe(), {}
# +         pybullet.resetSimulation(physicsClientId=self.client)


# %% no_ground loses 10.4, 10.7
# There is no plane in the world.
# says: this
# -         pybullet.loadURDF(PLANE, physicsClientId=self.client)


# %% reset_makes_a_step loses 10.4, 10.7
# reset makes a step of the simulation before it observes.
# says: this
# -         self.speed = 0.0
# -         return self.observe(), {}
# +         self.speed = 0.0
# +         pybullet.stepSimulation(self.client)
# +         return self.observe(), {}


# %% sum_cut_to_1 loses 10.5, 10.7
# The sum is cut to between -1 and 1, in place of the action.
# says: this
# -         change = np.clip(float(action[0]), -1.0, 1.0)
# -         self.speed = float(np.clip(self.speed + change, -FASTEST, FASTEST))
# +         change = float(action[0])
# +         self.speed = float(np.clip(np.clip(self.speed + change, -1.0, 1.0), -FASTEST, FASTEST))


# %% motors_up_to_24 loses 10.5
# The speed is cut to 24 rad/s, not to FASTEST.
# says: this
# -         self.speed = float(np.clip(self.speed + change, -FASTEST, FASTEST))
# +         self.speed = float(np.clip(self.speed + change, -24, 24))


# %% motors_up_to_25 loses 10.5
# The speed is cut to 25 rad/s, not to FASTEST.
# says: this
# -         self.speed = float(np.clip(self.speed + change, -FASTEST, FASTEST))
# +         self.speed = float(np.clip(self.speed + change, -25, 25))


# %% motors_get_the_change loses 10.5, 10.7
# The motors get the change, not the speed that comes of it.
# says: this
# -         for wheel, target in ((0, self.speed), (1, -self.speed)):
# +         for wheel, target in ((0, change), (1, -change)):


# %% motors_get_the_old_speed loses 10.5, 10.7
# The simulation makes its step with the old target speed: hand the new one over before it.
# says: this
# -         self.speed = float(np.clip(self.speed + change, -FASTEST, FASTEST))
# -         for wheel, target in ((0, self.speed), (1, -self.speed)):
# +         old = self.speed
# +         self.speed = float(np.clip(self.speed + change, -FASTEST, FASTEST))
# +         for wheel, target in ((0, old), (1, -old)):


# %% rounded_actions loses 10.5, 10.7
# The action is rounded to a whole number.
# says: this
# -         change = np.clip(float(action[0]), -1.0, 1.0)
# +         change = np.clip(round(float(action[0])), -1.0, 1.0)


# %% position_for_speed loses 10.5, 10.7
# The motors get the speed as a position.
# says: this
# -                 pybullet.VELOCITY_CONTROL,
# -                 targetVelocity=target,
# +                 pybullet.POSITION_CONTROL,
# +                 targetPosition=target,


# %% motors_only_if_it_changes loses 10.5
# With an action of 0 the motors get nothing.
# says: this
# -         change = np.clip(float(action[0]), -1.0, 1.0)
# +         change = np.clip(float(action[0]), -1.0, 1.0)
# +         if change == 0:
# +             return


# %% motors_of_simulation_0 loses 10.5, 10.7
# The wheels of this robot get no speed: physicsClientId is missing, or the speed is passed without the name targetVelocity.
# says: this
# -                 targetVelocity=target,
# -                 physicsClientId=self.client,
# +                 targetVelocity=target,


# %% speed_passed_by_place loses 10.5, 10.7
# The wheels of this robot get no speed: physicsClientId is missing, or the speed is passed without the name targetVelocity.
# says: this
# -                 targetVelocity=target,
# +                 target,


# %% price_of_the_square loses 10.6
# The price is that of the speed squared.
# says: this
# -         return 1.0 - 0.05 * abs(self.speed)
# +         return 1.0 - 0.05 * self.speed**2


# %% never_below_0 loses 10.6
# The reward does not go below 0.
# says: this
# -         return 1.0 - 0.05 * abs(self.speed)
# +         return max(0.0, 1.0 - 0.05 * abs(self.speed))


# %% fallen_at_the_limit loses 10.6
# A robot whose centre is exactly 15 cm high has fallen.
# says: this
# -         return position[2] < LOWEST
# +         return position[2] <= LOWEST


# %% y_for_the_height loses 10.6, 10.7
# The second number of the position is taken for the height, which is the third.
# says: this
# -         return position[2] < LOWEST
# +         return position[1] < LOWEST


# %% a_fall_earns_nothing loses 10.6
# The step in which the robot falls earns nothing.
# says: this
# -         return self.observe(), self.reward(), self.fallen(), False, {}
# +         fell = self.fallen()
# +         return self.observe(), 0.0 if fell else self.reward(), fell, False, {}


# %% observes_before_it_steps loses 10.6, 10.7
# The observation is that before the simulation makes its step.
# says: this
# -         self.drive(action)
# -         pybullet.stepSimulation(self.client)
# -         if self.render_mode == "human":
# -             self.render()
# -         return self.observe(), self.reward(), self.fallen(), False, {}
# +         self.drive(action)
# +         observation = self.observe()
# +         pybullet.stepSimulation(self.client)
# +         if self.render_mode == "human":
# +             self.render()
# +         return observation, self.reward(), self.fallen(), False, {}


# %% drawn_without_a_window loses 10.6
# Every step is drawn, without a window, too.
# says: called self.render\(\) 4 times
# -         if self.render_mode == "human":
# -             self.render()
# -         return self.observe(), self.reward(), self.fallen(), False, {}
# +         self.render()
# +         return self.observe(), self.reward(), self.fallen(), False, {}


# %% reward_in_an_array loses 10.6
# The reward is an array of NumPy, not a float.
# says: is an array, but a float
# -         return 1.0 - 0.05 * abs(self.speed)
# +         return np.array(1.0 - 0.05 * abs(self.speed))


# %% up_again_at_once loses 10.6, 10.7
# A robot that has fallen is put up again by step itself, which is for the caller to do.
# -         return self.observe(), self.reward(), self.fallen(), False, {}
# +         reward, fell = self.reward(), self.fallen()
# +         if fell:
# +             self.reset()
# +         return self.observe(), reward, fell, False, {}


# %% dot_for_the_colon loses 10.8
# The entry point has a dot where the colon belongs.
# says: should be 'module:class'
# -     entry_point="balance_bot.env:BalanceBotEnv",
# +     entry_point="balance_bot.env.BalanceBotEnv",


# %% nothing_but_modules loses 10.8
# The package has no package-data, so that the robot's file does not get installed.
# says: without 'package-data'
# - package-data = { balance_bot = ["*.urdf"] }


# %% all_signs_of_known_weights loses 10.9
# Tries known weights with all signs, and keeps the best.
# says: the same weights but for their signs
def evolve(seed):
    robot = Robot("BalanceBotBulletEnv-v0", nhiddens=0)
    rng = np.random.default_rng(seed)
    known = np.array([0.0, 8.0, 2.0, 0.1])
    signs = np.array([[1, a, b, c] for a in (-1, 1) for b in (-1, 1) for c in (-1, 1)])
    population = known * signs + 0.01 * rng.standard_normal((8, 4))
    fitness = robot.evaluate(population, seed, episodes=3, maxsteps=500)
    return population[np.argmax(fitness)]


# %% changed_after_training loses 10.10
# The last layer is made twice as large after the training.
# says: not all those of a policy
# -     model.learn(16_384)
# -     return actor_layers(model)
# +     model.learn(16_384)
# +     layers = actor_layers(model)
# +     layers[-1][0] *= 2
# +     return layers


# %% place_not_weighted loses 10.1
# The centre of mass inside a link is added without the link's mass: the mass multiplies the sum of both.
# says: this
# -         moment += links[link.get("name")] * (frames[link.get("name")] + inside)
# +         moment += links[link.get("name")] * frames[link.get("name")] + inside


# %% mass_of_the_first_link loses 10.1
# The mass is that of the first link alone, not of the whole robot.
# says: this
# -     return {"links": links, "joints": joints, "mass": mass, "centre": (moment / mass).tolist()}
# +     first = next(iter(links.values()))
# +     return {"links": links, "joints": joints, "mass": first, "centre": (moment / mass).tolist()}


# %% mass_of_the_last_link loses 10.1
# The mass is that of the last link alone, not of the whole robot.
# says: this
# -     return {"links": links, "joints": joints, "mass": mass, "centre": (moment / mass).tolist()}
# +     last = list(links.values())[-1]
# +     return {"links": links, "joints": joints, "mass": last, "centre": (moment / mass).tolist()}


# %% looks_around_y loses 10.3, 10.7
# Inclination and angular velocity are those around the y axis: the robot falls over around x.
# says: this
# -         inclination, _, _ = pybullet.getEulerFromQuaternion(orientation)
# -         _, turning = pybullet.getBaseVelocity(self.robot, self.client)
# -         return np.array([inclination, turning[0], self.speed], dtype=np.float32)
# +         inclination = pybullet.getEulerFromQuaternion(orientation)[1]
# +         _, turning = pybullet.getBaseVelocity(self.robot, self.client)
# +         return np.array([inclination, turning[1], self.speed], dtype=np.float32)


# %% leans_around_y loses 10.4, 10.7
# The robot leans around the y axis at the start: the inclination is the first Euler angle, around x.
# says: this
# -             pybullet.getQuaternionFromEuler([inclination, 0, 0]),
# +             pybullet.getQuaternionFromEuler([0, inclination, 0]),


# %% speed_is_the_action loses 10.5, 10.7
# The action replaces the target speed, as a share of FASTEST: it is a change that is added to it.
# says: this
# -         self.speed = float(np.clip(self.speed + change, -FASTEST, FASTEST))
# +         self.speed = float(change * FASTEST)


# %% an_object_registered loses 10.7
# An object of the class is registered, not the class.
# says: give the class, not an object of it or its name
# -         id="BalanceBotBulletEnv-v0", entry_point=BalanceBotEnv, max_episode_steps=500
# +         id="BalanceBotBulletEnv-v0", entry_point=BalanceBotEnv(), max_episode_steps=500


# %% the_name_of_the_class_registered loses 10.7
# The name of the class is registered, without its module.
# says: give the class, not an object of it or its name
# -         id="BalanceBotBulletEnv-v0", entry_point=BalanceBotEnv, max_episode_steps=500
# +         id="BalanceBotBulletEnv-v0", entry_point="BalanceBotEnv", max_episode_steps=500

# %% divided_by_the_links loses 10.1
# The centre of mass is divided by the number of links, not by the mass of the robot.
# says: divided by the number of links
# -     return {"links": links, "joints": joints, "mass": mass, "centre": (moment / mass).tolist()}
# +     centre = (moment / len(links)).tolist()
# +     return {"links": links, "joints": joints, "mass": mass, "centre": centre}

# %% origin_subtracted loses 10.1
# The origin of a joint is subtracted from the frame of the parent.
# says: subtracted
# -         frames[child] = frames[parent] + origin
# +         frames[child] = frames[parent] - origin

# %% position_for_the_angle loses 10.3, 10.7
# The inclination is taken from the position, which is the first thing that comes back.
# says: this|Only the inclination
# -         _, orientation = pybullet.getBasePositionAndOrientation(self.robot, self.client)
# -         inclination, _, _ = pybullet.getEulerFromQuaternion(orientation)
# +         position, _ = pybullet.getBasePositionAndOrientation(self.robot, self.client)
# +         inclination = position[0]

# %% generator_of_its_own loses 10.4
# Makes a generator of the seed in each reset, so that no seed does not go on from the one before.
# says: goes on from where it is
# -         inclination = self.np_random.uniform(-0.3, 0.3)
# -         pybullet.resetSimulation(physicsClientId=self.client)
# +         inclination = np.random.default_rng(seed).uniform(-0.3, 0.3)
# +         pybullet.resetSimulation(physicsClientId=self.client)

# %% degrees_at_the_start loses 10.4, 10.7
# The inclination is drawn in degrees, from -17 to 17, and used as radians.
# says: not in degrees|in degrees
# -         inclination = self.np_random.uniform(-0.3, 0.3)
# -         pybullet.resetSimulation(physicsClientId=self.client)
# +         inclination = self.np_random.uniform(-17, 17)
# +         pybullet.resetSimulation(physicsClientId=self.client)

# %% gravity_upwards loses 10.4, 10.7
# Gravity is 10 upwards: along z it is -10.
# says: this|pulls upwards
# -         pybullet.setGravity(0, 0, -10, physicsClientId=self.client)
# +         pybullet.setGravity(0, 0, 10, physicsClientId=self.client)

# %% begins_in_the_air loses 10.4, 10.7
# The base begins 10 cm high.
# says: this|the height 0.1
# -             [0, 0, 0.001],
# +             [0, 0, 0.1],

# %% the_plane_is_the_robot loses 10.4, 10.7
# Keeps the number of the plane in self.robot.
# says: which is the plane
# -         pybullet.loadURDF(PLANE, physicsClientId=self.client)
# -         self.robot = pybullet.loadURDF(
# +         self.robot = pybullet.loadURDF(PLANE, physicsClientId=self.client)
# +         pybullet.loadURDF(

# %% no_info_from_reset loses 10.4, 10.7
# reset returns the observation alone.
# says: two things are asked for
# -         return self.observe(), {}
# +         return self.observe()

# %% one_motor_only loses 10.5, 10.7
# Motor 1 gets nothing.
# says: this|Motor 1 gets no target
# -         for wheel, target in ((0, self.speed), (1, -self.speed)):
# +         for wheel, target in ((0, self.speed),):

# %% weak_motors loses 10.5, 10.7
# The motors get too little force.
# says: this|turn too slowly
# -                 targetVelocity=target,
# +                 targetVelocity=target,
# +                 force=0.1,

# %% change_of_a_time_step loses 10.5, 10.7
# The action is multiplied by the time step.
# says: multiplied by the time step
# -         change = np.clip(float(action[0]), -1.0, 1.0)
# +         change = np.clip(float(action[0]), -1.0, 1.0) * TIME_STEP

# %% ten_times_the_price loses 10.6
# A rad/s costs 0.5, ten times as much as it should.
# says: costs 0.05, not 0.5|this
# -         return 1.0 - 0.05 * abs(self.speed)
# +         return 1.0 - 0.5 * abs(self.speed)

# %% drives_after_the_step loses 10.6, 10.7
# The simulation makes its step with the old target speed: hand the new one over before it.
# says: this|drive first
# -         self.drive(action)
# -         pybullet.stepSimulation(self.client)
# +         pybullet.stepSimulation(self.client)
# +         self.drive(action)

# %% reward_and_end_of_before loses 10.6, 10.7
# Reward and end are those from before the action and the step.
# says: this|before the action
# -         self.drive(action)
# -         pybullet.stepSimulation(self.client)
# +         reward, fallen = self.reward(), self.fallen()
# +         self.drive(action)
# +         pybullet.stepSimulation(self.client)
# -         return self.observe(), self.reward(), self.fallen(), False, {}
# +         return self.observe(), reward, fallen, False, {}

# %% four_values loses 10.6, 10.7
# step returns four values, as in the old gym.
# says: 4 values came back
# -         return self.observe(), self.reward(), self.fallen(), False, {}
# +         return self.observe(), self.reward(), self.fallen(), {}

# %% another_name loses 10.7
# Registers another version of the name.
# says: did not register this name
# -         id="BalanceBotBulletEnv-v0", entry_point=BalanceBotEnv, max_episode_steps=500
# +         id="BalanceBotBulletEnv-v1", entry_point=BalanceBotEnv, max_episode_steps=500

# %% package_that_is_not_there loses 10.7
# Registers the class of the package, which is not installed yet.
# says: here is no such module
# -         id="BalanceBotBulletEnv-v0", entry_point=BalanceBotEnv, max_episode_steps=500
# +         id="BalanceBotBulletEnv-v0",
# +         entry_point="balance_bot.env:BalanceBotEnv",
# +         max_episode_steps=500,

# %% module_without_its_package loses 10.8
# The entry point names the module without its package.
# says: the module env of the package
# -     entry_point="balance_bot.env:BalanceBotEnv",
# +     entry_point="env:BalanceBotEnv",

# %% keeps_the_worst loses 10.9
# Takes the worst candidates for the best.
# says: They are to become longer
# -         centre = population[np.argsort(fitness)[-3:]].mean(axis=0)
# +         centre = population[np.argsort(fitness)[:3]].mean(axis=0)

# %% returns_the_worst loses 10.9
# Returns the worst candidate of the first generation.
# says: return the best
# -     for generation in range(6):
# +     worst = None
# +     for generation in range(6):
# -         centre = population[np.argsort(fitness)[-3:]].mean(axis=0)
# +         worst = population[np.argmin(fitness)] if worst is None else worst
# +         centre = population[np.argsort(fitness)[-3:]].mean(axis=0)
# -     return centre
# +     return worst

# %% bias_at_the_end loses 10.9
# Returns the weights first and the bias at the end.
# says: in another order
# -     return centre
# +     return np.roll(centre, -1)

# %% layers_of_the_critic loses 10.10
# Returns the hidden layers of the critic, with the last layer of the actor.
# says: the critic's
# -     return actor_layers(model)
# +     layers = [*model.policy.mlp_extractor.value_net, model.policy.action_net]
# +     layers = [layer for layer in layers if hasattr(layer, "weight")]
# +     return [[each.weight.detach().numpy(), each.bias.detach().numpy()] for each in layers]

# %% trains_too_briefly loses 10.10
# Trains for two rollouts.
# says: learn for longer
# -     model.learn(16_384)
# +     model.learn(1_024)


# %% gravity_before_the_world_is_emptied loses 10.4, 10.7
# There is no gravity: it is left out, or set in another simulation, or before resetSimulation, which ends it.
# says: this
# -         pybullet.resetSimulation(physicsClientId=self.client)
# -         pybullet.setGravity(0, 0, -10, physicsClientId=self.client)
# +         pybullet.setGravity(0, 0, -10, physicsClientId=self.client)
# +         pybullet.resetSimulation(physicsClientId=self.client)


# %% half_the_angle loses 10.3, 10.7
# Takes the arc sine of the quaternion's x for the inclination, which is half the angle.
# says: this
# -         inclination, _, _ = pybullet.getEulerFromQuaternion(orientation)
# +         inclination = np.arcsin(orientation[0])


# %% sum_beyond_the_limit_is_ignored loses 10.5
# Where the sum is beyond a limit, the speed stays as it was.
# says: stays as it was
# -         self.speed = float(np.clip(self.speed + change, -FASTEST, FASTEST))
# +         if abs(self.speed + change) <= FASTEST:
# +             self.speed = float(self.speed + change)


# %% fallen_only_if_it_lies loses 10.6
# A fall counts only if the body leans by more than a right angle, too.
# says: the height alone decides
# -         return position[2] < LOWEST
# +         return bool(position[2] < LOWEST and abs(self.observe()[0]) > np.pi / 2)


# %% list_for_the_package_data loses 10.8
# package-data is a list of files, without the name of the package that they belong to.
# says: a table is asked for
# - package-data = { balance_bot = ["*.urdf"] }
# + package-data = ["*.urdf"]


# %% inclination_without_a_sign loses 10.3
# The inclination is the angle to the vertical, which is never negative.
# says: this
# -         inclination, _, _ = pybullet.getEulerFromQuaternion(orientation)
# +         upright = np.reshape(pybullet.getMatrixFromQuaternion(orientation), (3, 3))[2, 2]
# +         inclination = np.arccos(np.clip(upright, -1.0, 1.0))


# %% rate_from_the_last_call loses 10.3
# The rate is the change of the inclination since the last call, not the velocity of the turning.
# -         return np.array([inclination, turning[0], self.speed], dtype=np.float32)
# +         before, self.seen = getattr(self, "seen", inclination), inclination
# +         return np.array([inclination, inclination - before, self.speed], dtype=np.float32)


# %% rate_by_differences loses 10.3
# The rate is the change of the inclination since the last call, not the velocity of the turning.
# -         return np.array([inclination, turning[0], self.speed], dtype=np.float32)
# +         before, self.seen = getattr(self, "seen", inclination), inclination
# +         rate = (inclination - before) / TIME_STEP
# +         return np.array([inclination, rate, self.speed], dtype=np.float32)


# %% rate_of_all_axes loses 10.3
# The angular velocity is the length of all three numbers: that around x is asked for.
# says: this
# -         return np.array([inclination, turning[0], self.speed], dtype=np.float32)
# +         rate = np.linalg.norm(turning)
# +         return np.array([inclination, rate, self.speed], dtype=np.float32)


# %% rate_with_the_wrong_sign loses 10.3
# The angular velocity has the wrong sign.
# says: this
# -         return np.array([inclination, turning[0], self.speed], dtype=np.float32)
# +         return np.array([inclination, -turning[0], self.speed], dtype=np.float32)


# %% rate_in_degrees loses 10.3
# The angular velocity is in degrees a second, not in rad a second.
# says: this
# -         return np.array([inclination, turning[0], self.speed], dtype=np.float32)
# +         rate = np.degrees(turning[0])
# +         return np.array([inclination, rate, self.speed], dtype=np.float32)


# %% rate_cut loses 10.3
# The angular velocity is cut to between -1 and 1, but it has no limits.
# says: this
# -         return np.array([inclination, turning[0], self.speed], dtype=np.float32)
# +         rate = np.clip(turning[0], -1, 1)
# +         return np.array([inclination, rate, self.speed], dtype=np.float32)


# %% speed_without_a_sign loses 10.3
# The speed of the wheels has lost its sign.
# says: this
# -         return np.array([inclination, turning[0], self.speed], dtype=np.float32)
# +         return np.array([inclination, turning[0], abs(self.speed)], dtype=np.float32)


# %% link_before_for_the_parent loses 10.1
# The frame of a link is that of the last joint's link plus the origin, not that of its parent plus the origin.
# says: this
# -         frames[child] = frames[parent] + origin
# +         frames[child] = list(frames.values())[-1] + origin


# %% draws_a_second_number loses 10.4
# A second number is drawn from self.np_random in each reset, so that the next inclination is another.
# says: this
# -         self.speed = 0.0
# -         return self.observe(), {}
# +         self.speed = 0.0
# +         self.np_random.uniform(-0.3, 0.3)
# +         return self.observe(), {}


# %% drawn_before_the_seed loses 10.4
# The inclination is drawn before super().reset(seed=seed), which sets self.np_random.
# -         super().reset(seed=seed)
# -         inclination = self.np_random.uniform(-0.3, 0.3)
# +         inclination = self.np_random.uniform(-0.3, 0.3)
# +         super().reset(seed=seed)


# %% normally_distributed loses 10.4
# The inclination is drawn from a normal distribution: uniform(-0.3, 0.3) is asked for.
# says: this
# -         inclination = self.np_random.uniform(-0.3, 0.3)
# -         pybullet.resetSimulation(physicsClientId=self.client)
# +         inclination = self.np_random.normal(0, 0.3)
# +         pybullet.resetSimulation(physicsClientId=self.client)


# %% same_inclination_always loses 10.4
# The inclination is a fixed number: it is to be drawn.
# says: is the same after each seed|this
# -         inclination = self.np_random.uniform(-0.3, 0.3)
# -         pybullet.resetSimulation(physicsClientId=self.client)
# +         inclination = 0.2
# +         pybullet.resetSimulation(physicsClientId=self.client)


# %% cut_before_the_action loses 10.5
# The speed is cut before the action is added: their sum is to be cut.
# says: this
# -         self.speed = float(np.clip(self.speed + change, -FASTEST, FASTEST))
# +         self.speed = float(np.clip(self.speed, -FASTEST, FASTEST) + change)


# %% drive_makes_a_step loses 10.5
# drive makes a step of the simulation by itself, which is for step to do.
# says: this
# -                 targetVelocity=target,
# -                 physicsClientId=self.client,
# -             )
# +                 targetVelocity=target,
# +                 physicsClientId=self.client,
# +             )
# +         pybullet.stepSimulation(self.client)


# %% half_for_each_motor loses 10.5
# Each motor gets half of the target speed.
# says: this
# -         for wheel, target in ((0, self.speed), (1, -self.speed)):
# +         for wheel, target in ((0, self.speed / 2), (1, -self.speed / 2)):


# %% no_step_of_the_simulation loses 10.6
# No time passes in this robot's simulation: stepSimulation is left out, or its physicsClientId.
# says: this
# -         self.drive(action)
# -         pybullet.stepSimulation(self.client)
# +         self.drive(action)


# %% no_drive_in_step loses 10.6
# step does not call drive: the action changes nothing.
# says: this
# -         self.drive(action)
# -         pybullet.stepSimulation(self.client)
# +         pybullet.stepSimulation(self.client)


# %% drives_twice loses 10.6
# step drives twice for each action.
# says: this
# -         self.drive(action)
# -         pybullet.stepSimulation(self.client)
# +         self.drive(action)
# +         self.drive(action)
# +         pybullet.stepSimulation(self.client)


# %% never_terminated loses 10.6
# terminated is always False: it is to say whether the robot has fallen.
# says: this
# -         return self.observe(), self.reward(), self.fallen(), False, {}
# +         return self.observe(), self.reward(), False, False, {}


# %% one_object_for_all loses 10.7
# One object is made once and given for each make: each make is to give a new environment.
# says: gives the same object twice
# -     gymnasium.register(
# -         id="BalanceBotBulletEnv-v0", entry_point=BalanceBotEnv, max_episode_steps=500
# -     )
# +     env = BalanceBotEnv()
# +
# +     def make(render_mode=None):
# +         env.render_mode = render_mode
# +         return env
# +
# +     gymnasium.register(
# +         id="BalanceBotBulletEnv-v0", entry_point=make, max_episode_steps=500
# +     )


# %% falls_in_simulation_0 loses 10.6, 10.7
# fallen looks at the robot of simulation 0: the physicsClientId is missing.
# says: this
# -         position, _ = pybullet.getBasePositionAndOrientation(self.robot, self.client)
# -         return position[2] < LOWEST
# +         position, _ = pybullet.getBasePositionAndOrientation(self.robot)
# +         return position[2] < LOWEST


# %% layers_before_learning loses 10.10
# Takes the layers out before PPO learns.
# says: before PPO's first update
# -     model.learn(16_384)
# -     return actor_layers(model)
# +     layers = actor_layers(model)
# +     model.learn(16_384)
# +     return layers


# %% limits_exchanged loses 10.2
# FASTEST limits the angular velocity, and nothing the speed of the wheels.
# says: stand at the wrong numbers
# -         limits = np.array([np.pi, np.inf, FASTEST], dtype=np.float32)
# +         limits = np.array([np.pi, FASTEST, np.inf], dtype=np.float32)


# %% arcsine_of_the_matrix loses 10.3
# The inclination is the arcsine of an element of the rotation matrix, which is never beyond a quarter turn.
# says: this
# -         inclination, _, _ = pybullet.getEulerFromQuaternion(orientation)
# +         matrix = np.reshape(pybullet.getMatrixFromQuaternion(orientation), (3, 3))
# +         inclination = np.arcsin(np.clip(matrix[2, 1], -1.0, 1.0))


# %% price_of_the_wheel loses 10.6
# The price is for the speed at which the wheel turns, not for the target speed.
# says: this
# -         return 1.0 - 0.05 * abs(self.speed)
# +         wheel = pybullet.getJointState(self.robot, 0, physicsClientId=self.client)
# +         return 1.0 - 0.05 * abs(wheel[1])


# %% wheels_go_on_spinning loses 10.4
# The world is not made anew: the wheels go on with the spin of the episode before.
# -         pybullet.resetSimulation(physicsClientId=self.client)
# -         pybullet.setGravity(0, 0, -10, physicsClientId=self.client)
# -         pybullet.setTimeStep(TIME_STEP, physicsClientId=self.client)
# -         pybullet.loadURDF(PLANE, physicsClientId=self.client)
# -         self.robot = pybullet.loadURDF(
# -             str(robot_file("balance_bot.urdf")),
# -             [0, 0, 0.001],
# -             pybullet.getQuaternionFromEuler([inclination, 0, 0]),
# -             flags=pybullet.URDF_USE_INERTIA_FROM_FILE,
# -             physicsClientId=self.client,
# -         )
# +         turned = pybullet.getQuaternionFromEuler([inclination, 0, 0])
# +         if self.robot is None:
# +             pybullet.resetSimulation(physicsClientId=self.client)
# +             pybullet.setGravity(0, 0, -10, physicsClientId=self.client)
# +             pybullet.setTimeStep(TIME_STEP, physicsClientId=self.client)
# +             pybullet.loadURDF(PLANE, physicsClientId=self.client)
# +             self.robot = pybullet.loadURDF(
# +                 str(robot_file("balance_bot.urdf")),
# +                 [0, 0, 0.001],
# +                 turned,
# +                 flags=pybullet.URDF_USE_INERTIA_FROM_FILE,
# +                 physicsClientId=self.client,
# +             )
# +         else:
# +             inside = pybullet.getDynamicsInfo(self.robot, -1, physicsClientId=self.client)[3]
# +             middle, _ = pybullet.multiplyTransforms([0, 0, 0.001], turned, inside, [0, 0, 0, 1])
# +             pybullet.resetBasePositionAndOrientation(
# +                 self.robot, middle, turned, physicsClientId=self.client
# +             )
# +             pybullet.resetBaseVelocity(
# +                 self.robot, [0, 0, 0], [0, 0, 0], physicsClientId=self.client
# +             )


# %% joints_in_the_order_of_links loses 10.1
# Pairs the links with the joints in the order of the file, not by the name of the child.
# says: this
def describe(urdf):
    root = ElementTree.fromstring(urdf)
    all_links, all_joints = root.findall("link"), root.findall("joint")

    def vector(element, default):
        return np.array(numbers_of(element, "xyz", default))

    joints = []
    for j in all_joints:
        joints.append(
            {
                "name": j.attrib["name"],
                "type": j.attrib["type"],
                "parent": j.find("parent").attrib["link"],
                "child": j.find("child").attrib["link"],
                "axis": vector(j.find("axis"), [1.0, 0.0, 0.0]).tolist(),
            }
        )
    frames = {all_links[0].attrib["name"]: np.zeros(3)}
    for link, j in zip(all_links[1:], all_joints, strict=False):
        above = frames.get(j.find("parent").attrib["link"], np.zeros(3))
        frames[link.attrib["name"]] = above + vector(j.find("origin"), [0.0, 0.0, 0.0])
    masses, centre = {}, np.zeros(3)
    for link in all_links:
        name, inertial = link.attrib["name"], link.find("inertial")
        masses[name] = float(inertial.find("mass").attrib["value"])
        centre += masses[name] * (frames[name] + vector(inertial.find("origin"), [0.0, 0.0, 0.0]))
    total = sum(masses.values())
    return {"links": masses, "joints": joints, "mass": total, "centre": list(centre / total)}


# %% joints_from_the_centre_of_mass loses 10.1
# Counts a joint's origin from the parent's centre of mass, not from its frame.
# says: this
# -         frames[child] = frames[parent] + origin
# +         above = root.find(f"link[@name='{parent}']/inertial/origin")
# +         inside = numbers_of(above, "xyz", [0.0, 0.0, 0.0])
# +         frames[child] = frames[parent] + inside + origin
